"""Short versions of descriptions, for faults.py and restarts.py."""
import json
import subprocess

LIMIT = '1 h'                                            # of a stage that ends after steps


def expanded(grit, description, sets=()):
    """The whole description as JSON, with absolute paths. Throws ValueError with grit's message."""
    words = [grit, 'expand', description, *(word for one in sets for word in ('--set', one))]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(f'{description}: exit status {done.returncode}: {done.stderr.strip()}')
    return json.loads(done.stdout)


def shorten(description, steps):
    """Ends stages after steps: those of a list, which has one number for each stage, or None to keep its condition; or the same
    number for all. Nothing else ends them or the run."""
    stages = description['stages']
    if isinstance(steps, int):
        steps = [steps] * len(stages)
    if len(steps) != len(stages):
        raise ValueError(f'{len(steps)} numbers of steps for {len(stages)} stages: {", ".join(stage["name"] for stage in stages)}')
    for stage, count in zip(stages, steps):
        stage.pop('expect', None)
        if count is not None:
            stage['until'] = {'type': 'steps', 'value': count}
            stage['limit'] = LIMIT
    return description


def set_output(description, **values):
    output = description.setdefault('output', {})
    output.pop('picture', None)
    output.pop('summary', None)
    output.update(values)
    return description
