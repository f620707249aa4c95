#!/usr/bin/env python3
"""Checks the laws of a build and writes what they measured as one Markdown table: laws_table.py BUILD [-o FILE].

Every case with the tag [law] appends its rows to the file that the environment variable PERCALE_LAWS names (tests/support/laws.h).
This program runs the test files that have some through ctest, sorts the rows and writes them with this command as first line. The exit code is that of
ctest; a law outside its limit therefore fails here, too, and its row is in the table. Standard library only.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HEAD = '| law | measured | limit |\n|---|---|---|\n'


def measured_rows(build):
    """Sorted rows of the table, and the exit code of ctest."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / 'rows'
        rows.touch()
        run = subprocess.run(['ctest', '--test-dir', build, '-L', 'validation', '--output-on-failure'], stdout=sys.stderr,
                             env={**os.environ, 'PERCALE_LAWS': str(rows)}, check=False)
        return sorted(rows.read_text().splitlines(keepends=True)), run.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('build', help='build folder with the test programs')
    parser.add_argument('-o', dest='table', help='file of the table (default: standard output)')
    wish = parser.parse_args()
    rows, code = measured_rows(wish.build)
    command = ' '.join(['tests/validation/laws_table.py', *sys.argv[1:]])
    text = f'Written by `{command}`.\n\n{HEAD}{"".join(rows)}'
    if wish.table:
        Path(wish.table).write_text(text)
    else:
        sys.stdout.write(text)
    return code if rows or code else 1


if __name__ == '__main__':
    sys.exit(main())
