#!/usr/bin/env python3
"""Proves which tests .ci/quick chooses and how it takes ninja's link command apart, without building anything."""
import sys
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import layers

quick = SourceFileLoader('quick', str(Path(__file__).resolve().parent / 'quick')).load_module()

FILES = {
    'engine/model/a.h': [], 'engine/model/a.cpp': ['engine/model/a.h'], 'engine/model/a_kernel.inl': [],
    'engine/model/b.h': ['engine/model/a.h'], 'engine/model/ab.h': [],
    'tests/engine/model/a_test.cpp': ['engine/model/a.h'], 'tests/engine/model/a_bands_test.cpp': [],
    'tests/engine/model/ab_test.cpp': ['engine/model/ab.h'], 'tests/engine/model/b_test.cpp': ['engine/model/b.h'],
    'tests/properties/laws_test.cpp': ['engine/model/a.h', 'tests/support/scenes.h'], 'tests/support/scenes.h': [],
}


def tests_of(*changed):
    includes = {path: [(1, target, target) for target in targets] for path, targets in FILES.items()}
    tree = layers.Tree(Path('.'), sorted(FILES), {}, includes)
    return [test.split('/')[-1][:-len('_test.cpp')] for test in quick.tests_of(tree, changed)]


class Choice(unittest.TestCase):
    def test_a_source_asks_for_the_tests_of_its_module_and_those_that_include_it(self):
        for path in ('engine/model/a.cpp', 'engine/model/a.h', 'engine/model/a_kernel.inl'):
            self.assertEqual(tests_of(path), ['a_bands', 'a', 'laws'], path)

    def test_a_test_asks_for_itself(self):
        self.assertEqual(tests_of('tests/engine/model/b_test.cpp'), ['b'])

    def test_a_header_of_tests_asks_for_those_that_include_it(self):
        self.assertEqual(tests_of('tests/support/scenes.h'), ['laws'])

    def test_what_is_no_code_asks_for_nothing(self):
        self.assertEqual(tests_of('README.md', 'tests/engine/model/gone_test.cpp'), [])

    def test_the_program_of_a_test(self):
        for path, layer in [('tests/scenes/run/x_test.cpp', 'scenes'), ('tests/properties/x_test.cpp', 'engine'),
                            ('tests/properties/collision/x_test.cpp', 'collision'), ('tests/validation/x_test.cpp', None),
                            ('tests/properties/allocations/x_test.cpp', None), ('tests/data/generators/x_test.cpp', 'scenes')]:
            self.assertEqual(quick.layer_of(path), layer, path)


class Linking(unittest.TestCase):
    COMMANDS = ('g++ -c a.cpp -o tests/a.o\n'
                ': && g++ -O3 tests/d/support/main.cpp.o tests/d/engine/a_test.cpp.o tests/d/engine/sub/a_test.cpp.o tests/d/support/m.cpp.o '
                '-o percale_engine_tests  engine/libpercale_engine.a /usr/lib/libccd.so && cd tests && cmake -D X\n')

    def test_the_link_command_is_found(self):
        words, objects, libraries = quick.link_command(self.COMMANDS, 'percale_engine_tests')
        self.assertEqual((words[0], words[-1], len(objects), libraries), ('g++', '/usr/lib/libccd.so', 4, ['engine/libpercale_engine.a']))

    def test_a_program_that_is_not_linked_is_an_error(self):
        self.assertRaises(SystemExit, quick.link_command, self.COMMANDS, 'percale_scenes_tests')

    def test_only_the_chosen_tests_are_compiled(self):
        objects = quick.link_command(self.COMMANDS, 'percale_engine_tests')[1]
        self.assertEqual(quick.wanted_objects(objects, ['tests/engine/a_test.cpp']),
                         ['tests/d/support/main.cpp.o', 'tests/d/engine/a_test.cpp.o', 'tests/d/support/m.cpp.o'])


if __name__ == '__main__':
    unittest.main()
