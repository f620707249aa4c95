#!/usr/bin/env python3
"""Fails where a change makes a step dearer: .ci/perf_gate.py --program FILE [--store], or .ci/perf_gate.py [--base REF].

Counts, with callgrind, the instructions that a program spends in time steps of small scenes; they do not depend on what
else the machine does. With --program the counts are compared with .ci/instructions.json, which needs no history and no
second build; --store writes that file anew, which a commit does that makes steps dearer on purpose or cheaper. Kernels and
the C library's functions are held to the instructions that every machine of 64 bits has. Counts of another compiler or
C library are another matter: they are printed, not compared.
With --base the program of REF and of the working tree are built side by side; a scene above the limit passes only if
.github/CHANGELOG.md has a line with the scene's name under a heading "Performance" that REF does not have.
Exit code 0: passed, 1: a scene is dearer, 2: could not be measured. Needs valgrind, with --base git, cmake and a compiler.
"""
import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

STORED = '.ci/instructions.json'
CHANGELOG = '.github/CHANGELOG.md'
COUNTED = 'percale::Simulation::step()'  # the rest of the program reads files and writes reports

FABRIC = '''
[fabric.sheet]
area_density   = 0.2
thickness      = 0.005
springs        = { structural = 1000.0, shear = 500.0, bend = 10.0 }
spring_damping = 0.1

[output]
frames = "none"
fps    = 0.01
'''


def cloth(name, height, pins='[]', vertices=21):
    return (f'[[cloth]]\nname = "{name}"\nfabric = "sheet"\ngrid = {{ size = [1.0, 1.0], vertices = [{vertices}, {vertices}] }}\n'
            f'pose = {{ translation = [0.0, {height}, 0.0] }}\npin = {pins}\n')


BALL = '[[obstacle]]\nname = "ball"\nfriction = 0.3\nshape = { sphere = { radius = 0.25 } }\n'
CORNERS = '[0, 20]'

# At most 30 steps each. Both builds run these texts, so they keep to keys that do not change.
SCENES = {
    'hang': 'duration = 0.4\n' + FABRIC + cloth('sheet', 0.0, CORNERS),
    'hang_rk4': 'duration = 0.015\n[step]\nscheme = "rk4"\ntime_step = 0.0005\n' + FABRIC + cloth('sheet', 0.0, CORNERS),
    'sphere': 'duration = 0.4\n' + FABRIC + cloth('sheet', 0.262) + BALL,
    'no_obstacle': 'duration = 0.4\n' + FABRIC + cloth('sheet', 0.0, CORNERS)
                   + '[[event]]\ntime = 0.2\nunpin = { cloth = "sheet", vertices = [0] }\n',
    'moving_obstacle': 'duration = 0.3\n' + FABRIC + cloth('sheet', 0.262, CORNERS) + BALL
                       + 'motion = [{ time = 0.0, translation = [0.0, 0.0, 0.0] }, { time = 0.3, translation = [0.0, 0.15, 0.0] }]\n',
    'two_cloths': 'duration = 0.25\n' + FABRIC + cloth('near', 0.262, vertices=17) + cloth('far', 1.0, '[0, 16]', vertices=17) + BALL,
}


# What the counted program runs with: a count must not depend on the processor.
EVERY_MACHINE = {'PERCALE_INSTRUCTIONS': 'baseline', 'GLIBC_TUNABLES': 'glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-ERMS,-FSRM'}


class CannotMeasure(Exception):
    pass


@dataclass
class Verdict:
    scene: str
    base: int    # instructions; None where the base cannot run the scene
    head: int
    word: str    # ok, dearer, allowed, new

    @property
    def ratio(self):
        return None if self.base is None else self.head / self.base


def performance_lines(changelog):
    """The lines under headings called "Performance", of any level, up to the next heading."""
    lines, inside = set(), False
    for line in changelog.splitlines():
        heading = re.match(r'#+\s*(.*?)\s*#*$', line)
        if heading:
            inside = heading.group(1).lower() == 'performance'
        elif inside and line.strip():
            lines.add(line.strip())
    return lines


def allowed_scenes(base_changelog, head_changelog, scenes):
    """Scenes whose names, as whole words, are in a line about performance that the base does not have."""
    added = performance_lines(head_changelog) - performance_lines(base_changelog)
    return {scene for scene in scenes if any(re.search(rf'(?<!\w){re.escape(scene)}(?!\w)', line) for line in added)}


