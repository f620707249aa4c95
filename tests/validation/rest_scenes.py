#!/usr/bin/env python3
"""Whether cloth comes to rest: rest_scenes.py PERCALE FOLDER [--count 60] [--steps 30 60 240] [--only KIND]

Draws scenes of twelve kinds with a fixed seed (folds, stacks of 1 to 20, crumples, lifted edges, a weight in a held sheet, towels over
bars, over edges, sleeves, layers on a ball, sheets on knobs, strips pinched between boxes, a sleeve over a sleeve), each with a random
fabric, and runs each with steps of 1/30, 1/60 and 1/240 s until rest, for at most 10 s after the last thing that moves. Prints a table:
seconds to rest after that, Newton iterations a step, the smallest distance at the end over the thickness. Exit code 1 where one does
not rest or something crosses.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import random
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

PATIENCE = 10.0  # s
TARGET = 2.0  # s after the last move


class Draw:
    """One scene, written into a file: a fabric, cloths, obstacles and events, and when the last of these ends."""

    def __init__(self, folder, kind, seed):
        self.folder, self.name, self.kind = folder, f'{kind}_{seed}', kind
        self.random = random.Random(f'{kind} {seed}')
        self.thickness = self.random.choice([0.001, 0.002, 0.003, 0.005])
        self.last, self.parts = 0.0, []
        modulus = 10.0 ** self.pick(1.5, 3.3)  # N/m
        self.parts.append(f'[fabric.f]\narea_density = {self.pick(0.1, 0.4):.3f}\nthickness = {self.thickness}\nself_contact = true\n'
                          f'friction = {self.pick(0.2, 0.6):.2f}\nstretch_stiffness = [{modulus:.1f}, {modulus:.1f}]\n'
                          f'bend_stiffness = {10.0 ** self.pick(-5.3, -4.0):.3g}\n'
                          f'damping_time = {self.random.choice([0.0, 0.005, 0.01, 0.03])}\n')
        getattr(self, kind)()
        self.file = folder / f'{self.name}.toml'
        self.file.write_text(self.text())

    def pick(self, low, high):
        return self.random.uniform(low, high)

    def cloth(self, name, size, count, at, turn=(1.0, 0.0, 0.0, 0.0), pin=''):
        self.parts.append(f'[[cloth]]\nname = "{name}"\nfabric = "f"\ngrid = {{ size = [{size[0]:.4f}, {size[1]:.4f}], vertices = [{count[0]}, '
                          f'{count[1]}] }}\npose = {{ translation = [{at[0]:.5f}, {at[1]:.5f}, {at[2]:.5f}], rotation = {list(turn)} }}\n{pin}')

    def obstacle(self, name, shape, at=(0.0, 0.0, 0.0), turn=(1.0, 0.0, 0.0, 0.0)):
        self.parts.append(f'[[obstacle]]\nname = "{name}"\n{shape}\nfriction = {self.pick(0.2, 0.6):.2f}\npose = {{ translation = '
                          f'[{at[0]:.5f}, {at[1]:.5f}, {at[2]:.5f}], rotation = {list(turn)} }}\n')

    def table(self, height=0.0):
        self.obstacle('table', 'shape = { plane = { half_size = 2.0 } }', (0.0, height, 0.0))

    def event(self, time, text, ends=0.0):
        self.parts.append(f'[[event]]\ntime = {time}\n{text}\n')
        self.last = max(self.last, time + ends)

    def fold(self):
        columns, rows, length = 15, 36, self.pick(0.4, 0.6)
        first, end = columns * (rows - 1), columns * rows - 1
        self.cloth('sheet', (0.2, length), (columns, rows), (0.0, 1.1 * self.thickness, 0.0))
        self.table()
        self.event(0.1, f'pin = {{ cloth = "sheet", vertices = [{first}, {end}] }}')
        self.event(0.2, f'move = {{ cloth = "sheet", vertices = [{first}, {end}], to = [0.0, 0.12, {-0.5 * length:.3f}], over = 0.6 }}', 0.6)
        self.event(0.8, f'move = {{ cloth = "sheet", vertices = [{first}, {end}], to = [0.0, -0.1, {-0.48 * length:.3f}], over = 0.6 }}', 0.6)
        self.event(1.5, f'unpin = {{ cloth = "sheet", vertices = [{first}, {end}] }}')

    def stack(self):
        step = 0.3 / 10
        for layer in range(self.random.choice([1, 2, 3, 5, 8, 20])):
            aside = self.random.choice([0.0, step, 0.5 * step, self.pick(0.0, step)])
            self.cloth(f'h{layer}', (0.3, 0.3), (11, 11), (aside, self.thickness * (layer + 1), 0.5 * aside))
        self.table()

    def crumple(self):
        a, b = self.pick(1.3, 1.8), self.pick(0.1, 0.5)
        turn = (math.cos(a / 2) * math.cos(b / 2), math.sin(a / 2) * math.cos(b / 2), math.cos(a / 2) * math.sin(b / 2), math.sin(a / 2) * math.sin(b / 2))
        self.cloth('sheet', (0.5, 0.5), (26, 26), (0.0, 0.36, 0.0), turn)
        self.table()

    def lifted(self):
        edge = '{ box = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.01]] }'
        self.cloth('sheet', (0.2, 0.5), (15, 36), (0.0, 0.02 + self.thickness, 0.0), pin=f'pin = {edge}\n')
        self.table()
        self.event(0.1, f'move = {{ cloth = "sheet", vertices = {edge}, to = [0.0, {self.pick(-0.005, 0.03):.3f}, {self.pick(0.0, 0.1):.3f}], over = 0.5 }}', 0.5)

    def pouch(self):
        corners = [0, 20, 420, 440]
        self.cloth('pouch', (0.5, 0.5), (21, 21), (0.0, 0.5, 0.0), pin=f'pin = {corners}\n')
        self.cloth('weight', (0.15, 0.15), (9, 9), (0.01, 0.5 + 1.5 * self.thickness, 0.007))

    def bar(self):
        self.obstacle('bar', f'shape = {{ capsule = {{ radius = {self.pick(0.01, 0.05):.4f}, height = 0.8 }} }}', turn=(math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))
        self.cloth('towel', (0.3, 0.6), (16, 31), (self.pick(-0.02, 0.02), 0.07, self.pick(-0.05, 0.05)))

    def edge(self):
        self.obstacle('box', 'shape = { box = { size = [0.4, 0.4, 0.4] } }', (0.0, -0.2, 0.0))
        self.cloth('towel', (0.3, 0.4), (16, 21), (self.pick(-0.05, 0.05), 2.0 * self.thickness, self.pick(0.0, 0.15)))

    def tube(self, name, radius, around, rows, length):
        file = self.folder / f'{self.name}_{name}.obj'
        with open(file, 'w', encoding='ascii') as out:
            for i in range(around * rows):
                angle, up = 2 * math.pi * (i % around) / around, length * (i // around / (rows - 1) - 0.5)
                out.write(f'v {radius * math.cos(angle):.7f} {up:.7f} {radius * math.sin(angle):.7f}\n')
            for row in range(rows - 1):
                for i in range(around):
                    a, b = row * around + i + 1, row * around + (i + 1) % around + 1
                    out.write(f'f {a} {b} {b + around}\nf {a} {b + around} {a + around}\n')
        return file.name

    def sleeve(self):
        radius, around = self.pick(0.03, 0.08), self.random.choice([20, 30, 44])
        rows = round(0.2 * around / (2 * math.pi * radius)) + 1
        worn = self.tube('worn', radius / math.cos(math.pi / around) + 1.5 * self.thickness, around, rows, 0.2)
        rest = self.tube('rest', radius / self.pick(0.98, 1.3), around, rows, 0.2)
        self.obstacle('arm', f'shape = {{ capsule = {{ radius = {radius:.5f}, height = 0.5 }} }}')
        self.parts.append(f'[[cloth]]\nname = "sleeve"\nfabric = "f"\nmesh = "{worn}"\nrest = "{rest}"\n')

    def layers(self):
        self.obstacle('ball', 'shape = { sphere = { radius = 0.15 } }')
        for layer in range(self.random.choice([2, 3])):
            half = self.pick(-0.3, 0.3)
            self.cloth(f's{layer}', (0.4, 0.4), (21, 21), (0.01, 0.15 + 2.0 * self.thickness * (layer + 1), 0.007), (math.cos(half), 0.0, math.sin(half), 0.0))
        self.table(-0.2)

    def knobs(self):
        for i in range(9):
            self.obstacle(f'knob{i}', 'shape = { sphere = { radius = 0.012 } }', (0.1 * (i % 3 - 1), -0.012, 0.1 * (i // 3 - 1)))
        self.cloth('sheet', (0.35, 0.35), (24, 24), (self.pick(-0.02, 0.02), 1.5 * self.thickness, self.pick(-0.02, 0.02)))

    def pinch(self):
        """One to three strips between boxes, within them or hanging out on both sides."""
        layers, length = self.random.choice([1, 2, 3]), self.random.choice([0.16, self.pick(0.35, 0.55)])
        aside = self.pick(-0.02, 0.02) if length < 0.2 else self.pick(-0.05, 0.05)
        for layer in range(layers):
            self.cloth(f'strip{layer}', (0.15, length), (9, round(length / 0.02) + 1), (0.0, 1.05 * self.thickness * (layer + 1), aside))
        self.obstacle('lower', 'shape = { box = { size = [0.25, 0.3, 0.2] } }', (0.0, -0.15, 0.0))
        start, end = ((layers + 1) * self.thickness * share for share in (1.5, self.pick(0.65, 1.0)))
        motion = ', '.join(f'{{ time = {time}, translation = [0.0, {0.05 + gap:.5f}, 0.0] }}' for time, gap in ((0.1, start), (0.5, end)))
        self.obstacle('upper', f'shape = {{ box = {{ size = [0.25, 0.1, 0.2] }} }}\nmotion = [{motion}]', (0.0, 0.05 + start, 0.0))
        self.last = 0.5

    def worn_layers(self):
        """Two taut sleeves on an arm, the outer one shorter and over a part of the inner one."""
        radius, around = self.pick(0.03, 0.08), self.random.choice([20, 30, 44])
        self.obstacle('arm', f'shape = {{ capsule = {{ radius = {radius:.5f}, height = 0.5 }} }}')
        outside = radius
        for layer, (name, length) in enumerate([('inner', 0.2), ('outer', self.pick(0.1, 0.16))], 1):
            outside = outside / math.cos(math.pi / around) + 1.5 * self.thickness
            rows = round(length * around / (2 * math.pi * radius)) + 1
            worn = self.tube(f'{name}_worn', outside, around, rows, length)
            rest = self.tube(f'{name}_rest', (radius + layer * self.thickness) / self.pick(1.08, 1.3), around, rows, length)
            half, up = self.pick(-0.3, 0.3), self.pick(-0.04, 0.04)
            self.parts.append(f'[[cloth]]\nname = "{name}"\nfabric = "f"\nmesh = "{worn}"\nrest = "{rest}"\npose = {{ translation = [0.0, {up:.5f}, '
                              f'0.0], rotation = [{math.cos(half)}, 0.0, {math.sin(half)}, 0.0] }}\n')

    def text(self):
        return f'title = "{self.kind}"\nduration = "rest"\nmax_duration = {self.last + PATIENCE}\n[expect]\nintersections = 0\n' + ''.join(self.parts)


KINDS = ('fold', 'stack', 'crumple', 'lifted', 'pouch', 'bar', 'edge', 'sleeve', 'layers', 'knobs', 'pinch', 'worn_layers')


def run(program, draw, rate):
    out = draw.folder / f'{draw.name}_{rate}'
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([program, 'run', draw.file, '-o', out, '--threads', '1', '--quiet', '--frames', 'none', '--set', f'step.time_step={1.0 / rate!r}'],
                   check=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    report, steps = out / 'report.json', out / 'steps.csv'
    if not report.exists() or not steps.exists():
        return {'status': 'refused'}
    told = json.loads(report.read_text())
    rows = list(csv.DictReader(steps.read_text().splitlines()))
    distance = [float(row['smallest_distance']) for row in rows if row['smallest_distance'] not in ('', 'inf')]
    return {'status': told['status'], 'seconds': float(rows[-1]['time']) - draw.last, 'newton': sum(int(row['newton']) for row in rows) / len(rows),
            'gap': distance[-1] / draw.thickness if distance else math.nan, 'cpu': told['cpu_s'], 'crossing': told.get('intersections', 0)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('folder', type=lambda text: Path(text).resolve())
    parser.add_argument('--count', type=int, default=60)
    parser.add_argument('--steps', type=int, nargs='+', default=[30, 60, 240])
    parser.add_argument('--only', choices=KINDS)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    draws = [Draw(arguments.folder, KINDS[i % len(KINDS)], i // len(KINDS)) for i in range(arguments.count)]
    tasks = [(draw, rate) for draw in draws for rate in arguments.steps if arguments.only in (None, draw.kind)]
    print('| scene | step, 1/s | ended | s to rest | Newton a step | gap / thickness | CPU s |\n|---|---|---|---|---|---|---|')
    bad, late, seconds = 0, 0, []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for (draw, rate), r in zip(tasks, pool.map(lambda task: run(arguments.program, *task), tasks)):
            at_rest = r['status'] == 'finished' and not r.get('crossing')
            bad += not at_rest
            if r['status'] == 'refused':
                print(f'| {draw.name} | {rate} | refused |')
                continue
            seconds.append(r['seconds'])
            late += r['seconds'] > TARGET
            print(f'| {draw.name} | {rate} | {r["status"]} | {r["seconds"]:.2f} | {r["newton"]:.1f} | {r["gap"]:.2f} | {r["cpu"]:.1f} |', flush=True)
    print(f'{len(tasks)} runs, {bad} not at rest, {late} later than {TARGET:g} s; median {statistics.median(seconds or [0.0]):.2f} s')
    sys.exit(1 if bad else 0)


if __name__ == '__main__':
    main()
