#!/usr/bin/env python3
"""Plants faults in a copy of HEAD and runs the stage of check.sh that has to find them: .ci/plant_faults.py [FAULT...];
--check only says whether the text that each fault changes is there.

A fault is one change of one file. Its stage runs twice: as the project is, where it has to pass, and with the fault, where it has to
fail, with the text that it is known by in what it prints; --passed leaves out the first, for a commit of which all stages are known to pass.
Faults of one stage that do not hide each other are planted together. The copy lies in build/ci-faults and is kept; with ccache a
fault costs what it changes. Prints a table; exit code 1 if a fault was not found or a stage fails without one. Hours for all of them.
"""
import argparse
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COPY = ROOT / 'build' / 'ci-faults'
RELEASE_COPY = COPY / 'build' / 'ci-release' / 'a path with a space'
TAKES_RELEASE = ('consumer', 'perf')  # stages that take the build of the stage release


@dataclass
class Fault:
    name: str
    stage: str
    path: str
    old: str
    new: str
    shows: str  # a text that the failing stage prints
    ends: bool = True  # the stage stops at this fault


FAULTS = [
    Fault('layer violation', 'layers', 'engine/mesh/vertex_normals.cpp',
          '#include "vertex_normals.h"\n', '#include "vertex_normals.h"\n\n#include "solve/newton.h"\n', 'engine/mesh/vertex_normals.cpp'),
    Fault('missing include', 'alone', 'collision/geometry/time_of_impact.cpp',
          '#include "geometry/triangle_distance.h"\n', '', 'time_of_impact.cpp'),
    # Before those that break the build which they take.
    Fault('slow step', 'perf', 'engine/forces/total_force.cpp',
          'if (term->acts(input)) forces.potential', 'if (Forces copy = forces; term->acts(input)) forces.potential', 'dearer'),
    Fault('broken consumer', 'consumer', 'engine/cmake/percale_config.cmake.in',
          '/percale-${_percale_component}.cmake', '/percale_${_percale_component}.cmake', 'percale_engine.cmake'),
    Fault('broken consumer of the engine alone', 'engine_only', 'engine/cmake/percale_config.cmake.in', '  find_dependency(Eigen3 3.4)\n', '',
          'Eigen'),  # which FCL's own package finds for the others
    Fault('broken README line', 'release', 'README.md',
          'poncho_on_mannequin.toml -o build/poncho --report', 'poncho_on_mannequin.toml -o build/poncho --reports',
          "no such option '--reports'"),
    Fault('wrong message', 'release', 'scenes/meshes/off_file.cpp',
          '"no vertices: the file is empty"', '"no vertexes: the file is empty"', 'scenes: off_file_test (Failed)', ends=False),
    Fault('crossing', 'release', 'collision/obstacle/obstacle_surface.cpp',
          'return (sides == FaceSides::outward && fold.height', 'return (fold.height', 'collision: left_out_contacts_test (Failed)', ends=False),
    Fault('broken scene', 'release', 'data/scenes/hang.toml',
          'largest_strain = { below = 0.12 }', 'largest_strain = { below = 0.0012 }', 'scene: hang (Failed)',
          ends=False),
    Fault('overflow in the engine', 'sanitizers', 'engine/mesh/vertex_normals.cpp',
          'std::size_t i = 0; i < normals.size(); ++i', 'std::size_t i = 0; i <= normals.size(); ++i', 'AddressSanitizer'),
    Fault('overflow in a reader of files', 'fuzz', 'scenes/meshes/off_file.cpp',
          'static_cast<std::size_t>(index) >= vertex_count)', 'static_cast<std::size_t>(index) > vertex_count)', 'AddressSanitizer'),
    Fault('overflow in a picture', 'sanitizers_night', 'scenes/picture/surfaces.cpp',
          'around(mesh.vertices.size());', 'around(mesh.vertices.size() - 1);', 'AddressSanitizer'),
    Fault('data race', 'races', 'collision/lists/candidate_lists.cpp',
          '        double max = 0.0;\n        for (std::size_t i = first; i < last; ++i) {\n            const Vec3 gone',
          '        static double max = 0.0;\n        for (std::size_t i = first; i < last; ++i) {\n            const Vec3 gone', 'data race'),
]


