#!/usr/bin/env python3
"""Puts odd and broken meshes through the program: odd_meshes.py PERCALE FOLDER [NAME...] [-o FILE]

FOLDER holds them, as .ci/fetch_meshes.sh leaves them; without it nothing is tested (exit code 77). Each file goes through `doctor`, and
through `run` as cloth over a ball and as obstacle under a sheet. Allowed is an answer: exit code 0, 1 or 2, and one line on the standard
error where run refuses. Not allowed are a crash, an internal error, more than SECONDS of CPU time, or more memory than BASE_MB and
MULTIPLE times the file (address space, and measured peak). A mesh that doctor finds no error in must not be refused by run.
NAMEs pick files by part of their path. Prints a table by format and with -o also writes it as a file; exit code 1 if anything was not
allowed.
"""
import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

SKIPPED = 77
SECONDS = 20  # what takes longest alone takes 5 s; beside other work CPU time grows
BASE_MB, MULTIPLE = 256, 256
STEPS = 3

SHEET = '''
[fabric.sheet]
area_density = 0.2
springs = {{ structural = 100.0, bend = 0.0 }}
[step]
time_step = 0.01
[output]
frames = "none"
fps = 1.0
'''

CLOTH = SHEET + '''
[[cloth]]
name = "odd"
fabric = "sheet"
mesh = {file}
[[obstacle]]
name = "ball"
shape = {{ sphere = {{ radius = 0.3 }} }}
pose = {{ translation = [0.0, -0.4, 0.0] }}
'''

OBSTACLE = SHEET + '''
[[cloth]]
name = "sheet"
fabric = "sheet"
grid = {{ size = [1.0, 1.0], vertices = [17, 17] }}
pose = {{ translation = [0.0, 0.2, 0.0] }}
[[obstacle]]
name = "odd"
mesh = {file}
'''


def limit(size):
    def apply():
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS + 1, SECONDS + 2))
        bytes_ = (BASE_MB << 20) + MULTIPLE * size
        resource.setrlimit(resource.RLIMIT_AS, (bytes_, bytes_))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return apply


class Answer:
    """What one call of the program did."""

    def __init__(self, arguments, size):
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as error:
            process = subprocess.Popen(arguments, stdout=out, stderr=error, stdin=subprocess.DEVNULL, preexec_fn=limit(size))
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0), error.seek(0)
            self.out, self.error = out.read().decode(errors='replace'), error.read().decode(errors='replace')
        self.code = process.returncode
        self.seconds = usage.ru_utime + usage.ru_stime
        self.peak = usage.ru_maxrss * 1024

    def complaint(self):
        if self.code not in (0, 1, 2):
            return f'exit code {self.code}: {self.error.strip()[-200:]}'
        if self.seconds > SECONDS:
            return f'{self.seconds:.1f} s'
        if len(self.error.strip().splitlines()) > 1:
            return f'more than one line of error: {self.error[:300]!r}'
        return ''


def errors_of(answer, role):
    """The errors that doctor found for a role, or for both."""
    try:
        findings = json.loads(answer.out)['files'][0]['findings']
    except (ValueError, LookupError):
        return 0
    return sum(finding['severity'] == 'error' and finding['as'] in (role, None) for finding in findings)


def run_as(program, role, file, size, folder):
    scene = folder / f'{role}.toml'
    text = (CLOTH if role == 'cloth' else OBSTACLE).format(file=json.dumps(str(file)))
    scene.write_text(f'duration = {0.01 * STEPS}\n' + text)
    return Answer([program, 'run', str(scene), '-o', str(folder / role), '--quiet'], size)


def size_of(file):
    """Bytes of a file, with the buffers beside a glTF file, which belong to it."""
    beside = file.parent.glob('*.bin') if file.suffix.lower() == '.gltf' else ()
    return file.stat().st_size + sum(buffer.stat().st_size for buffer in beside)


def examine(program, file, folder):
    """All answers to one file, and complaints."""
    size = size_of(file)
    answers = {'doctor': Answer([program, 'doctor', str(file), '--json'], size)}
    for role in ('cloth', 'obstacle'):
        answers[role] = run_as(program, role, file, size, folder)
    complaints = [f'{what}: {answer.complaint()}' for what, answer in answers.items() if answer.complaint()]
    for role in ('cloth', 'obstacle'):
        refused = answers[role].code == 2 and 'start' not in answers[role].error
        if refused and errors_of(answers['doctor'], role) == 0:
            complaints.append(f'{role}: refused, but doctor found no error: {answers[role].error.strip()[:200]}')
    return answers, complaints


class Row:
    def __init__(self):
        self.files = 0
        self.codes = defaultdict(Counter)
        self.seconds = 0.0
        self.peak = 0

    def add(self, answers):
        self.files += 1
        for what, answer in answers.items():
            self.codes[what][answer.code] += 1
            self.seconds = max(self.seconds, answer.seconds)
            self.peak = max(self.peak, answer.peak)

    def text(self, name):
        doctor, cloth, obstacle = (self.codes[what] for what in ('doctor', 'cloth', 'obstacle'))
        return (f'| {name} | {self.files} | {doctor[1] + doctor[2]} | {cloth[0]}, {cloth[1]}, {cloth[2]} '
                f'| {obstacle[0]}, {obstacle[1]}, {obstacle[2]} | {self.seconds:.1f} | {self.peak / 1e6:.0f} |')


HEAD = ('| package, format | files | with errors | as cloth: ran, failed, refused | as obstacle | most CPU s | most MB |\n'
        '|---|---|---|---|---|---|---|\n')


def table_of(rows):
    return HEAD + ''.join(row.text(f'{package}, {suffix or "none"}') + '\n' for (package, suffix), row in sorted(rows.items()))


def examine_all(program, files, folder):
    """Rows by package and format, and how much was not allowed, which is printed."""
    rows, wrong = defaultdict(Row), 0
    with tempfile.TemporaryDirectory() as scratch:
        for file in files:
            answers, complaints = examine(program, file.resolve(), Path(scratch))
            rows[(file.relative_to(folder).parts[0], file.suffix.lower())].add(answers)
            for complaint in complaints:
                wrong += 1
                print(f'{file}: {complaint}', flush=True)
    return rows, wrong


def main():
    parser = argparse.ArgumentParser(description='Puts odd and broken meshes through the program.')
    parser.add_argument('program')
    parser.add_argument('folder')
    parser.add_argument('names', nargs='*', help='parts of paths (default: all files)')
    parser.add_argument('-o', dest='table', help='also write the table to this file')
    wish = parser.parse_args()
    found = sorted(file for file in Path(wish.folder).rglob('*') if file.is_file()) if Path(wish.folder).is_dir() else []
    files = [file for file in found if not wish.names or any(name in str(file) for name in wish.names)]
    if not files:
        print(f'odd_meshes: no files in {wish.folder}; .ci/fetch_meshes.sh puts them there')
        return SKIPPED
    rows, wrong = examine_all(wish.program, files, wish.folder)
    total = f'{len(files)} files, {wrong} wrong'
    print(table_of(rows) + total)
    if wish.table:
        command = ' '.join(['tests/validation/odd_meshes.py', *sys.argv[1:]])
        Path(wish.table).write_text(f'Written by `{command}`.\n\n{table_of(rows)}\n{total}\n')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
