#!/usr/bin/env python3
"""What the shipped scenes cost with two programs: scene_costs.py BEFORE AFTER [--scenes GLOB...] [--options KEY=VALUE...] [-o FILE]

Each scene of data/scenes is run with both programs in turns, on one thread and without frames. Prints a table: least user CPU time of
--repeats runs, Newton iterations, linear iterations as a ratio, whether all state and contact hashes are the same, and what else
differs: the end, the exit code. Closing lines give sums and geometric means of ratios. Exit code 1 where AFTER cannot run a scene.
Standard library only.
"""
import argparse
import csv
import os
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from state_hashes import SCENES, hashes_of, iterations_of, run_command

SHORT = 0.2  # s, the ratio of CPU times is noise in scenes that take less with BEFORE
HEAD = ('| scene | CPU s before | after | ratio | Newton before | after | ratio | linear ratio | same bits? | else |\n' + '|---' * 10 + '|')


@dataclass
class Cost:
    """Of one scene with one program; only `failure` where it did not run."""
    failure: str = ''
    cpu: float = 0.0  # s
    newton: int = 0
    linear: int = 0
    end: float = 0.0  # s
    code: int = 0
    hashes: str = ''


def last_line(file):
    file.seek(0)
    return (file.read().decode(errors='replace').strip().splitlines() or ['no message'])[-1].replace('|', '/')


def measure(program, scene, settings):
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as error:
        command = run_command(program, scene, settings, ['--threads', '1'], folder)
        try:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=error)
        except OSError as reason:
            return Cost(failure=reason.strerror)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        steps = Path(folder) / 'steps.csv'
        rows = list(csv.DictReader(steps.read_text().splitlines())) if steps.exists() else []
        if not rows:
            return Cost(failure=f'exit code {process.returncode}: {last_line(error)}')
        newton, linear = iterations_of(rows)
        return Cost(cpu=usage.ru_utime, newton=newton, linear=linear, end=float(rows[-1]['time']), code=process.returncode,
                    hashes=hashes_of(Path(folder))[-1])


def least(costs):
    """The cheapest of the runs, which differ in nothing else; one that failed counts for all."""
    return next((cost for cost in costs if cost.failure), min(costs, key=lambda cost: cost.cpu))


def compare(programs, scene, settings, repeats):
    turns = [[measure(program, scene, settings) for program in programs] for _ in range(repeats)]
    return [least(costs) for costs in zip(*turns)]


def ratio_text(after, before, digits=3):
    return f'{after / before:.{digits}f}' if before else ''


def row_of(name, before, after):
    for word, cost in (('before', before), ('after', after)):
        if cost.failure:
            return f'| {name} | cannot be run by the program {word}: {cost.failure} |' + ' |' * 8
    others = [f'{what} {old:g}, then {new:g}' for what, old, new in (('ends at', before.end, after.end), ('exit code', before.code, after.code))
              if old != new]
    return (f'| {name} | {before.cpu:.2f} | {after.cpu:.2f} | {ratio_text(after.cpu, before.cpu, 2)} | {before.newton} | {after.newton} | '
            f'{ratio_text(after.newton, before.newton)} | {ratio_text(after.linear, before.linear)} | '
            f'{"yes" if after.hashes == before.hashes else "no"} | {"; ".join(others)} |')


def summary(pairs):
    """Closing lines over the scenes that both programs ran; pairs: name, cost before and after."""
    whole = [pair for pair in pairs if not pair[1].failure and not pair[2].failure]
    long = [(after.cpu / before.cpu, name) for name, before, after in whole if before.cpu > SHORT]
    same = sum(before.hashes == after.hashes for _, before, after in whole)
    newton = [after.newton / before.newton for _, before, after in whole if before.newton and after.newton]
    lines = [f'{len(pairs)} scenes, {len(pairs) - len(whole)} of them not run by both programs; the same bits in {same}.']
    if whole:
        lines.append(f'CPU s of all: {sum(before.cpu for _, before, _ in whole):.2f} before, {sum(after.cpu for _, _, after in whole):.2f} after.')
    if newton:
        lines.append(f'Geometric mean of the ratios of Newton iterations: {statistics.geometric_mean(newton):.3f}.')
    if long:
        (best, best_name), (worst, worst_name) = min(long), max(long)
        mean = statistics.geometric_mean([one for one, _ in long])
        lines += [f'Geometric mean of the ratios of CPU times, scenes above {SHORT:g} s ({len(long)}): {mean:.3f}.',
                  f'Worst: {worst_name}, {worst:.2f} times the CPU time; best: {best_name}, {best:.2f} times.']
    return '\n\n'.join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('before', type=lambda text: Path(text).resolve())
    parser.add_argument('after', type=lambda text: Path(text).resolve())
    parser.add_argument('--scenes', nargs='+', default=['*'], metavar='GLOB', help='names of scenes (default: all)')
    parser.add_argument('--options', nargs='+', default=[], metavar='KEY=VALUE', help='keys of scenes that are set, with both programs')
    parser.add_argument('--repeats', type=int, default=1)
    parser.add_argument('--jobs', type=int, default=1, help='scenes at a time')
    parser.add_argument('-o', dest='table', help='also write the table to this file')
    wish = parser.parse_args()
    scenes = sorted({file for pattern in wish.scenes for file in SCENES.glob(f'{pattern}.toml')})
    if not scenes or wish.repeats < 1:
        parser.error('no scenes, or no runs')
    print(HEAD)
    pairs, lines = [], [HEAD]
    with ThreadPoolExecutor(wish.jobs) as pool:
        for scene, costs in zip(scenes, pool.map(lambda file: compare((wish.before, wish.after), file, wish.options, wish.repeats), scenes)):
            pairs.append((scene.stem, *costs))
            lines.append(row_of(*pairs[-1]))
            print(lines[-1], flush=True)
    print('\n' + summary(pairs))
    if wish.table:
        command = ' '.join(['tests/validation/scene_costs.py', *sys.argv[1:]])
        Path(wish.table).write_text(f'Written by `{command}`.\n\n' + '\n'.join(lines) + f'\n\n{summary(pairs)}\n')
    return 1 if any(after.failure for _, _, after in pairs) else 0


if __name__ == '__main__':
    sys.exit(main())
