#!/usr/bin/env python3
"""Prints, each ended by a 0 byte, the commands that read a source alone: .ci/read_alone.py ROOT BUILD.

They are those of BUILD's compile_commands.json for collision/, scenes/ and tests/bench/, without output. Half of their time would go
into Eigen, so it is precompiled here, by the flags of the command. A source that includes Eigen by none of its headers goes without:
else nobody would notice that it lacks a header which Eigen happens to include.
"""
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path


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
    root, build = (Path(argument).resolve() for argument in sys.argv[1:])
    made, known = {}, {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        source = Path(entry['file'])
        if not re.match(re.escape(str(root)) + '/(collision|scenes|tests/bench)/', str(source)):
            continue
        words = shlex.split(entry['command'])
        folders = [Path(word[2:]) for word in words if re.match('-I.', word)]
        eigen = ['-include-pch', precompiled(words, build, made)] if includes_eigen(source.resolve(), folders, known) else []
        output = words.index('-o')
        words = [words[0], *eigen, *words[1:output], '-fsyntax-only', *words[output + 2:]]
        print('cd ' + shlex.quote(entry['directory']) + ' && ' + shlex.join(words), end='\0')


if __name__ == '__main__':
    main()
