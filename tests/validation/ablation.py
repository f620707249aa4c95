#!/usr/bin/env python3
"""Which named constants earn their place: ablation.py FOLDER [NAME...]

In FOLDER, a copy of HEAD, every constant `constexpr TYPE name = value` of engine/ and collision/ is read from the environment instead.
The program and the tests are built once; then each constant is halved and doubled (roundings: 0 and a thousandfold), alone. What notices
it is asked in this order, until something does: the test of its own source; tests of its folder and of the folders that use it, those
apart that take long; short scenes (steps.csv, byte by byte, with iterations of Newton's method and of linear solvers beside those as
built). A constant that no test and no scene noticed is tried at 0 and at a millionfold, too: switched off. Prints a table; results are
kept in FOLDER/results.json, and a second call goes on from there. Two hours for all. With --long, constants that nothing noticed are
switched off before the tests that take long, or before those that are named: hours more.
"""
import argparse
import concurrent.futures
import csv
import json
import os
import re
import shutil
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

from state_hashes import iterations_of, run_command

ROOT = Path(__file__).resolve().parents[2]
ROUNDING = 1e-5  # a constant below it is a rounding
JOBS = 2
LIMIT = 60.0  # s of a run of tests or of a scene
LONG = 4.0  # s, a test file that takes longer is asked last
KINDS = 'double|float|int|long|unsigned long|unsigned|std::size_t'
DECLARED = re.compile(rf'^(?:inline )?constexpr ({KINDS}) ([a-z][^;\n(\[{{]*(?:\([^;\n]*)?);', re.M)
# Sizes of arrays, layouts and arguments of templates have to be known to the compiler; and what is no heuristic.
LEFT_ALONE = set('''slice_lanes chunk_slices pack_bytes float_lanes double_lanes corner_values pack_lanes curve_key_bits max_weights
max_candidates max_local_vertices max_terms enclosure_places pair_fetches projection_activation_ratio contact_accuracy flat_fold
ray_rim name_length seal_length no_length_square blown_up_square any_dt unmoved moved_by_cloth any_feature always good_version no_version
no_bound unit_roundoff boundless unreachable infinity no_seam unknown none trapezoid_fraction air_pressure standard_gravity
working_exponent max_halvings constraint_sweeps self_lists_a_part self_lists_a_round clusters_per_clamp vertices_a_part'''.split())
# Short runs of what a step can hold: scene, duration in s, options.
SCENES = [('hang', 0.5, []), ('hang', 0.5, ['step.linear_solver=cg']), ('hang', 0.5, ['step.linear_solver=multigrid']),
          ('swinging_sheet', 0.5, ['step.time_step=auto']), ('swinging_sheet', 0.5, ['step.scheme=tr_bdf2']), ('conveyor', 0.5, []),
          ('incline_slide', 0.5, []), ('tablecloth_pull_8_m_per_s', 1.0, []), ('strip_with_hinges', 1.0, []), ('flag', 0.4, []),
          ('sewn_tube', 2.0, []), ('twisted_strip', 1.0, []), ('ball_10_m_per_s', 0.2, []), ('beach_ball', 0.2, []),
          ('sheet_folding_on_floor', 0.45, []), ('sheet_folding_on_floor', 0.25, ['step.contact_response=projection']),
          ('two_sheets_on_spikes', 0.2, []), ('needles', 0.3, []), ('five_sheets_on_sphere', 0.12, []), ('skirt', 0.3, []),
          ('poncho_walk', 0.3, [])]
HEADER = '''#pragma once
#include <cstdlib>
#include <cstring>
namespace percale::ablation {
template <class T> T read(const char* name, T value) {
    static const char* const set = std::getenv("PERCALE_ABLATION");
    if (set == nullptr) return value;
    const char* const factor = std::strchr(set, '=');
    const std::size_t length = std::strlen(name);
    if (static_cast<std::size_t>(factor - set) != length || std::strncmp(set, name, length) != 0) return value;
    return static_cast<T>(static_cast<double>(value) * std::atof(factor + 1));
}
}
'''


