#!/usr/bin/env python3
"""Proves by counted instructions that skipped work is not done: cost_proofs.py PERCALE COLLISION_LIBRARY,... OTHER_LIBRARY,...

PERCALE is the program, the two lists are static libraries: a function of the collision layer is one that the first list defines and
the second does not. Instructions are counted by valgrind's callgrind; without valgrind the proofs are skipped (exit code 77).
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77

SHEET = '''
title = "a damped sheet held at its corners"
duration = {duration}
[step]
scheme = "{scheme}"
time_step = {time_step}
[fabric.sheet]
springs = {{ structural = 1000.0, shear = 500.0, bend = {bend} }}
spring_damping = 1.0
[[cloth]]
name = "sheet"
fabric = "sheet"
grid = {{ size = [0.5, 0.5], vertices = [17, 17] }}
pin = [0, 16, 272, 288]
[output]
frames = "none"
fps = {fps}
'''


def defined_functions(libraries):
    """Names, without arguments, of the functions of percale that static libraries define in their sources."""
    listing = subprocess.run(['nm', '-C', '--defined-only', *libraries], capture_output=True, text=True, check=True).stdout
    return {name_of(m[1]) for m in re.finditer(r'^[0-9a-f]+ [Tt] (percale::.*)$', listing, re.M)}


def name_of(function):
    """percale::(anonymous namespace)::f(int) [clone .cold] -> percale::(anonymous namespace)::f"""
    return re.sub(r'\(.*', '', function.replace('(anonymous namespace)', '{anonymous}'))


def self_cost(dump):
    """Instructions of each function, without those it calls."""
    cost, function, call = {}, '', False
    for line in dump.splitlines():
        if line.startswith('fn='):
            function = name_of(line[3:])
        elif line.startswith('calls='):
            call = True
        elif re.match(r'\d+ \d+$', line):
            if not call:
                cost[function] = cost.get(function, 0) + int(line.split()[1])
            call = False
    return cost


class Runner:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def scene(self, scheme='backward_euler', time_step=1 / 60, steps=10, bend=10.0, fps=0.01, tail=''):
        file = self.folder / 'scene.toml'
        file.write_text(SHEET.format(duration=steps * time_step, scheme=scheme, time_step=time_step, bend=bend, fps=fps) + tail)
        return file

    def counted(self, *options, **scene):
        """Self cost of each function in a run."""
        dump = self.folder / 'callgrind.out'
        subprocess.run(['valgrind', '--tool=callgrind', '--compress-strings=no', '--compress-pos=no', f'--callgrind-out-file={dump}',
                        self.program, 'run', self.scene(**scene), '-o', self.folder / 'out', '--quiet', *options],
                       capture_output=True, check=True)
        return self_cost(dump.read_text())

    def report(self):
        return json.loads((self.folder / 'out' / 'report.json').read_text())

    def plan(self, **scene):
        run = subprocess.run([self.program, 'plan', '--json', self.scene(**scene)], capture_output=True, text=True, check=True)
        return json.loads(run.stdout)


def added_cost(runner, steps, chosen, options=(), **scene):
    """Instructions a step that the second of two runs, longer by some steps, adds in the chosen functions."""
    first, second = (sum(n for f, n in runner.counted(*options, steps=count, **scene).items() if chosen(f)) for count in steps)
    return (second - first) / (steps[1] - steps[0])


def prove_no_collision(runner, collision):
    """Without obstacles no function of the collision layer runs; with nothing skipped they do."""
    spent = {options: sum(n for f, n in runner.counted(*options).items() if f in collision) for options in ((), ('--no-skip',))}
    print(f'collision layer without obstacles: {spent[()]} instructions, with --no-skip {spent[("--no-skip",)]}')
    return spent[()] == 0 and spent[('--no-skip',)] > 0


def prove_sleep(runner):
    """A step asleep costs less than 2 % of one of the same cloth on the move."""
    def everything(function):
        return True
    moving = added_cost(runner, (10, 20), everything)
    asleep = added_cost(runner, (400, 800), everything)
    slept = runner.report()['sleeping_steps']
    print(f'a step: {moving:.4g} instructions moving, {asleep:.4g} asleep: {100 * asleep / moving:.3g} % (report line included), '
          f'{slept} of 800 steps asleep')
    return slept > 400 and asleep < 0.02 * moving


def prove_no_bending(runner):
    """Without bending no bending spring exists and the springs' cost falls as their number."""
    scene = {'scheme': 'rk4', 'time_step': 1e-5}

    def of_springs(function):
        return 'percale::' in function and 'spring' in function
    each = []
    for bend in (10.0, 0.0):
        springs = runner.plan(bend=bend, **scene)['springs']
        each.append(added_cost(runner, (10, 30), of_springs, bend=bend, **scene) / sum(springs.values()))
        print(f'bend = {bend} N/m: springs {springs}, {each[-1]:.4g} instructions a step and spring')
    return springs['bend'] == 0 and abs(each[1] / each[0] - 1) < 0.05


