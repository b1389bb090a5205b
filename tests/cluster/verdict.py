"""How a test of schedulers ends."""

SKIPPED = 77  # exit status


class Failed(Exception):
    pass


def expect(holds, what):
    if not holds:
        raise Failed(what)