@dataclass
class Constant:
    name: str  # PATH:NAME
    text: str  # of its value
    factors: tuple = (0.5, 2.0)
    tests: list = field(default_factory=list)  # test files of its own folder and of its users

    @property
    def layer(self):
        return self.name.split('/', 1)[0]


def number(text):
    """The value of a literal, or None."""
    try:
        return float(text.rstrip('fFuUlL'))
    except ValueError:
        return None


def split_declarations(text):
    """name = value pairs of a declaration; commas in brackets divide nothing."""
    parts, depth, last = [], 0, 0
    for i, letter in enumerate(text):
        depth += (letter in '({<') - (letter in ')}>')
        if letter == ',' and depth == 0:
            parts.append(text[last:i])
            last = i + 1
    parts.append(text[last:])
    return [tuple(side.strip() for side in part.split('=', 1)) for part in parts if '=' in part]


def make_readable(path, relative, constants):
    """Rewrites the constants of one source so that they are read from the environment."""
    def rewritten(match):
        kind, declarations = match[1], split_declarations(match[2])
        if not declarations or any(name in LEFT_ALONE for name, _ in declarations):
            return match[0]
        read = []
        for name, value in declarations:
            literal = number(value)
            rounding = literal is not None and literal != 0.0 and abs(literal) <= ROUNDING
            constants.append(Constant(f'{relative}:{name}', value, (0.0, 1e3) if rounding else (0.5, 2.0)))
            read.append(f'{name} = ::percale::ablation::read<{kind}>("{relative}:{name}", {value})')
        return f'static const {kind} ' + ', '.join(read) + ';'
    text = path.read_text()
    changed = DECLARED.sub(rewritten, text)
    if changed != text:
        path.write_text(changed)


def test_files(copy, folders):
    return sorted({file.stem for folder in folders for file in (copy / 'tests' / folder).glob('*_test.cpp')})


def prepare(folder):
    """The copy with constants that can be read, and what they are."""
    copy = folder / 'copy'
    if copy.exists():
        shutil.rmtree(copy)
    subprocess.run(['git', 'clone', '--quiet', '--shared', ROOT, copy], check=True)
    constants = []
    sources = sorted(file for layer in ('engine', 'collision') for end in ('cpp', 'h', 'inl') for file in (copy / layer).rglob(f'*.{end}'))
    for file in sources:
        make_readable(file, str(file.relative_to(copy)), constants)
    (folder / 'ablation.h').write_text(HEADER)
    texts = {str(file.relative_to(copy)): file.read_text() for file in sources}
    for constant in constants:
        path, name = constant.name.rsplit(':', 1)
        users = {path} | {other for other, text in texts.items() if re.search(rf'\b{name}\b', text)}
        constant.tests = test_files(copy, {str(Path(user).parent) for user in users if user.split('/')[0] == constant.layer})
    return constants


