#!/usr/bin/env python3
"""Proves that layers.py passes a clean tree and catches each kind of violation, and that the function finder measures right."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import layers
import words as words_module
from cpp_functions import Unbalanced, code_lines, count_parameters, find_functions

CLEAN = {
    'README.md': 'Cloth.\n',
    'LICENSE': 'MIT\n',
    'engine/include/percale/mesh.h': '#pragma once\n#include <Eigen/Core>\n#include <vector>\nusing Vec3 = Eigen::Vector3d;\n',
    'engine/support/check.h': '#pragma once\n#include <cstdio>\nvoid check(bool fine);\n',
    'engine/model/shapes.h': '#pragma once\n#include "percale/mesh.h"\n#include "support/check.h"\nint shape();\n',
    'engine/model/shapes.cpp': '#include "shapes.h"\n\nint shape() { return 3; }\n',
    'engine/forces/body_force.h': '#pragma once\n#include "model/shapes.h"\n',
    'engine/solve/newton.h': '#pragma once\n#include "forces/body_force.h"\n',
    'engine/step/step.h': '#pragma once\n#include "solve/newton.h"\n',
    'engine/simulation.h': '#pragma once\n#include "step/step.h"\n',
    'collision/include/percale/detectors.h': '#pragma once\n#include "percale/mesh.h"\n',
    'collision/surface.h': '#pragma once\n#include "percale/detectors.h"\n#include <ccd/ccd.h>\n',
    'collision/fcl/fcl_tree.h': '#pragma once\n#include "surface.h"\n#include <fcl/fcl.h>\n',
    'collision/bullet/bullet_tree.h': '#pragma once\n#include <btBulletCollisionCommon.h>\n',
    'scenes/scene.h': '#pragma once\n#include <percale/detectors.h>\n#include <toml++/toml.h>\n',
    'scenes/export/frames.h': '#pragma once\n#include "scene.h"\n',
    'tests/engine/model/shapes_test.cpp':
        '#include "model/shapes.h"\n#include "tests/support/catch.h"\n\nnamespace percale::test::shapes_test {\n' +
        'TEST_CASE("a shape") { CHECK(shape() == 3); }\n' * 60 + '}  // namespace percale::test::shapes_test\n',
    'tests/support/catch.h': '#pragma once\n#include <catch2/catch.hpp>\n',
    'data/scenes/hang.toml': 'title = "hang"\n',
}


def long_function(lines):
    return 'void run() {\n' + '    step();\n' * (lines - 2) + '}\n'


def violations(changes=None, removed=()):
    """What layers.py says about the clean tree with some files changed (or removed)."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in {**CLEAN, **(changes or {})}.items():
            if path not in removed:
                (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
                (Path(folder) / path).write_text(text)
        return layers.check(folder)[0]


class Rules(unittest.TestCase):
    def caught(self, path, text, expected):
        """Exactly one violation, at the changed file, that says what is expected."""
        found = violations({path: text})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f'{path}:'), found)
        self.assertIn(expected, found[0])

    def include_caught(self, path, include, expected):
        self.caught(path, CLEAN.get(path, '') + f'#include {include}\n', expected)

    def test_namespaces_of_tests(self):
        path = 'tests/engine/model/shapes_test.cpp'
        text = CLEAN[path]
        self.caught(path, text.replace('shapes_test', 'forms_test'), 'no namespace of its own')
        self.caught(path, text.replace('namespace percale', 'TEST_CASE("first") {}\nnamespace percale', 1), 'a case outside')
        self.caught(path, text + 'TEST_CASE("last") {}\n', 'a case outside')
        self.caught(path, text.replace('::shapes_test', '::reshapes_test'), 'no namespace of its own')
        self.caught('tests/engine/more/shapes_test.cpp', text, 'is that of tests/engine/model/shapes_test.cpp, too')
        self.assertEqual(violations({'tests/engine/more/shapes_test.cpp': text.replace('::shapes_test', '::more_shapes_test')}), [])

    def test_titles_of_tests(self):
        path = 'tests/engine/model/shapes_test.cpp'
        inside = '}  // namespace'
        named = lambda columns: CLEAN[path].replace(inside, f'TEST_CASE("{"a" * 30}"\n"{"b" * (columns - 30)}: c") {{}}\n{inside}', 1)
        self.caught(path, named(71), 'first colon of a title too far right (71, 70)')
        self.assertEqual(violations({path: named(70)}), [])

    def test_a_clean_tree_passes(self):
        self.assertEqual(violations(), [])

    def test_top_level(self):
        self.caught('notes.txt', 'x\n', 'not allowed at the top level')
        found = violations({'src/a.md': 'x\n'})
        self.assertEqual(found, ['src:1: not allowed at the top level'])

    def test_unknown_part_of_the_engine(self):
        self.caught('engine/misc/thing.h', '#pragma once\n', 'unknown part of the engine')

    def test_every_forbidden_direction_between_layers(self):
        header = {'public': 'engine/include/percale/mesh.h', 'support': 'engine/support/check.h', 'model': 'engine/model/shapes.h',
                  'forces': 'engine/forces/body_force.h', 'solve': 'engine/solve/newton.h', 'step': 'engine/step/step.h',
                  'engine': 'engine/simulation.h', 'public_collision': 'collision/include/percale/detectors.h',
                  'collision': 'collision/surface.h', 'scenes': 'scenes/scene.h'}
        for part, path in header.items():
            for other, target in header.items():
                said = violations({path: CLEAN[path] + f'#include "{target}"\n'})
                is_refused = any(f'{part} must not include {other} ' in line for line in said)
                self.assertEqual(is_refused, other not in layers.MAY_INCLUDE[part], (part, other, said))

    def test_the_table_of_directions(self):
        order = ['support', 'model', 'forces', 'solve', 'step']
        for low, part in enumerate(order):
            for high, other in enumerate(order):
                self.assertEqual(other in layers.MAY_INCLUDE[part], high <= low, (part, other))
        for part in order + ['public', 'engine']:
            self.assertFalse(layers.MAY_INCLUDE[part] & {'collision', 'public_collision', 'scenes', 'tests'}, part)
        self.assertEqual(layers.MAY_INCLUDE['collision'], {'public', 'public_collision', 'collision'})
        self.assertEqual(layers.MAY_INCLUDE['scenes'], {'public', 'public_collision', 'scenes'})
        self.assertEqual(layers.MAY_INCLUDE['support'], {'public', 'support'})

    def test_folders_of_collision(self):
        header = {folder: f'collision/{folder}/a.h' for folder in layers.COLLISION_FOLDERS} | {'top': 'collision/detector.h'}
        clean = {path: '#pragma once\n' for path in header.values()} | {'collision/tolerances.h': '#pragma once\n'}
        for folder, path in header.items():
            for other, target in header.items():
                said = violations({**clean, path: f'#include "{target}"\n#include "collision/tolerances.h"\n'})
                is_refused = any(f'collision/{folder} must not include collision/{other} ' in line for line in said)
                allowed = folder == 'top' or other in layers.COLLISION_FOLDERS[folder] | {folder}
                self.assertEqual(is_refused, not allowed, (folder, other, said))

    def test_tolerances_of_a_layer_make_no_ring_of_folders(self):
        changes = {'collision/detector.h': '#include "lists/a.h"\n', 'collision/lists/a.h': '#include "tolerances.h"\n'}
        self.assertEqual(violations({**changes, 'collision/tolerances.h': '#pragma once\n'}), [])
        ring = violations({**changes, 'collision/tolerances.h': '#include "detector.h"\n'})
        self.assertTrue(any('folders include each other' in line for line in ring), ring)

    def test_tolerances_are_read_by_their_whole_layer_and_read_nothing(self):
        clean = {'engine/tolerances.h': '#pragma once\n'}
        for path in ('engine/support/check.h', 'engine/step/step.h', 'engine/simulation.h'):
            self.assertEqual(violations({**clean, path: '#include "tolerances.h"\n' + CLEAN[path]}), [])
        for path in ('engine/include/percale/mesh.h', 'collision/surface.h', 'scenes/scene.h'):
            said = violations({**clean, path: CLEAN[path] + '#include "engine/tolerances.h"\n'})
            self.assertTrue(any('must not include engine ' in line for line in said), (path, said))
        self.caught('engine/tolerances.h', '#include "support/check.h"\n', 'tolerances.h must include no file of the project')

    def test_an_include_that_is_no_file(self):
        self.include_caught('scenes/scene.h', '"sceen.h"', 'is no file of the project')

    def test_headers_of_other_projects(self):
        for path, name in [
                ('engine/model/shapes.h', '<fcl/fcl.h>'), ('engine/model/shapes.h', '<ccd/ccd.h>'),
                ('collision/surface.h', '<fcl/geometry/bvh/BVH_model.h>'), ('collision/surface.h', '<btBulletCollisionCommon.h>'),
                ('collision/fcl/fcl_tree.h', '<BulletCollision/btDbvt.h>'), ('collision/bullet/bullet_tree.h', '<fcl/fcl.h>'),
                ('collision/surface.h', '<nlohmann/json.hpp>'), ('engine/step/step.h', '<CLI/CLI.hpp>'),
                ('scenes/scene.h', '<ccd/ccd.h>'), ('tests/engine/model/shapes_test.cpp', '<assimp/scene.h>'),
                ('tests/engine/model/shapes_test.cpp', '<catch2/catch.hpp>'), ('engine/solve/newton.h', '<cholmod.h>'),
                ('engine/solve/newton.h', '<boost/any.hpp>')]:
            self.include_caught(path, name, 'is not allowed')

    def test_a_commented_include_is_none(self):
        self.assertEqual(violations({'engine/solve/newton.h': '#pragma once\n// #include <fcl/fcl.h>\n'}), [])

    def test_forces_do_not_know_the_detector(self):
        self.caught('engine/forces/body_force.h', '#pragma once\n\nclass ContactDetector;\n', 'forces must not know')
        self.assertEqual(violations({'engine/forces/body_force.h': '#pragma once\n// rows come from the ContactDetector\n'}), [])

    def test_files_that_include_each_other(self):
        found = violations({'scenes/a.h': '#include "b.h"\n', 'scenes/b.h': '#include "c.h"\n', 'scenes/c.h': '#include "a.h"\n'})
        self.assertEqual(found, ['scenes/a.h:1: files include each other (scenes/a.h, scenes/b.h, scenes/c.h)',
                                 'scenes/a:1: modules include each other (scenes/a, scenes/b, scenes/c)'])

    def test_a_file_that_includes_itself(self):
        self.caught('scenes/a.h', '#include "a.h"\n', 'files include each other')

    def test_folders_that_include_each_other(self):
        found = violations({'scenes/run.h': '#include "export/frames.h"\n'})
        self.assertEqual(found, ['scenes:1: folders include each other (scenes, scenes/export)'])

    def test_modules_that_include_each_other(self):
        small_tests = {f'tests/scenes/{name}_test.cpp': f'namespace percale::test::{name}_test {{\n}}\n' for name in 'ab'}
        ring = {'scenes/a.h': 'int x;\n', 'scenes/b.h': 'int x;\n', 'scenes/a.cpp': '#include "b.h"\n', 'scenes/b.cpp': '#include "a.h"\n'}
        self.assertEqual(violations({**ring, **small_tests}), ['scenes/a:1: modules include each other (scenes/a, scenes/b)'])
        self.assertEqual(violations({**ring, **small_tests, 'scenes/b.cpp': '#include "b.h"\n'}), [])

    def test_a_kernel_belongs_to_the_module_of_its_name(self):
        ring = {'engine/model/a.h': 'int x;\n', 'engine/model/b.h': '#include "model/a.h"\n',
                'engine/model/a_kernel.inl': '#include "model/b.h"\n'}
        self.assertEqual(violations(ring), ['engine/model/a:1: modules include each other (engine/model/a, engine/model/b)'])

    def test_a_public_header_belongs_to_the_source_of_its_name(self):
        ring = {'engine/include/percale/world.h': '#pragma once\n', 'engine/world.cpp': '#include "step/run.h"\n',
                'engine/step/run.h': '#include "percale/world.h"\n', 'tests/engine/world_test.cpp': 'namespace percale::test::world_test {\n}\n'}
        self.assertEqual(violations(ring), ['engine/step/run:1: modules include each other (engine/step/run, engine/world)'])
        self.assertEqual(violations({**ring, 'engine/world.cpp': 'int x;\n'}), [])

    def test_three_modules_in_a_ring_are_one_violation(self):
        ring = {f'tests/support/{a}.{end}': f'#include "{b}.h"\n' if end == 'cpp' else 'int x;\n'
                for a, b in ('ab', 'bc', 'ca') for end in ('h', 'cpp')}
        self.assertEqual(violations(ring), ['tests/support/a:1: modules include each other '
                                            '(tests/support/a, tests/support/b, tests/support/c)'])

    def test_files_in_one_folder(self):
        self.assertEqual(violations({f'scenes/export/f{i}.h': 'int x;\n' for i in range(24)}), [])
        found = violations({f'scenes/export/f{i}.h': 'int x;\n' for i in range(25)})
        self.assertEqual(found, ['scenes/export:1: too many files in one folder (26, 25)'])
        self.assertEqual(violations({f'tests/fuzz/corpus/obj/f{i}': 'x\n' for i in range(40)}), [])

    def test_length_of_readmes(self):
        self.assertEqual(violations({'scenes/README.md': 'x\n' * 80, 'README.md': 'x\n' * 120}), [])
        self.caught('scenes/README.md', 'x\n' * 81, 'README too long (81 lines, 80)')
        self.caught('README.md', 'x\n' * 121, 'README too long (121 lines, 120)')

    def test_width_of_readmes(self):
        wide = 'x' * 121
        self.caught('scenes/README.md', f'a\n{wide}\n', 'README.md:2: line of a README too wide (121, 120)')
        self.caught('scenes/README.md', f'```\n{wide}\n```\n{wide}\n', 'README.md:4: line')
        self.assertEqual(violations({'README.md': f'{wide[1:]}\n| {wide} |\n\n    {wide}\n\n```sh\n{wide}\n```\n'}), [])

    def test_every_direction_between_the_rooms_of_scenes(self):
        for low, room in enumerate(layers.SCENES_ROOMS):
            for high, other in enumerate(layers.SCENES_ROOMS):
                found = violations({f'scenes/{room}/a.h': f'#include "{other}/b.h"\n', f'scenes/{other}/b.h': 'int x;\n'})
                expected = [f'scenes/{room}/a.h:1: scenes/{room} must not include scenes/{other} ({other}/b.h)'] if high > low else []
                self.assertEqual(found, expected)
        self.caught('scenes/misc/a.h', 'int x;\n', 'unknown room of scenes')

    def test_a_source_without_its_test(self):
        self.caught('scenes/export/frames.cpp', 'int x;\n', 'no test file (tests/scenes/export/frames_test.cpp)')
        self.caught('scenes/python/arrays.cpp', 'int x;\n', 'no test file (tests/python/arrays_test.py)')
        self.assertEqual(len(violations(removed=['tests/engine/model/shapes_test.cpp'])), 2)  # the size of the tests too
        for exempt in layers.NO_TEST_FILE:
            self.assertEqual(violations({exempt: 'int main() {}\n'}), [])

    def test_length_of_functions(self):
        path = 'tests/support/thing.h'
        self.assertEqual(violations({path: long_function(60)}), [])
        self.caught(path, long_function(61), 'run: function too long (61, 60)')
        more_tests = {'tests/support/more.h': 'int x;\n' * 100}
        self.assertEqual(violations({'engine/model/spring_kernel.inl': long_function(61), **more_tests}), [])
        found = violations({'engine/model/spring.inl': long_function(61), **more_tests})
        self.assertEqual(found[0], 'engine/model/spring.inl:1: run: function too long (61, 60)')

    def test_distribution_of_function_lengths(self):
        functions = ''.join(long_function(9) for _ in range(8))
        found = violations({'engine/model/thing.h': functions, 'tests/a.h': 'int x;\n' * 400})
        self.assertEqual(found, ['library:1: median of function lines (9, 8)'])
        functions = ''.join(long_function(2) for _ in range(16)) + long_function(26) * 3
        found = violations({'engine/model/thing.h': functions, 'tests/a.h': 'int x;\n' * 400})
        self.assertEqual(found, ['library:1: p90 of function lines (26, 25)'])

    def test_length_of_files(self):
        self.caught('tests/support/thing.h', 'int x;\n' * 451, 'file too long (451, 450)')
        found = violations({f'engine/model/thing{i}.h': '\n' * 301 for i in range(5)})
        self.assertEqual(found, ['library:1: p90 of file lines (301, 300)'])

    def test_number_of_parameters(self):
        self.assertEqual(violations({'scenes/a.h': 'void f(int, int, int, int, int, std::map<int, int> m) {}\n'}), [])
        self.caught('scenes/a.h', 'void f(int, int, int, int, int, int, int) {}\n', 'f: too many parameters (7, 6)')
        self.caught('scenes/a.h', 'struct A { virtual int f(int, int, int, int, int, int, int) = 0; };\n', 'too many parameters (7, 6)')

    def test_nesting(self):
        self.assertEqual(violations({'scenes/a.h': 'void f() {\n' + 'if (a) {\n' * 3 + '}\n' * 3 + '}\n'}), [])
        self.caught('scenes/a.h', 'void f() {\n' + 'if (a) {\n' * 4 + '}\n' * 4 + '}\n', 'f: nested too deep (4, 3)')
        found = violations({'engine/forces/a_kernel.inl': 'void f() {\n' + 'if (a) {\n' * 4 + '}\n' * 4 + '}\n'})
        self.assertEqual(found, [])

    def test_brackets_that_do_not_match(self):
        self.caught('scenes/a.h', 'void f() {\n\n}}\n', 'brackets do not match')

    def test_names(self):
        self.caught('scenes/SceneFile.h', '#pragma once\n', 'name is not snake_case (SceneFile.h)')
        self.caught('data/scenes/on-ball.toml', 'x = 1\n', 'name is not snake_case (on-ball.toml)')
        self.caught('scenes/a.h', '#define SQUARE(x) x\n', 'macro does not start with PERCALE_ (SQUARE)')

    def test_eigen_types_in_public_headers(self):
        for name in ['Vector4d', 'VectorXd', 'MatrixXd', 'Quaterniond', 'Isometry3d', 'Matrix<double, Eigen::Dynamic, 3>', 'Vector2d',
                     'SparseMatrix<double>', 'Matrix4d', 'Matrix3Xd']:
            for path in ['engine/include/percale/thing.h', 'collision/include/percale/thing.h']:
                self.caught(path, f'#pragma once\nEigen::{name} x;\n', 'in a public header')
        self.assertEqual(violations({'engine/include/percale/thing.h': '// no MatrixXd here\nEigen::Vector3d x;\n'}), [])

    def test_unfinished_work(self):
        for word in ['TO' + 'DO', 'FIX' + 'ME', 'X' + 'XX', 'HA' + 'CK']:
            self.caught('data/README.md', f'a\n{word}: more\n', f'unfinished work ({word})')

    def test_paths_of_one_machine(self):
        for start in ['/wo' + 'rk/main', '/ro' + 'ot/x', '/tm' + 'p/build', '/ho' + 'me/me']:
            self.caught('README.md', f'see {start}\n', 'path of one machine')

    def test_large_files(self):
        self.caught('data/big.obj', 'v' * ((1 << 20) + 1), 'file too large (1048577 bytes, 1048576)')

    def test_less_test_code_than_library_code(self):
        found = violations({'scenes/a.h': 'int x;\n' * 200})
        self.assertEqual(len(found), 1)
        self.assertIn('less test code than library code', found[0])

    def test_only_files_that_git_would_track_count(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(['git', '-C', folder, 'init', '-q'], check=True)
            (Path(folder) / '.gitignore').write_text('/build/\n')
            (Path(folder) / 'build').mkdir()
            (Path(folder) / 'build' / 'junk.h').write_text('x')
            (Path(folder) / 'junk.h').write_text('x')
            self.assertEqual(layers.check(folder)[0], ['junk.h:1: not allowed at the top level'])

    def test_the_program_says_so_by_its_exit_code(self):
        with tempfile.TemporaryDirectory() as folder:
            program = [sys.executable, str(Path(__file__).resolve().parent / 'layers.py'), folder]
            self.assertEqual(subprocess.run(program, capture_output=True, check=False).returncode, 0)
            (Path(folder) / 'junk.h').write_text('x')
            result = subprocess.run(program, capture_output=True, check=False, text=True)
            self.assertEqual(result.returncode, 1)
            self.assertIn('1 violations', result.stdout)


class Glossary(unittest.TestCase):
    """With a glossary of its own, so that these hold whatever words the project's has."""

    def said(self, path, text, *words):
        tree = layers.Tree(Path('.'), [path], {path: text})
        words_module.check_glossary(tree, list(words))
        return tree.violations

    def test_an_identifier_is_searched_by_its_parts(self):
        way = words_module.Word('way', 'displacement', ('engine',))
        for name in ['way', 'ways', 'least_way', 'way_of_all', 'WayLimit', 'longestWay', 'way_', 'WAY_2']:
            self.assertEqual(self.said('engine/a.h', f'int x;\nint {name};\n', way),
                             [f'engine/a.h:2: "way" in {name}: the glossary says displacement'])
        for name in ['always', 'wayward', 'away_from', 'Runway']:
            self.assertEqual(self.said('engine/a.h', f'int {name};\n', way), [], name)

    def test_words_of_several_parts(self):
        word = words_module.Word('least_share', 'first_fraction', ('engine',))
        self.assertEqual(len(self.said('engine/a.h', 'int the_least_share, LeastShare;\n', word)), 2)
        self.assertEqual(self.said('engine/a.h', 'int least, share, least_of_share;\n', word), [])

    def test_only_in_the_folders_of_a_word(self):
        way = words_module.Word('way', 'displacement', ('engine',))
        self.assertEqual(self.said('scenes/a.h', 'int way;\n', way), [])
        self.assertEqual(self.said('engineroom/a.h', 'int way;\n', way), [])
        law = words_module.Word('way', 'displacement', ('engine/contact/friction',))
        for path, said in (('engine/contact/friction.h', 1), ('engine/contact/friction_law.h', 1), ('engine/contact/frictions.h', 0),
                           ('engine/contact/penalty.h', 0)):
            self.assertEqual(len(self.said(path, 'int way;\n', law)), said, path)

    def test_prose_only_where_told(self):
        text = '// In this way.\nint x;  /* a way\n   or two Ways */\nconst char* s = "way";\n'
        for in_prose, lines in ((False, []), (True, [1, 2, 3])):
            said = self.said('engine/a.h', text, words_module.Word('way', 'displacement', ('engine',), in_prose))
            self.assertEqual(said, [f'engine/a.h:{line}: "way": the glossary says displacement' for line in lines])

    def test_prose_of_readmes(self):
        word = words_module.Word('least_share', 'first fraction', ('engine',), True)
        self.assertEqual(self.said('engine/README.md', 'x\nthe least share counts\n', word),
                         ['engine/README.md:2: "least_share": the glossary says first fraction'])

    def test_an_identifier_is_named_once_a_file(self):
        way = words_module.Word('way', 'displacement', ('engine',))
        self.assertEqual(len(self.said('engine/a.h', 'int way; int f() { return way; }\n', way)), 1)

    def test_names_that_users_have_are_left_alone(self):
        word = words_module.Word('cut', 'clamp', ('engine',))
        self.assertEqual(self.said('engine/a.h', 'int line_search_cuts;\n', word), [])
        self.assertEqual(len(self.said('engine/a.h', 'int line_cuts;\n', word)), 1)

    def test_the_projects_glossary_is_checked(self):
        words = words_module.GLOSSARY
        texts = {f'{path}/thing_{k}.h': f'int {word.forbidden};\n' for k, word in enumerate(words) for path in word.paths}
        found = [line for line in violations(texts) if 'the glossary says' in line]
        for k, word in enumerate(words):
            of_word = [line for line in found if f'/thing_{k}.h:' in line and f'says {word.instead}' in line]
            self.assertEqual(len(of_word), len(word.paths), word)


class Paths(unittest.TestCase):
    def missing(self, text, file='engine/README.md'):
        return [line.rsplit(' ', 1)[1] for line in violations({file: text, 'engine/mesh/shapes.cpp': '', 'engine/mesh/shapes.h': ''})
                if 'there is no' in line]

    def test_paths_that_prose_names_exist(self):
        self.assertEqual(self.missing('`engine/mesh/shapes.{h,cpp}`, `mesh/shapes.h`, `engine/mesh/`, [m](mesh/shapes.h), `x/y.h`\n'), [])
        self.assertEqual(self.missing('`engine/mesh/shape.{h,cpp}`, `engine/meshes/`, [m](shapes.h)\n'),
                         ['engine/mesh/shape.h', 'engine/mesh/shape.cpp', 'engine/meshes/', 'shapes.h'])

    def test_forms_of_names_and_addresses_are_no_paths(self):
        self.assertEqual(self.missing('`engine/mesh/NAME.cpp`, `engine/mesh/x_test.cpp`, [w](https://a.org/b), [here](#part)\n'), [])


class FunctionFinder(unittest.TestCase):
    def found(self, text):
        return {f.name: (f.lines, f.parameters, f.nesting) for f in find_functions(text) if not f.is_lambda}

    def test_kinds_of_functions(self):
        text = '''namespace a {
struct P { int x = 3; std::vector<int> y{1, 2}; bool operator==(const P& o) const { return x == o.x; } };
class C : public B<int> {
public:
    explicit C(int a, std::map<int, int> m = {}) noexcept : a_{a}, b_(a), c_{m} {
        run();
    }
    ~C() = default;
    operator bool() const { return true; }
    int operator()(int a) { return a; }
};
template <class T, class U = std::vector<T>>
requires(sizeof(T) > 3)
auto pair_of(const T& t, U u) -> std::pair<int, int> { return {1, 2}; }
[[nodiscard]] static int last(int a[3], void (*call)(int, int)) { return a[0]; }
}
extern "C" { int plain(void) { return 1; } }
TEST_CASE("a { thing", "[tag]") { CHECK(true); }
'''
        self.assertEqual(self.found(text), {
            'operator==': (1, 1, 0), 'C': (3, 2, 0), 'operator bool': (1, 0, 0), 'operator()': (1, 1, 0), 'pair_of': (3, 2, 0),
            'last': (1, 2, 0), 'plain': (1, 0, 0), 'TEST_CASE': (1, 2, 0)})

    def test_what_is_no_function(self):
        for text in ['enum class E : int { a, b };', 'const auto table = std::array<int, 3>{1, 2, 3};', 'int x{3};',
                     'constexpr double v[] = {1, 2};', 'int declared(int a);', 'struct S { int a = 1; };']:
            self.assertEqual(find_functions(text), [], text)

    def nesting(self, body):
        return self.found('void f() {\n' + body + '\n}')['f'][2]

    def test_nesting_of_control_flow(self):
        self.assertEqual(self.nesting('run();'), 0)
        self.assertEqual(self.nesting('if (a) { b(); } else if (c) { d(); } else { e(); }'), 1)
        self.assertEqual(self.nesting('for (;;) { while (x) { switch (y) { case 1: { do { z(); } while (q); } } } }'), 4)
        self.assertEqual(self.nesting('for (int i : {1, 2}) for (int j : {3}) if (i) { run(); }'), 3)
        self.assertEqual(self.nesting('for (int i : {1, 2}) for (int j : {3}) run(i, j);'), 2)
        self.assertEqual(self.nesting('for (int i : {1, 2}) { if (i) continue; if (!i) return; }'), 1)
        self.assertEqual(self.nesting('{ { const Foo x{1, {2}}; } }'), 0)
        self.assertEqual(self.nesting('SECTION("x") { if constexpr (a) { b(); } }'), 1)
        self.assertEqual(self.nesting('try { if (a) { b(); } } catch (const E& e) { if (a) { while (b) { c(); } } }'), 2)

    def test_a_lambda_starts_again(self):
        text = 'void f() {\n if (a) { for (;;) { g([&](int x) mutable -> int { if (x) { return 1; } return 2; }); } }\n}'
        functions = {f.name: f for f in find_functions(text)}
        self.assertEqual((functions['f'].nesting, functions['f'].lines), (2, 3))
        self.assertEqual((functions['lambda'].nesting, functions['lambda'].parameters), (1, 1))

    def test_comments_and_literals_do_not_count(self):
        text = 'void f() {\n // {\n /* { */\n const char* s = "{"; char c = \'{\'; int n = 1\'000\'000; auto r = R"x({{)x";\n}\n'
        self.assertEqual(self.found(text), {'f': (5, 0, 0)})
        self.assertEqual(code_lines('// a\n\n/* b\n c */\nint x;  // d\nconst char* s = "// e";\n'), 2)

    def test_parameters(self):
        self.assertEqual([count_parameters(text) for text in ('', 'void', 'int a', 'std::map<int, int> m, F<void(int, int)> f')],
                         [0, 0, 1, 2])

    def test_unbalanced_text_is_refused(self):
        for text in ('void f() {', 'void f() }', 'void f(] {}'):
            self.assertRaises(Unbalanced, find_functions, text)


if __name__ == '__main__':
    unittest.main()
