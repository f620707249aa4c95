#!/usr/bin/env python3
"""The state and contact hashes of the shipped scenes, as one CSV table: state_hashes.py PROGRAM [--against TABLE] [-o TABLE].

Every scene is run as shipped and in variants: both contact responses, both trees, one and two threads, everything or only what
the scene needs, resumed half-way; sheets without contact by every scheme, with fixed and with adaptive steps. A row holds the hashes of
the last state and a digest of all hashes of all steps. With --against the rows are compared with those of an earlier table, so
that code can be moved with proof that no bit of a result changed; exit code 1 if a row differs. Standard library only.
"""
import argparse
import csv
import hashlib
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent.parent / 'data' / 'scenes'
COLUMNS = ('scene', 'variant', 'steps', 'status', 'state_hash', 'contact_hash', 'digest')
SCHEMES = ('forward_euler', 'symplectic_euler', 'midpoint', 'rk4', 'backward_euler', 'implicit_midpoint', 'trapezoid', 'bdf2', 'tr_bdf2')
SAME = {'bullet': 7, 'threads': 7, 'resumed': 7, 'everything': 5}  # columns in which a variant is as the scene as shipped


def has_contact(scene):
    return bool(scene.get('obstacle')) or any(fabric.get('self_contact') for fabric in scene.get('fabric', {}).values())


def variants(name, scene):
    """(variant, settings, flags): settings go to --set."""
    scheme = scene.get('step', {}).get('scheme', 'backward_euler')
    yield 'shipped', [], []
    yield 'threads', [], ['--threads', '2']
    half = 1.0 if scene['duration'] == 'rest' else scene['duration'] / 2
    yield 'resumed', [], ['--checkpoint', str(half)]
    yield 'everything', [], ['--no-skip']
    if has_contact(scene):
        yield 'bullet', ['step.detector=bullet'], []
        if scheme == 'backward_euler':
            yield 'projection', ['step.contact_response=projection'], []
            yield 'tr_bdf2', ['step.scheme=tr_bdf2'], []
            yield 'adaptive', ['step.scheme=tr_bdf2', 'step.time_step=auto', 'step.tolerance=1e-2'], []
            yield 'adaptive_euler', ['step.time_step=auto', 'step.tolerance=3e-2'], []
            yield 'tight', ['step.newton_tolerance=1e-6'], []
        return
    for word in SCHEMES:
        explicit = SCHEMES.index(word) < 4
        length = '5e-5' if explicit else '0.008333333333333333'
        duration = 'duration=0.05' if explicit else 'duration=0.5'
        yield word, [f'step.scheme={word}', f'step.time_step={length}', duration], []
        if word != 'forward_euler':
            yield f'{word}_adaptive', [f'step.scheme={word}', 'step.time_step=auto', 'step.tolerance=1e-2', 'duration=0.1'], []
    yield 'velocity_damping', ['step.damping_form=velocity'], []
    yield 'direct', ['step.linear_solver=direct', 'duration=0.25'], []
    yield 'linearised', ['step.newton_iterations=1'], []
    yield 'automatic', ['step.scheme=auto'], []


def hashes_of(folder):
    with open(folder / 'steps.csv', newline='') as file:
        rows = list(csv.DictReader(file))
    digest = hashlib.sha256(''.join(row['state_hash'] + row['contact_hash'] for row in rows).encode()).hexdigest()[:16]
    if not rows:
        return 0, '', '', '', digest
    return len(rows), rows[-1]['status'], rows[-1]['state_hash'], rows[-1]['contact_hash'], digest


def iterations_of(rows):
    """Newton and linear iterations of the rows of a steps.csv."""
    rows = list(rows)
    return sum(int(row['newton']) for row in rows), sum(int(row['linear']) for row in rows)


def run_command(program, scene, settings, flags, folder):
    command = [program, 'run', str(scene), '--replay-hash', '--frames', 'none', '--quiet', '-o', str(folder), *flags]
    for setting in settings:
        command += ['--set', setting]
    return command


def run(program, scene, settings, flags, folder):
    return subprocess.run(run_command(program, scene, settings, flags, folder), capture_output=True, text=True)


def measure(job):
    program, scene, variant, settings, flags = job
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / 'run'
        done = run(program, scene, settings, flags, folder)
        if variant == 'resumed' and (folder / 'checkpoint.percale').exists():
            done = run(program, scene, settings, ['--resume', str(folder / 'checkpoint.percale')], folder)
        if not (folder / 'steps.csv').exists():
            reason = (done.stderr.strip().splitlines() or ['?'])[-1][-120:].replace(str(scratch), '')
            return (scene.stem, variant, 0, f'exit code {done.returncode}: {reason.rpartition("scenes/")[2]}', '', '', '')
        return (scene.stem, variant, *hashes_of(folder))


def measure_all(program, only, jobs):
    work = []
    for path in sorted(SCENES.glob('*.toml')):
        if only and path.stem not in only:
            continue
        with open(path, 'rb') as file:
            scene = tomllib.load(file)
        work += [(program, path, *variant) for variant in variants(path.stem, scene)]
    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(measure, work))


def unequal_within(rows):
    """Variants that must give what the scene as shipped gives."""
    shipped = {row[0]: row for row in rows if row[1] == 'shipped'}
    return [row for row in rows if row[1] in SAME and row[0] in shipped and row[2:SAME[row[1]]] != shipped[row[0]][2:SAME[row[1]]]]


def read_table(file):
    with open(file, newline='') as lines:
        return {(row['scene'], row['variant']): row for row in csv.DictReader(lines)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('program')
    parser.add_argument('--against', help='an earlier table')
    parser.add_argument('-o', '--output', help='write the table to this file')
    parser.add_argument('--scenes', nargs='*', default=[], help='names of scenes (default: all)')
    parser.add_argument('--jobs', type=int, default=2)
    options = parser.parse_args()
    rows = measure_all(options.program, set(options.scenes), options.jobs)
    if options.output:
        with open(options.output, 'w', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows([COLUMNS, *rows])
    faults = [f'{row[0]}, {row[1]}: not what the scene as shipped gives' for row in unequal_within(rows)]
    if options.against:
        known = read_table(options.against)
        for row in rows:
            before = known.get(row[:2])
            now = dict(zip(COLUMNS, map(str, row)))
            if before is None:
                faults.append(f'{row[0]}, {row[1]}: not in {options.against}')
            elif before != now:
                faults.append(f'{row[0]}, {row[1]}: was {list(before.values())[2:]}, is {list(now.values())[2:]}')
    print('\n'.join([*faults, f'{len(rows)} runs, {len(faults)} differ']))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