def build(folder):
    flags = os.environ.get('CXXFLAGS', '') + f' -include {folder}/ablation.h'
    compiler_cache = ['-DCMAKE_CXX_COMPILER_LAUNCHER=ccache'] if shutil.which('ccache') else []
    subprocess.run(['cmake', '-G', 'Ninja', '-S', folder / 'copy', '-B', folder / 'build', '-DCMAKE_BUILD_TYPE=Release', *compiler_cache,
                    f'-DCMAKE_CXX_FLAGS={flags}'], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(['ninja', '-C', folder / 'build', f'-j{JOBS}', '-k0', 'percale', 'percale_engine_tests', 'percale_collision_tests'],
                   check=True)


def ended(command, change, **options):
    """Exit code and output of a command with one constant changed; None and '' where it did not end in time."""
    environment = dict(os.environ, PERCALE_ABLATION=change) if change else dict(os.environ)
    try:
        done = subprocess.run(command, env=environment, text=True, errors='replace', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False, timeout=LIMIT, **options)
    except subprocess.TimeoutExpired:
        return None, ''
    return done.returncode, done.stdout


def failing_test(folder, layer, files, change):
    """The first test file that fails, or None. Files run one by one: each bounds its own time."""
    for file in files:
        code, _ = ended([folder / 'build' / f'percale_{layer}_tests', '-#', f'[#{file}]~[.]~[fixture]', '--abort'], change)
        if code != 0:
            return file + (' (did not end)' if code is None else '')
    return None


def run_scene(folder, out, scene, change):
    name, duration, options = scene
    shutil.rmtree(out, ignore_errors=True)
    file = folder / 'copy' / 'data' / 'scenes' / f'{name}.toml'
    code, _ = ended(run_command(folder / 'build' / 'percale', file, [f'duration={duration}', *options], ['--threads', '1'], out), change)
    steps = out / 'steps.csv'
    text = steps.read_bytes() if steps.exists() else b''
    return code, text, *iterations_of(csv.DictReader(text.decode().splitlines()))


def judge_scenes(folder, out, change, as_built):
    """How many scenes differ, and iterations of those that ended beside those as built."""
    differ, before, now = 0, [0, 0], [0, 0]
    for scene, built in zip(SCENES, as_built):
        code, text, newton, linear = run_scene(folder, out, scene, change)
        differ += text != built[1]
        if code is not None:
            before, now = [before[0] + built[2], before[1] + built[3]], [now[0] + newton, now[1] + linear]
    shutil.rmtree(out, ignore_errors=True)
    return {'differ': differ, 'newton': now[0] / max(before[0], 1), 'linear': now[1] / max(before[1], 1)}


def all_test_files(folder, layer):
    tests = folder / 'copy' / 'tests'
    return sorted({file.stem for top in (layer, 'properties') for file in (tests / top).rglob('*_test.cpp')})


def examine(folder, constant, built, worker):
    """What noticed a constant: for each factor the test that fails, or what its scenes show."""
    scenes, seconds = built
    own = Path(constant.name.rsplit(':', 1)[0]).stem + '_test'
    files = [file for file in sorted(constant.tests, key=lambda file: (file != own, seconds[constant.layer].get(file, LONG)))
             if seconds[constant.layer].get(file, LONG) < LONG]
    found = {}
    factors = list(constant.factors)
    for factor in factors:
        change = f'{constant.name}={factor:g}'
        test = failing_test(folder, constant.layer, files, change)
        found[f'{factor:g}'] = {'test': test} if test else judge_scenes(folder, folder / f'out_{worker}', change, scenes)
        if test:
            break
        if factor == constant.factors[-1] and not any(r.get('test') or r.get('differ') for r in found.values()):
            factors += [other for other in (0.0, 1e6) if other not in factors]
    return found


def unnoticed(results):
    """The constants that no test failed and in whose scenes less than 1 % of the iterations changed."""
    def is_small(r):
        return not r.get('test') and iterations_changed(r) < 0.01
    return [name for name, found in results.items() if all(is_small(r) for r in found.values())]


def ask_long_tests(folder, constant, seconds, files):
    """Which long test fails where the constant is switched off, or None."""
    for factor in (0.0, 1e6):
        for layer, passed in seconds.items():
            asked = [file for file, time_of_file in passed.items() if file in files or (not files and time_of_file >= LONG)]
            test = failing_test(folder, layer, asked, f'{constant.name}={factor:g}')
            if test:
                return f'{factor:g}', test
    return None


def as_built(folder):
    """Scenes as built, and the seconds of each test file that passes as built."""
    kept = folder / 'seconds.json'
    scenes = [run_scene(folder, folder / 'out_built', scene, '') for scene in SCENES]
    for scene, result in zip(SCENES, scenes):
        if result[0] not in (0, 1):
            raise SystemExit(f'{scene[0]} does not run as built')
    if kept.exists():
        return scenes, json.loads(kept.read_text())
    seconds = {layer: {} for layer in ('engine', 'collision')}
    for layer, passed in seconds.items():
        for file in all_test_files(folder, layer):
            start = time.monotonic()
            if not failing_test(folder, layer, [file], ''):
                passed[file] = time.monotonic() - start
    kept.write_text(json.dumps(seconds))
    return scenes, seconds


def iterations_changed(r):
    return max(abs(r['newton'] - 1), abs(r['linear'] - 1))


def what_noticed(found):
    """Kind, changes and words of what noticed a constant."""
    for factor, r in found.items():
        if r.get('test'):
            return 'a test', factor, r['test']
    factor, r = max(found.items(), key=lambda item: (iterations_changed(item[1]), item[1]['differ']))
    if iterations_changed(r) >= 0.01:
        return 'iterations', factor, f'{r["newton"] - 1:+.1%} Newton, {r["linear"] - 1:+.1%} linear iterations'
    if r['differ']:
        return 'bits', factor, f'bits of {r["differ"]} scenes alone'
    return 'nothing', ', x '.join(found), 'nothing'


def table(constants, results):
    """Prints how many constants what noticed, and each of them."""
    rows = [(constant, *what_noticed(results[constant.name])) for constant in constants if constant.name in results]
    kinds = ('nothing', 'bits', 'iterations', 'a test')
    print('| noticed by | constants |\n|---|---|')
    for kind in reversed(kinds):
        print(f'| {kind} | {sum(row[1] == kind for row in rows)} |')
    print('\n| constant | value | changed | noticed by |\n|---|---|---|---|')
    for constant, _, factor, words in sorted(rows, key=lambda row: (kinds.index(row[1]), row[0].name)):
        print(f'| `{constant.name}` | {constant.text} | x {factor} | {words} |')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('folder', type=lambda text: Path(text).resolve())
    parser.add_argument('names', nargs='*', help='constants, as PATH:NAME or NAME; all')
    parser.add_argument('--long', nargs='*', metavar='TEST', help='ask long tests, or these, about constants that nothing noticed')
    parser.add_argument('--jobs', type=int, default=JOBS)
    parser.add_argument('--built', action='store_true', help='the copy is there and built')
    arguments = parser.parse_args()
    folder = arguments.folder
    folder.mkdir(parents=True, exist_ok=True)
    known = folder / 'constants.json'
    head = subprocess.run(['git', '-C', ROOT, 'rev-parse', 'HEAD'], check=True, capture_output=True, text=True).stdout.strip()
    commit = folder / 'commit'
    if not arguments.built:
        if (folder / 'results.json').exists() and commit.exists() and commit.read_text() != head:
            parser.error(f'{folder} holds results of {commit.read_text()[:8]}; HEAD is {head[:8]}: take another folder, or --built')
        commit.write_text(head)
        made = prepare(folder)
        known.write_text(json.dumps([vars(constant) for constant in made]))
        build(folder)
    constants = [Constant(**values) for values in json.loads(known.read_text())]
    if arguments.names:
        constants = [c for c in constants if c.name in arguments.names or c.name.rsplit(':', 1)[1] in arguments.names]
    built = as_built(folder)
    kept = folder / 'results.json'
    results = json.loads(kept.read_text()) if kept.exists() else {}
    if arguments.long is not None:
        names = unnoticed(results)
        left = [constant for constant in constants if constant.name in names]
    else:
        left = [constant for constant in constants if constant.name not in results]

    def ask(number, constant):
        if arguments.long is None:
            return examine(folder, constant, built, number)
        noticed = ask_long_tests(folder, constant, built[1], arguments.long)
        found = results[constant.name]
        if noticed:
            found.setdefault(noticed[0], {})['test'] = noticed[1]
        return found
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        workers = {pool.submit(ask, i, constant): constant for i, constant in enumerate(left)}
        for done in concurrent.futures.as_completed(workers):
            results[workers[done].name] = done.result()
            kept.write_text(json.dumps(results, indent=1))
    table(constants, results)


if __name__ == '__main__':
    main()