def prove_no_ledger(runner):
    """Unless step.measure asks for it nothing of the ledger runs."""
    spent = [sum(n for f, n in runner.counted(*options).items() if 'spring_loss' in f or 'account_part' in f)
             for options in ((), ('--set', 'step.measure="ledger"'))]
    print(f'ledger of energy: {spent[0]} instructions, {spent[1]} where it is asked for')
    return spent[0] == 0 and spent[1] > 0


BODY = '''
[[obstacle]]
name = "ball"
shape = {{ sphere = {{ radius = 0.2 }} }}
on_pinch = "{on_pinch}"
pose = {{ translation = [0.0, -0.21, 0.0] }}
motion = [{{ time = 0.0, translation = [0.0, -0.21, 0.0] }}, {{ time = 1.0, translation = [0.0, 0.0, 0.0] }}]
'''


def prove_no_deforming(runner):
    """Over a rigid obstacle that moves nothing runs that bodies that bend or give way need."""
    parts = ('deform', 'yield_to_cloth', 'retreats_of', 'refit', 'shape_after', 'mark_flat', 'BodyShapes::')
    spent = [sum(n for f, n in runner.counted(tail=BODY.format(on_pinch=on_pinch)).items()
                 if any(part in f for part in parts) and 'any_yields' not in f) for on_pinch in ('stop', 'yield')]
    print(f'bodies that bend: {spent[0]} instructions with a rigid one, {spent[1]} with one that yields')
    return spent[0] == 0 and spent[1] > 0


STANDING = '''
[[obstacle]]
name = "ball"
shape = { sphere = { radius = 0.2 } }
pose = { translation = [0.0, -0.21, 0.0] }
'''


def prove_standing_body(runner):
    """However many frames are certified, a body that stands still gets its tree, and is tested for being closed, once."""
    parts = ('BoxTree::split', 'BoxTree::partition', 'is_watertight')
    spent = [sum(n for f, n in runner.counted(tail=STANDING, fps=fps).items() if any(part in f for part in parts)) for fps in (1, 60)]
    print(f'trees of certificates: {spent[0]} instructions with frames of the start and the end, {spent[1]} with one a step')
    return spent[0] == spent[1] > 0


SCHEMES = {'forward_euler': 1e-6, 'symplectic_euler': 2e-5, 'midpoint': 1e-6, 'rk4': 2e-5, 'backward_euler': 1 / 60,
           'implicit_midpoint': 1 / 60, 'trapezoid': 1 / 60, 'bdf2': 1 / 60, 'tr_bdf2': 1 / 60}


def prove_measuring(runner):
    """What is measured by default, 30 frames a second, adds at most 2 % to a step without any measuring, in all schemes."""
    good = True
    for scheme, time_step in SCHEMES.items():
        steps = (4, 24) if time_step > 1e-3 else (10, 10 + min(round(1 / 30 / time_step), 2000))
        cost = [added_cost(runner, steps, lambda function: function.startswith('percale::'), options,
                           scheme=scheme, time_step=time_step, fps=30) for options in ((), ('--set', 'step.measure="none"'))]
        print(f'{scheme}: {cost[0]:.4g} instructions a step, {cost[1]:.4g} with measure = none: ratio {cost[0] / cost[1]:.4f}')
        good = good and cost[0] <= 1.02 * cost[1]
    return good


def main(program, collision, others):
    if shutil.which('valgrind') is None:
        print('cost proofs skipped: valgrind is not installed')
        return SKIPPED
    functions = defined_functions(collision.split(',')) - defined_functions(others.split(','))
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(program, Path(folder))
        proofs = {'no obstacles, no collision': prove_no_collision(runner, functions), 'sleep': prove_sleep(runner),
                  'no bending': prove_no_bending(runner), 'no ledger': prove_no_ledger(runner),
                  'no deforming': prove_no_deforming(runner), 'standing body': prove_standing_body(runner), 'measuring': prove_measuring(runner)}
    for name, good in proofs.items():
        print(f'{name}: {"proven" if good else "FAILED"}')
    return 0 if all(proofs.values()) else 1


if __name__ == '__main__':
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
