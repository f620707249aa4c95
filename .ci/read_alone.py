#!/usr/bin/env python3
"""Prints, each ended by a 0 byte, the commands that read a source alone: .ci/read_alone.py ROOT BUILD [REF].

They are those of BUILD's compile_commands.json for the libraries and tests/bench/, without output; with REF those whose source changed
since that commit, or a file that it includes, by whatever detour, and tests that changed themselves and that no other stage of the day
compiles by this compiler: at most 200, first those that changed; the night reads all. Half of their time would go into Eigen, so it is
precompiled here, by the flags of the command. A source that includes Eigen by none of its headers goes without: else nobody would notice that it lacks a
header which Eigen happens to include.
"""
import json
import re
import shlex
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import layers

READ = ('engine/', 'collision/', 'scenes/', 'data/generators/', 'tests/bench/')
READ_IF_CHANGED = ('tests/scenes/', 'tests/data/', 'tests/validation/')
MOST = 200  # sources of a change. All users of a header that everything includes take as long as half of the other stages


def with_users(changed, includes):
    """Changed files and all that include one of them. `includes`: (line, name, file) of each inclusion, by including file."""
    users = defaultdict(set)
    for path, found in includes.items():
        for _, _, target in found:
            users[target].add(path)
    reached, left = set(), list(changed)
    while left:
        path = left.pop()
        if path not in reached:
            reached.add(path)
            left += users[path]
    return reached


def chosen_sources(root, base):
    """Relative paths of the sources to read: all, or what a change since `base` asks for."""
    tree = layers.read_tree(root)
    if not base:
        return {path for path in tree.files if path.startswith(READ)}
    changed = layers.changed_files(root, base)
    users = with_users(changed, tree.includes)
    return at_most(users, changed, MOST)


def at_most(users, changed, most):
    """So many of the sources to read: those that changed, then users of what changed."""
    read = {path for path in users if path.startswith(READ)} | {path for path in changed if path.startswith(READ_IF_CHANGED)}
    read = {path for path in read if path.endswith('.cpp')}  # only these are compiled
    if len(read) > most:
        print(f'read_alone: {most} of {len(read)} sources; the night reads the rest', file=sys.stderr)
    return evenly(read & set(changed), most) | evenly(read - set(changed), most - len(read & set(changed)))


def evenly(paths, most):
    """At most so many of the paths, evenly spaced in their order."""
    ordered, most = sorted(paths), max(0, most)
    return set(ordered) if len(ordered) <= most else {ordered[k * len(ordered) // most] for k in range(most)}


def includes_eigen(source, folders, known):
    """Whether a file includes Eigen, through files that lie beside it or in one of the folders. `known`: of files asked for before."""
    if source not in known:
        known[source] = False
        for name in re.findall(r'^ *# *include *[<"]([^>"]+)[>"]', source.read_text(errors='replace'), re.M):
            places = [folder / name for folder in (source.parent, *folders) if (folder / name).is_file()]
            if name.startswith('Eigen/') or (places and includes_eigen(places[0].resolve(), folders, known)):
                known[source] = True
                break
    return known[source]


def precompiled(words, build, made):
    """The file of Eigen's two headers as this command would read them."""
    system = [folder for flag, folder in zip(words, words[1:]) if flag == '-isystem']
    flags = (*(word for word in words[1:] if re.match('-[Ofmsg]', word)), *(part for folder in system for part in ('-isystem', folder)))
    if flags not in made:
        made[flags] = str(build / f'eigen-{len(made)}.pch')
        subprocess.run([words[0], *flags, '-x', 'c++-header', '-', '-o', made[flags]], text=True, check=True,
                       input='#include <Eigen/Core>\n#include <Eigen/Geometry>\n')
    return made[flags]


def main():
    root, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    chosen = chosen_sources(root, sys.argv[3] if len(sys.argv) > 3 else '')
    made, known = {}, {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        source = Path(entry['file'])
        path = str(source.relative_to(root)) if source.is_relative_to(root) else ''
        if path not in chosen:
            continue
        words = shlex.split(entry['command'])
        folders = [Path(word[2:]) for word in words if re.match('-I.', word)]
        eigen = ['-include-pch', precompiled(words, build, made)] if includes_eigen(source.resolve(), folders, known) else []
        output = words.index('-o')
        words = [words[0], *eigen, *words[1:output], '-fsyntax-only', *words[output + 2:]]
        print('cd ' + shlex.quote(entry['directory']) + ' && ' + shlex.join(words), end='\0')


if __name__ == '__main__':
    main()