def run(command):
    """(exit code, output, seconds) of a command in the copy."""
    started = time.monotonic()
    done = subprocess.run(command, cwd=COPY, text=True, errors='replace', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout, time.monotonic() - started


def make_copy():
    """HEAD in COPY, without what was planted before."""
    if not COPY.exists():
        subprocess.run(['git', 'clone', '--quiet', ROOT, COPY], check=True)
    for command in (['fetch', '--quiet', 'origin', 'HEAD'], ['reset', '--quiet', '--hard', 'FETCH_HEAD']):
        subprocess.run(['git', '-C', COPY, *command], check=True)


def passes(stage, known):
    """Whether a stage passes without a fault; `known` of those that ran before. What it takes runs before it."""
    for needed in [*(['release'] if stage in TAKES_RELEASE else []), stage]:
        if needed not in known:
            code, output, seconds = run(['.ci/check.sh', needed])
            known[needed] = code == 0
            print(f'{needed} without a fault: {"passed" if code == 0 else "FAILED"} in {seconds:.0f} s', file=sys.stderr, flush=True)
            if code != 0:
                print(output[-3000:], file=sys.stderr)
    return known[stage]


def write(fault, text):
    """Where the stage takes the build of another one, that is made anew."""
    (COPY / fault.path).write_text(text)
    if fault.stage in TAKES_RELEASE:
        (RELEASE_COPY / fault.path).write_text(text)
        code, output, _ = run(['cmake', '--build', str(RELEASE_COPY / 'build'), '--target', 'percale'])
        if code != 0:
            sys.exit(f'plant_faults: {fault.name} does not compile\n{output[-3000:]}')


def text_of(fault):
    text = (COPY / fault.path).read_text()
    if text.count(fault.old) != 1:
        sys.exit(f'plant_faults: {fault.path} holds what {fault.name} changes {text.count(fault.old)} times')
    return text


def find(faults):
    """(which of these faults of one stage and of as many files it finds, its output, seconds)."""
    texts = [text_of(fault) for fault in faults]
    for fault, text in zip(faults, texts):
        write(fault, text.replace(fault.old, fault.new))
    try:
        code, output, seconds = run(['.ci/check.sh', faults[0].stage])
    finally:
        for fault, text in zip(faults, texts):
            write(fault, text)
    return [code != 0 and fault.shows in output for fault in faults], output, seconds


def together(faults):
    """In their order, those of one stage that do not end it at once."""
    groups = []
    for fault in faults:
        last = groups[-1] if groups else []
        if last and not fault.ends and not last[0].ends and fault.stage == last[0].stage:
            last.append(fault)
        else:
            groups.append([fault])
    return groups


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('faults', nargs='*', metavar='FAULT', help='their names (default: all)')
    parser.add_argument('--check', action='store_true', help='run nothing')
    parser.add_argument('--passed', action='store_true', help='without a fault all stages are known to pass')
    wish = parser.parse_args()
    if wish.check:
        gone = [fault.name for fault in FAULTS if not (ROOT / fault.path).is_file() or (ROOT / fault.path).read_text().count(fault.old) != 1]
        print(f'plant_faults: {len(FAULTS)} faults' + (f'; their text is not there, or more than once: {", ".join(gone)}' if gone else ''))
        return 1 if gone else 0
    unknown = set(wish.faults) - {fault.name for fault in FAULTS}
    if unknown:
        parser.error(f'no fault {", ".join(sorted(unknown))} ({", ".join(fault.name for fault in FAULTS)})')
    make_copy()
    known, lost = dict.fromkeys((fault.stage for fault in FAULTS), True) if wish.passed else {}, 0
    if not (RELEASE_COPY / 'build' / 'Testing' / 'Temporary' / 'LastTest.log').exists():  # stages take the whole build
        known.pop('release', None)
    print('| fault | in | stage | found | s |\n|---|---|---|---|---|', flush=True)
    for faults in together([fault for fault in FAULTS if not wish.faults or fault.name in wish.faults]):
        clean = passes(faults[0].stage, known)
        seen, output, seconds = find(faults) if clean else ([False] * len(faults), '', 0.0)
        for fault, found in zip(faults, seen):
            print(f'| {fault.name} | `{fault.path}` | `{fault.stage}` | {"yes" if found else "NO"} | {seconds:.0f} |', flush=True)
        lost += seen.count(False)
        if clean and not all(seen):
            print(output[-3000:], file=sys.stderr)
    return 1 if lost else 0


if __name__ == '__main__':
    sys.exit(main())
