#!/usr/bin/env python3
"""Changes files of every format that is read, and has the program read them: mutated_files.py PERCALE FOLDER [--count N] [--seed N]
[--only NAME]

FOLDER holds meshes, as .ci/fetch_meshes.sh leaves them (its folder `odd`); patterns, scenes and caches are those of data/ and of a run.
Of each format N files are made (default 200) from some small ones: bytes and numbers changed, parts left out, doubled or swapped, cut
off. Each goes through `doctor`, or what else reads it. Allowed are exit codes 0, 1 and 2, less than 20 s of CPU time and less than 2 GB.
Prints a table by format; exit code 1 if anything was not allowed, and the file is left in build/mutated.
"""
import argparse
import json
import random
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

from odd_meshes import Answer

ROOT = Path(__file__).resolve().parent.parent.parent
LEFT = ROOT / 'build' / 'mutated'
MESHES = ['.obj', '.off', '.ply', '.stl', '.gltf', '.glb', '.dae', '.fbx', '.3ds', '.amf', '.x3d', '.dxf', '.lwo', '.ase', '.x']
MOST_BYTES, MOST_SEEDS = 60000, 8
ALLOWED = 8 << 20  # what odd_meshes multiplies, for a limit of 2 GB and a quarter: the peak that is measured counts
SHEET = ('duration = 0.02\n[fabric.f]\nsprings = { structural = 100.0 }\n[[cloth]]\nname = "c"\nfabric = "f"\n'
         'grid = { size = [0.5, 0.5], vertices = [5, 5] }\npose = { translation = [0, 3, 0] }\n')


def mutated(data, chance):
    """The bytes with one to eight changes."""
    data = bytearray(data)
    for _ in range(chance.choice([1, 1, 2, 4, 8])):
        if not data:
            break
        at, length = chance.randrange(len(data)), chance.choice([1, 4, 16, 200])
        kind = chance.randrange(8)
        if kind == 0:
            data[at] = chance.randrange(256)
        elif kind == 1:
            data[at:at + 4] = chance.choice([b'\xff\xff\xff\xff', b'\x00\x00\x00\x00', b'\xff\xff\xff\x7f', b'\x00\x00\xc0\x7f'])
        elif kind == 2:
            del data[at:at + length]
        elif kind == 3:
            data[at:at] = data[at:at + length] * chance.choice([1, 3, 50])
        elif kind == 4:
            other = chance.randrange(len(data))
            data[at:at + length], data[other:other + length] = data[other:other + length], data[at:at + length]
        elif kind == 5:
            del data[at:]
        else:
            numbers = list(re.finditer(rb'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?', bytes(data)))
            if numbers:
                number = chance.choice(numbers)
                data[number.start():number.end()] = chance.choice(
                    [b'-1', b'0', b'4294967296', b'2147483647', b'18446744073709551615', b'1e308', b'nan', b'1.5', b'999999', b''])
    return bytes(data)


def json_pattern():
    """Two panels of every kind of curve, sewn at their sides."""
    curves = [{}, {'curvature': [0.5, 0.1]}, {'curvature': {'type': 'cubic', 'params': [[0.3, 0.1], [0.7, 0.1]]}},
              {'curvature': {'type': 'circle', 'params': [40.0, 0, 1]}}]
    edges = [{'endpoints': [k, (k + 1) % 4], **curves[k]} for k in range(4)]
    panels = {name: {'translation': [0, 90, depth], 'rotation': [0, turn, 0], 'vertices': [[0, 0], [40, 0], [40, 50], [0, 50]], 'edges': edges}
              for name, depth, turn in (('front', 20, 0), ('back', -20, 180))}
    stitches = [[{'panel': 'front', 'edge': 1}, {'panel': 'back', 'edge': 3}], [{'panel': 'front', 'edge': 3}, {'panel': 'back', 'edge': 1}]]
    return json.dumps({'pattern': {'panels': panels, 'stitches': stitches}, 'properties': {'units_in_meter': 100}}, indent=1)


def seeds_of(folder, suffix):
    files = [file for file in Path(folder).rglob('*') if file.suffix.lower() == suffix and file.stat().st_size <= MOST_BYTES]
    return sorted(files, key=lambda file: (file.stat().st_size, str(file)))[-MOST_SEEDS:]


