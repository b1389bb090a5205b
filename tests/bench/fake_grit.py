#!/usr/bin/env python3
"""Stands for grit where a test of bench/ is not about what grit computes. FAKE_GRIT has, by the scene's name or "*", what
run.json is to say; or how it is to fail."""
import json
import os
import sys
from pathlib import Path

if '--version' in sys.argv:
    print('grit 0.0.0 (fake)')
    sys.exit()
if sys.argv[1] == 'expand':
    print(json.dumps({'probes': {'test': {}, 'walls': {}, 'energy': {}}}))
    sys.exit()
scene, out = Path(sys.argv[2]).stem, Path(sys.argv[sys.argv.index('--out') + 1])
fake = json.loads(os.environ.get('FAKE_GRIT', '{}'))
given = {'revision': 'fake', 'before': 1.0, 'end': 2.0, 'run': 0.5, 'rebuilds': 2, 'fails': ''} | fake.get('*', {}) | \
    fake.get(scene, {}) | fake.get(out.name, {})
if given['fails']:
    print(given['fails'])
    sys.exit(4)
if given.get('silent'):
    sys.exit()
settings = dict(word.split('=', 1) for word in sys.argv if word.startswith('/') and '=' in word)
out.mkdir(parents=True, exist_ok=True)
grains = 8
(out / 'packing.txt').write_text('# cell 0 0 0 to 1 1 1, m\n' + ''.join(
    f'{i & 1} {i >> 1 & 1} {i >> 2 & 1} 0.5\n' for i in range(grains)))
steps = int(json.loads(settings.get('/stages/1/until/value', '100')) or 1)
written = out / 'run.json.part'  # never seen half written, as grit's own is not
written.write_text(json.dumps({
    'grit': {'revision': given['revision']}, 'bodies': grains, 'contacts_per_body': 4.0, 'steps': 10 + steps,
    'time_step_s': 0.8e-6, 'critical_time_step_s': 1e-6, 'wall_s': given['run'], 'rebuilds': given['rebuilds'],
    'model': {'bytes': 1000},
    'stages': [{'name': 'warm up', 'step': 10, 'wall_s': given['before']},
               {'name': 'timed', 'step': 10 + steps, 'wall_s': given['end']}]}))
written.rename(out / 'run.json')
print('packing/mean_stress: peak 1.5e5 Pa, final 1.5e5 Pa')
