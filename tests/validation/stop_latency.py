#!/usr/bin/env python3
"""Stops the program amid long work: stop_latency.py PERCALE FOLDER [--only NAME] [--most SECONDS]

Scenes whose steps, lists, certificates, repairs, plans, panels or stitches are large are made in FOLDER. Each command is sent SIGTERM
some seconds after its start. Prints a table: at what time, and how many seconds later it had ended. Exit code 1 where one took longer
than is wanted (--most, 2 s: the machine may be busy), ended otherwise than as a stopped program, or left a report that is not whole.
"""
import argparse
import json
import math
import signal
import subprocess
import sys
import time
from pathlib import Path

MOMENTS = (0.2, 1.0, 3.0, 5.0, 8.0)  # s
WAIT = 60  # s
STOPPED = (130, -signal.SIGTERM)  # by itself, or before there was anything to stop
FABRIC = ('[fabric.f]\narea_density = 0.2\nthickness = 0.003\nself_contact = {self_contact}\nstretch_stiffness = [300.0, 300.0]\n'
          'bend_stiffness = 1e-5\n')
SHEET = ('[[cloth]]\nname = "sheet"\nfabric = "f"\ngrid = {{ size = [{size}, {size}], vertices = [{count}, {count}] }}\n'
         'pose = {{ translation = [0.0, {height}, 0.0] }}\n')
SPRINGS = '[fabric.f]\nsprings = { structural = 1000.0, shear = 500.0, bend = 10.0 }\n'


def scene(folder, name, *parts):
    (folder / f'{name}.toml').write_text('duration = 100.0\n' + ''.join(parts))
    return f'{name}.toml'


def sheet(count, height=0.32, size=1.6):
    return SHEET.format(count=count, height=height, size=size)


def ball(folder, rows):
    """An obstacle of 4 rows^2 triangles, by latitude and longitude; its mesh."""
    file, columns = f'ball_{rows}.obj', 2 * rows
    with open(folder / file, 'w', encoding='ascii') as out:
        for row in range(1, rows):
            for column in range(columns):
                up, around = math.pi * row / rows, math.pi * column / rows
                out.write(f'v {0.3 * math.sin(up) * math.cos(around):.7f} {0.3 * math.cos(up):.7f} {0.3 * math.sin(up) * math.sin(around):.7f}\n')
        out.write('v 0 0.3 0\nv 0 -0.3 0\n')
        top, bottom = columns * (rows - 1) + 1, columns * (rows - 1) + 2
        for column in range(columns):
            here, other, last = column + 1, (column + 1) % columns + 1, columns * (rows - 2)
            out.write(f'f {top} {other} {here}\nf {bottom} {last + here} {last + other}\n')
            for row in range(rows - 2):
                a, b = row * columns + here, row * columns + other
                out.write(f'f {a} {b} {a + columns}\nf {b} {b + columns} {a + columns}\n')
    return f'[[obstacle]]\nname = "ball"\nmesh = "{file}"\n'


def circle_pattern(folder, corners):
    """A panel with so many corners."""
    points = ',\n'.join(f'[{math.cos(2 * math.pi * k / corners):.9f}, {math.sin(2 * math.pi * k / corners):.9f}]' for k in range(corners))
    (folder / 'panel.toml').write_text(f'unit = "m"\n[[panel]]\nname = "round"\npoints = [{points}]\n')
    return 'panel.toml'


def stitched(folder, side):
    """Two sheets in an OBJ file, every vertex stitched to that of the other."""
    with open(folder / 'stitched.obj', 'w', encoding='ascii') as out:
        for height in (0.32, 0.33):
            for k in range(side * side):
                out.write(f'v {k % side / side:.6f} {height} {k // side / side:.6f}\n')
        for first in (1, 1 + side * side):
            for k in range(side * (side - 1)):
                if k % side < side - 1:
                    a = first + k
                    out.write(f'f {a} {a + side} {a + 1}\nf {a + 1} {a + side} {a + side + 1}\n')
        for k in range(side * side):
            out.write(f'stitch {k} {k + side * side}\n')
    return 'stitched.obj'