def scene_with(keys, body=''):
    return SHEET.replace('grid = { size = [0.5, 0.5], vertices = [5, 5] }\n', keys) + body if keys else SHEET + body


def readers(program, folder, scratch):
    """Of each format: seeds, and what reads a file of it, as arguments of the program."""
    for suffix in MESHES:
        yield suffix, seeds_of(folder, suffix), lambda file: ['doctor', str(file)]
    own = scratch / 'two_panels.json'
    own.write_text(json_pattern())
    patterns = [*sorted((ROOT / 'data' / 'patterns').rglob('*')), own]
    for suffix in ('.json', '.toml'):
        yield f'pattern {suffix}', [file for file in patterns if file.suffix == suffix], \
            lambda file: ['sew', str(file), '-o', str(scratch / 'sewn.obj')]
    yield 'scene .toml', sorted((ROOT / 'data' / 'scenes').glob('*.toml'))[:MOST_SEEDS], lambda file: ['doctor', str(file)]
    run = scratch / 'run'
    made = scratch / 'made.toml'
    made.write_text(SHEET.replace('0.02', '0.1') + '[[obstacle]]\nname = "o"\nshape = { sphere = { radius = 0.1 } }\n')
    Answer([program, 'run', str(made), '-o', str(run), '--frames', 'obj,pc2,mdd', '--checkpoint', '0.02', '--quiet'], ALLOWED)
    body = scratch / 'body.obj'
    frames = sorted((run / 'frames').glob('c_*.obj'))
    body.write_bytes(frames[0].read_bytes() if frames else b'')

    def by_cache(file):
        scene = scratch / 'cached.toml'
        scene.write_text(SHEET + f'[[obstacle]]\nname = "o"\nmesh = "{body}"\ncache = "{file}"\n')
        return ['run', str(scene), '-o', str(scratch / 'cached'), '--quiet']

    for suffix in ('.pc2', '.mdd'):
        yield suffix, sorted(run.rglob(f'*{suffix}')), by_cache
    yield 'checkpoint', sorted(run.glob('*.percale')), \
        lambda file: ['run', str(made), '--resume', str(file), '-o', str(scratch / 'resumed'), '--quiet']


def try_format(program, name, seeds, read, wish):
    """(codes, most seconds, most bytes, complaints)."""
    chance = random.Random(f'{wish.seed} {name}')
    codes, seconds, peak, wrong = Counter(), 0.0, 0, []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(wish.count if seeds else 0):
            seed = seeds[number % len(seeds)]
            file = Path(folder) / f'{number}{seed.suffix}'
            file.write_bytes(mutated(seed.read_bytes(), chance))
            answer = Answer([program, *read(file)], ALLOWED)
            codes[answer.code] += 1
            seconds, peak = max(seconds, answer.seconds), max(peak, answer.peak)
            complaint = answer.complaint() or ('more than 2 GB' if answer.peak > 2e9 else '')
            if complaint:
                LEFT.mkdir(parents=True, exist_ok=True)
                (LEFT / file.name).write_bytes(file.read_bytes())
                wrong.append(f'{name}: {LEFT / file.name} (of {seed.name}): {complaint}')
            file.unlink()
    return codes, seconds, peak, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('program')
    parser.add_argument('folder')
    parser.add_argument('--count', type=int, default=200)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--only', help='formats whose name contains this')
    wish = parser.parse_args()
    bad = 0
    print('| format | files of | made | read | with errors | refused | other | most CPU s | most MB |\n|---|---|---|---|---|---|---|---|---|')
    with tempfile.TemporaryDirectory() as scratch:
        for name, seeds, read in readers(wish.program, wish.folder, Path(scratch)):
            if wish.only and wish.only not in name:
                continue
            codes, seconds, peak, wrong = try_format(wish.program, name, seeds, read, wish)
            other = sum(codes.values()) - codes[0] - codes[1] - codes[2]
            print(f'| {name} | {len(seeds)} | {sum(codes.values())} | {codes[0]} | {codes[1]} | {codes[2]} | {other} | {seconds:.1f} '
                  f'| {peak / 1e6:.0f} |', flush=True)
            bad += len(wrong)
            for line in wrong:
                print(line, flush=True)
    print(f'{bad} not allowed')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
