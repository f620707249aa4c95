#!/usr/bin/env python3
"""A study here and on Slurm gives the same table: tests/validation/slurm_sweep.py PERCALE FOLDER [--runs N].

Makes a study of N small drapes (default 1000) twice in FOLDER: by `percale sweep --jobs` and by `percale sweep --slurm`, waits for
Slurm and compares study.csv byte by byte. Needs a Slurm that takes jobs from here (sbatch, squeue). Exit code 1 if the tables differ, 77
where there is no Slurm.
"""
import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

SCENE = '''duration = 0.3
[fabric.s]
springs = { structural = 1000.0, shear = 500.0, bend = 10.0 }
thickness = 0.01
[[cloth]]
name = "sheet"
fabric = "s"
grid = { size = [0.5, 0.5], vertices = [9, 9] }
pose = { translation = [0.0, 0.25, 0.0] }
[[obstacle]]
name = "ball"
shape = { sphere = { radius = 0.2 } }
[expect]
intersections = 0
'''
STUDY = '''scene = "drape.toml"
seed = 1
draws = {draws}
[vary]
"fabric.s.springs.bend" = [0.1, 1.0, 10.0, 100.0]
"obstacle.ball.friction" = {{ uniform = [0.1, 0.9] }}
'''


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('percale', type=Path)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--runs', type=int, default=1000)
    options = parser.parse_args()
    if not shutil.which('sbatch'):
        print('skipped: there is no Slurm here')
        return 77
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / 'drape.toml').write_text(SCENE)
    study = options.folder / 'study.toml'
    study.write_text(STUDY.format(draws=max(1, options.runs // 4)))
    tables = {}
    for name, more in {'here': ['--jobs', str(os.cpu_count())], 'slurm': ['--slurm']}.items():
        started = time.monotonic()
        subprocess.run([options.percale, 'sweep', study, '-o', options.folder / name, *more], check=True)
        table = options.folder / name / 'study.csv'
        while not table.exists() or subprocess.run(['squeue', '-h'], capture_output=True, text=True, check=True).stdout:
            time.sleep(1)
        tables[name] = table.read_bytes()
        print(f'{name}: {tables[name].count(b"finished")} runs finished in {time.monotonic() - started:.0f} s', flush=True)
    same = tables['here'] == tables['slurm']
    print('the tables are the same' if same else 'the tables DIFFER')
    return 0 if same else 1


if __name__ == '__main__':
    sys.exit(main())
