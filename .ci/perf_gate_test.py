#!/usr/bin/env python3
"""Proves the decisions of perf_gate.py without building anything."""
import json
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import perf_gate

BASE_LOG = '# Changelog\n\n## Unreleased\n\n### Added\n- A thing for hang.\n\n### Performance\n- sphere: dearer by 8 %, exact distances.\n'


def with_line(line, heading='### Performance'):
    return BASE_LOG + f'\n{heading}\n{line}\n'


class Judgement(unittest.TestCase):
    def words(self, base, head, allowed=()):
        return {v.scene: v.word for v in perf_gate.judge(base, head, set(allowed), 5.0)}

    def test_up_to_the_limit_passes(self):
        self.assertEqual(self.words({'hang': 1000}, {'hang': 1050}), {'hang': 'ok'})
        self.assertEqual(self.words({'hang': 1000}, {'hang': 10}), {'hang': 'ok'})

    def test_above_the_limit_fails(self):
        self.assertEqual(self.words({'hang': 1000}, {'hang': 1051}), {'hang': 'dearer'})

    def test_above_the_limit_passes_where_the_changelog_says_so(self):
        self.assertEqual(self.words({'hang': 1000, 'sphere': 1000}, {'hang': 2000, 'sphere': 2000}, ['hang']),
                         {'hang': 'allowed', 'sphere': 'dearer'})

    def test_a_scene_that_the_base_cannot_run_is_new(self):
        verdict, = perf_gate.judge({}, {'hang': 1000}, set(), 5.0)
        self.assertEqual((verdict.word, verdict.ratio), ('new', None))

    def test_one_bad_scene_among_good_ones_is_seen(self):
        base = dict.fromkeys(perf_gate.SCENES, 1000)
        words = self.words(base, {**base, 'two_cloths': 1100})
        self.assertEqual([scene for scene, word in words.items() if word != 'ok'], ['two_cloths'])

    def test_the_table_shows_both_counts_and_the_ratio(self):
        text = perf_gate.table(perf_gate.judge({'hang': 1000000}, {'hang': 1500000, 'sphere': 7}, set(), 5.0))
        self.assertRegex(text, r'hang +1,000,000 +1,500,000 +1\.5000  dearer')
        self.assertRegex(text, r'sphere +- +7 +-  new')


class Stored(unittest.TestCase):
    STORED = {'toolchain': 'GCC: 12.2.0', 'scenes': {'hang': 1000, 'sphere': 1000}}

    def test_counts_are_compared_with_those_of_the_same_compiler(self):
        verdicts, comparable = perf_gate.judge_stored(self.STORED, 'GCC: 12.2.0', {'hang': 1010, 'sphere': 1011}, 1.0)
        self.assertEqual(([v.word for v in verdicts], comparable), (['ok', 'dearer'], True))

    def test_counts_of_another_compiler_are_not_compared(self):
        verdicts, comparable = perf_gate.judge_stored(self.STORED, 'GCC: 13.1.0', {'hang': 9999}, 1.0)
        self.assertEqual(([v.word for v in verdicts], comparable), (['new'], False))

    def test_the_compiler_is_read_from_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / 'program'
            program.write_bytes(b'\x7fELF\0\xffGCC: (Debian 12.2.0-14+deb12u1) 12.2.0\0')
            self.assertTrue(perf_gate.toolchain(program).startswith('GCC: 12.2.0, '))

    def test_every_scene_has_a_stored_count(self):
        stored = json.loads((Path(perf_gate.__file__).parent / 'instructions.json').read_text())
        self.assertEqual(set(stored['scenes']), set(perf_gate.SCENES))

    def test_a_program_that_is_missing_ends_with_2(self):
        self.assertEqual(perf_gate.main(['--program', 'no-such-program']), 2)


class Changelog(unittest.TestCase):
    def allowed(self, head):
        return perf_gate.allowed_scenes(BASE_LOG, head, perf_gate.SCENES)

    def test_a_line_that_the_base_has_allows_nothing(self):
        self.assertEqual(self.allowed(BASE_LOG), set())

    def test_a_new_line_under_performance_allows_its_scene(self):
        self.assertEqual(self.allowed(with_line('- hang: dearer by 9 %, one more exact test.')), {'hang'})
        self.assertEqual(self.allowed(with_line('- hang and two_cloths.', '## performance')), {'hang', 'two_cloths'})

    def test_a_name_is_a_whole_word(self):
        self.assertEqual(self.allowed(with_line('- hang_rk4: dearer.')), {'hang_rk4'})
        self.assertEqual(self.allowed(with_line('- changes to the spheres')), set())

    def test_a_line_under_another_heading_allows_nothing(self):
        self.assertEqual(self.allowed(with_line('- hang: dearer.', '### Changed')), set())
        self.assertEqual(self.allowed(with_line('- x\n### Changed\n- hang: dearer.')), set())

    def test_a_changed_line_counts_as_new(self):
        self.assertEqual(self.allowed(BASE_LOG.replace('8 %', '20 %')), {'sphere'})


class Counting(unittest.TestCase):
    def test_the_total_of_a_callgrind_file_is_read(self):
        self.assertEqual(perf_gate.counted_instructions('version: 1\nevents: Ir\nfn=(1)\n12 34\n\ntotals: 987654\n'), 987654)

    def test_nothing_counted_is_an_error(self):
        for text in ('events: Ir\n', 'totals: 0\n', ''):
            with self.assertRaises(perf_gate.CannotMeasure):
                perf_gate.counted_instructions(text)

    def test_a_command_that_fails_is_an_error_with_what_it_said(self):
        with self.assertRaisesRegex(perf_gate.CannotMeasure, 'ended with 3:\nout of order'):
            perf_gate.run(['sh', '-c', 'echo out of order; exit 3'])

    def test_wrong_usage_ends_with_2(self):
        self.assertEqual(perf_gate.main(['--base', 'no-such-ref']), 2)


class Scenes(unittest.TestCase):
    def test_every_scene_is_toml_of_at_most_30_steps(self):
        self.assertEqual(len(perf_gate.SCENES), 6)
        for name, text in perf_gate.SCENES.items():
            scene = tomllib.loads(text)
            steps = scene['duration'] / scene.get('step', {}).get('time_step', 1 / 60)
            self.assertLessEqual(round(steps), 30, name)
            self.assertTrue(scene['cloth'], name)


if __name__ == '__main__':
    unittest.main()