def judge(base, head, allowed, limit):
    """Verdicts for counts by scene; limit in percent."""
    verdicts = []
    for scene, count in head.items():
        before = base.get(scene)
        if before is None:
            word = 'new'
        elif count * 100 <= before * (100 + limit):
            word = 'ok'
        else:
            word = 'allowed' if scene in allowed else 'dearer'
        verdicts.append(Verdict(scene, before, count, word))
    return verdicts


def table(verdicts):
    lines = [f'{"scene":<16} {"base":>15} {"head":>15} {"ratio":>7}']
    for v in verdicts:
        base, ratio = ('-', '-') if v.base is None else (f'{v.base:,}', f'{v.ratio:.4f}')
        lines.append(f'{v.scene:<16} {base:>15} {v.head:>15,} {ratio:>7}  {v.word}')
    return '\n'.join(lines)


def counted_instructions(callgrind_output):
    """The total of a callgrind output file."""
    total = re.search(r'^(?:totals|summary): (\d+)', callgrind_output, re.M)
    if total is None or int(total.group(1)) == 0:
        raise CannotMeasure(f'callgrind counted nothing in {COUNTED}')
    return int(total.group(1))


def run(command, **more):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **more)
    if done.returncode != 0:
        raise CannotMeasure(f'{" ".join(map(str, command))} ended with {done.returncode}:\n{done.stdout[-3000:]}')
    return done.stdout


def git(root, *arguments):
    return run(['git', '-c', 'safe.directory=*', '-C', root, *arguments]).strip()


def default_base(root):
    """origin/main, or the commit before this one where that is not there or is this one."""
    try:
        main = git(root, 'rev-parse', '--verify', '--quiet', 'origin/main^{commit}')
    except CannotMeasure:
        main = None
    return main if main and main != git(root, 'rev-parse', 'HEAD') else 'HEAD~1'


def build(source, folder, jobs):
    """The program of a checkout."""
    options = ['-DCMAKE_BUILD_TYPE=Release', '-DPERCALE_TESTS=OFF']
    if shutil.which('ninja'):
        options += ['-G', 'Ninja']
    if shutil.which('ccache'):
        options += ['-DCMAKE_CXX_COMPILER_LAUNCHER=ccache']
    environment = {**os.environ, 'CCACHE_BASEDIR': '/', 'CCACHE_NOHASHDIR': '1'}  # other folders each time, same files
    run(['cmake', '-S', source, '-B', folder, *options], env=environment)
    run(['cmake', '--build', folder, '--target', 'percale', '-j', str(jobs)], env=environment)
    return folder / 'percale'


def count(program, scene_file, folder):
    """Instructions of all steps of one scene."""
    counts = folder / 'callgrind.out'
    counts.unlink(missing_ok=True)
    run(['valgrind', '--tool=callgrind', f'--callgrind-out-file={counts}', f'--toggle-collect={COUNTED}', program, 'run', scene_file,
         '-o', folder / 'run', '--quiet', '--threads', '1'], env={**os.environ, **EVERY_MACHINE})
    return counted_instructions(counts.read_text())


def count_all(program, folder, may_fail):
    """Counts by scene; with `may_fail`, a scene that this program cannot run is left out."""
    folder.mkdir()
    counts = {}
    for name, text in SCENES.items():
        scene_file = folder / f'{name}.toml'
        scene_file.write_text(text)
        try:
            counts[name] = count(program, scene_file, folder)
        except CannotMeasure as error:
            if not may_fail:
                raise
            print(f'the base cannot run {name}: {error}', file=sys.stderr)
    return counts


def changelog_of(root, ref):
    """The base's changelog; empty where it has none."""
    names = git(root, 'ls-tree', '--name-only', ref, CHANGELOG)
    return git(root, 'show', f'{ref}:{CHANGELOG}') if names else ''


def measure(root, ref, jobs, scratch):
    """Counts by scene of the base and of the working tree."""
    source = scratch / 'base-source'
    git(root, 'worktree', 'add', '--detach', source, ref)
    try:
        programs = build(source, scratch / 'base', jobs), build(root, scratch / 'head', jobs)
        return count_all(programs[0], scratch / 'base-runs', True), count_all(programs[1], scratch / 'head-runs', False)
    finally:
        git(root, 'worktree', 'remove', '--force', source)


