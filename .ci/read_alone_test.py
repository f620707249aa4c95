#!/usr/bin/env python3
"""Proves which sources read_alone.py takes for a change, without reading any."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import read_alone

INCLUDES = {'a.cpp': ['a.h'], 'a.h': ['deep.h'], 'b.cpp': ['b.h'], 'b.h': [], 'deep.h': ['b.h'], 'c.cpp': []}


class Users(unittest.TestCase):
    def users(self, *changed):
        return sorted(read_alone.with_users(changed, {path: [(1, name, name) for name in found] for path, found in INCLUDES.items()}))

    def test_a_source_asks_for_itself(self):
        self.assertEqual(self.users('c.cpp'), ['c.cpp'])

    def test_a_header_asks_for_whatever_includes_it_by_a_detour(self):
        self.assertEqual(self.users('deep.h'), ['a.cpp', 'a.h', 'deep.h'])
        self.assertEqual(self.users('b.h'), ['a.cpp', 'a.h', 'b.cpp', 'b.h', 'deep.h'])

    def test_what_is_no_code_asks_for_itself(self):
        self.assertEqual(self.users('README.md', 'c.cpp'), ['README.md', 'c.cpp'])

    def test_headers_do_not_count_and_what_changed_comes_first(self):
        users = {f'engine/{number:03}.{end}' for number in range(50) for end in ('cpp', 'h')}
        changed = ['engine/007.cpp', 'engine/007.h', 'tests/scenes/a_test.cpp', 'tests/engine/b_test.cpp']
        self.assertEqual(read_alone.at_most(users, changed, 100), {path for path in users if path.endswith('.cpp')} | {'tests/scenes/a_test.cpp'})
        few = read_alone.at_most(users, changed, 10)
        self.assertEqual(len(few), 10)
        self.assertTrue({'engine/007.cpp', 'tests/scenes/a_test.cpp'} <= few)

    def test_of_many_the_most_that_are_allowed_are_taken_evenly(self):
        paths = {f'{number:03}' for number in range(100)}
        self.assertEqual(read_alone.evenly(paths, 100), paths)
        self.assertEqual(sorted(read_alone.evenly(paths, 4)), ['000', '025', '050', '075'])
        self.assertEqual(read_alone.evenly(paths, -3), set())


if __name__ == '__main__':
    unittest.main()