def commands(folder):
    """(name, arguments) of each."""
    cloth, bare = FABRIC.format(self_contact='true'), FABRIC.format(self_contact='false')
    fine = scene(folder, 'fine', cloth, sheet(320), ball(folder, 20))
    still = scene(folder, 'still', bare, sheet(33), ball(folder, 570))
    large = scene(folder, 'large', bare, sheet(150), ball(folder, 400))
    inside = scene(folder, 'inside', cloth, sheet(160, 0.0), ball(folder, 140))
    plan = scene(folder, 'plan', '[step]\nscheme = "rk4"\ntime_step = 1e-5\n', SPRINGS, sheet(1000))
    huge = scene(folder, 'huge', SPRINGS, sheet(4096))
    small = scene(folder, 'small', SPRINGS, '[step]\nscheme = "backward_euler"\n', sheet(401), '[output]\nframes = "none"\n')
    (folder / 'study.toml').write_text(f'scene = "{fine}"\n[vary]\n"step.time_step" = [0.01, 0.005]\n')
    stitches = scene(folder, 'stitches', SPRINGS.replace('shear = 500.0', 'shear = 0.0'), f'[[cloth]]\nname = "two"\nfabric = "f"\nmesh = "{stitched(folder, 450)}"\n'
                     '[[seam]]\ncloths = ["two", "two"]\nfile = "mesh"\n')
    return [('run, 102,400 vertices that meet themselves', ['run', fine, '-o', 'out']),
            ('run, every step certified', ['run', fine, '-o', 'out', '--certify-steps']),
            ('run, a body of 1.3 million triangles', ['run', still, '-o', 'out']),
            ('run, a body of 640,000 triangles', ['run', large, '-o', 'out']),
            ('run, distances in its frames', ['run', large, '-o', 'out', '--frames', 'vtp', '--set', 'output.fields=["distance"]']),
            ('run --checkpoint', ['run', fine, '-o', 'out', '--checkpoint', '0.05']),
            ('run, a sheet through a body', ['run', inside, '-o', 'out']),
            ('run, the plan of a million vertices', ['run', plan, '-o', 'out']),
            ('run, 16.8 million vertices', ['run', huge, '-o', 'out']),
            ('plan of them', ['plan', huge]),
            ('run, 202,500 stitches', ['run', stitches, '-o', 'out']),
            ('check', ['check', fine]),
            ('check --resume', ['check', fine, '--resume', 'kept']),
            ('sweep', ['sweep', 'study.toml', '-o', 'swept']),
            ('compare', ['compare', small, '--set', 'duration=1', '-o', 'compared']),
            ('stress', ['stress', small, '-o', 'stressed']),
            ('drape', ['drape', 'stitched.obj', 'ball_570.obj', '-o', 'draped.obj']),
            ('sew, a panel of a million corners', ['sew', circle_pattern(folder, 1000000), '-o', 'sewn.obj'])]


def ended_after(program, arguments, folder, moment):
    """(exit code or None where it had ended before, seconds from the signal to the end)."""
    with subprocess.Popen([program, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        try:
            run.wait(moment)
            return None, 0.0
        except subprocess.TimeoutExpired:
            run.send_signal(signal.SIGTERM)
        sent = time.monotonic()
        try:
            run.wait(WAIT)
        except subprocess.TimeoutExpired:
            run.kill()
            run.wait()
        return run.returncode, time.monotonic() - sent


def broken_files(folder):
    """Files that were left and are not whole."""
    broken = []
    for file in folder.rglob('report.json'):
        try:
            json.loads(file.read_text())
        except ValueError:
            broken.append(file.name)
    return broken


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('program', type=Path)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--most', type=float, default=2.0, help='seconds from the signal to the end (default 2)')
    parser.add_argument('--only', default='', help='commands whose name holds this text')
    wish = parser.parse_args()
    wish.folder.mkdir(parents=True, exist_ok=True)
    program, wrong = wish.program.resolve(), 0
    all_commands = commands(wish.folder)
    print('| command | ' + ' | '.join(f'after {moment:g} s' for moment in MOMENTS) + ' |\n|' + '---|' * (1 + len(MOMENTS)), flush=True)
    for name, arguments in all_commands:
        if wish.only not in name:
            continue
        cells = []
        for moment in MOMENTS:
            code, seconds = ended_after(program, arguments, wish.folder, moment)
            cells.append('had ended' if code is None else f'{seconds:.2f}' + ('' if code in STOPPED else f' (exit code {code})'))
            wrong += code is not None and (code not in STOPPED or seconds > wish.most)
        wrong += len(broken_files(wish.folder))
        print(f'| {name} | ' + ' | '.join(cells) + ' |', flush=True)
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