def gate(root, options, scratch):
    ref = git(root, 'rev-parse', '--verify', (options.base or default_base(root)) + '^{commit}')
    base, head = measure(root, ref, options.jobs, scratch)
    if not base:
        raise CannotMeasure('the base can run none of the scenes')
    allowed = allowed_scenes(changelog_of(root, ref), (root / CHANGELOG).read_text(), SCENES)
    verdicts = judge(base, head, allowed, options.limit)
    print(f'instructions in {COUNTED}, base {ref[:12]}\n{table(verdicts)}')
    if options.json:
        rows = [{'scene': v.scene, 'base': v.base, 'head': v.head, 'ratio': v.ratio, 'verdict': v.word} for v in verdicts]
        Path(options.json).write_text(json.dumps({'base': ref, 'limit_percent': options.limit, 'scenes': rows}, indent=2) + '\n')
    dearer = [v.scene for v in verdicts if v.word == 'dearer']
    if dearer:
        print(f'perf_gate: dearer by more than {options.limit:g} %: {", ".join(dearer)}. If that is meant, say why under a heading '
              f'"Performance" of {CHANGELOG}, one line with the name of each scene.')
    return 1 if dearer else 0


def toolchain(program):
    """What else than the source the counts depend on: compiler and C library of this program."""
    found = re.search(rb'(?:GCC: \([^)]*\)|clang version) [0-9.]+', program.read_bytes())
    compiler = re.sub(r' \([^)]*\)', '', found.group().decode()) if found else 'an unknown compiler'
    return f'{compiler}, {" ".join(platform.libc_ver())}, {platform.machine()}'


def judge_stored(stored, tools, counts, limit):
    """(verdicts, whether they count): scenes of another compiler are not comparable."""
    comparable = stored['toolchain'] == tools
    return judge(stored['scenes'] if comparable else {}, counts, set(), limit), comparable


def compare_stored(root, options, scratch):
    program = Path(options.program).resolve()
    if not program.is_file():
        raise CannotMeasure(f'{options.program}: no such program')
    counts, tools = count_all(program, scratch / 'runs', False), toolchain(program)
    if options.store:
        (root / STORED).write_text(json.dumps({'toolchain': tools, 'scenes': counts}, indent=2) + '\n')
        print(f'{STORED} holds the counts of this program ({tools})')
        return 0
    stored = json.loads((root / STORED).read_text())
    verdicts, comparable = judge_stored(stored, tools, counts, options.limit)
    print(f'instructions in {COUNTED}, base {STORED}\n{table(verdicts)}')
    if not comparable:
        print(f'perf_gate: not compared: counts are stored for {stored["toolchain"]}, this is {tools}')
    cheaper = [v.scene for v in verdicts if v.base and v.head * 100 < v.base * (100 - options.limit)]
    if cheaper:
        print(f'perf_gate: cheaper by more than {options.limit:g} %: {", ".join(cheaper)}; keep that: --store')
    dearer = [v.scene for v in verdicts if v.word == 'dearer']
    if dearer:
        print(f'perf_gate: dearer by more than {options.limit:g} %: {", ".join(dearer)}. If that is meant, store the counts '
              f'(--store) and say why in the commit.')
    return 1 if dearer else 0


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--base', help='git ref to compare with (default: origin/main, or HEAD~1)')
    parser.add_argument('--program', help=f'a built program, whose counts are compared with {STORED}')
    parser.add_argument('--store', action='store_true', help=f'with --program: write {STORED}')
    parser.add_argument('--limit', type=float, default=1.0, help='percent that a scene may become dearer (default 1)')
    parser.add_argument('--jobs', type=int, default=2, help='parallel compilations (default 2)')
    parser.add_argument('--json', help='also write the table to this file')
    options = parser.parse_args(arguments)
    root = Path(__file__).resolve().parent.parent
    try:
        with tempfile.TemporaryDirectory(prefix='percale-perf-') as scratch:
            return (compare_stored if options.program else gate)(root, options, Path(scratch))
    except (CannotMeasure, OSError) as error:
        print(f'perf_gate: {error}', file=sys.stderr)
        return 2


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
