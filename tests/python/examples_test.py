"""The examples of data/examples run, and say what they found."""
import os
import re
import subprocess
import sys

import pytest


@pytest.fixture
def run_example(source_dir, tmp_path):
    def run(name, *arguments):
        file = source_dir / 'data' / 'examples' / f'{name}.py'
        done = subprocess.run([sys.executable, '-B', file, *arguments], capture_output=True, text=True, check=False, cwd=tmp_path,
                              env={**os.environ, 'MPLCONFIGDIR': str(tmp_path)}, timeout=300)
        assert done.returncode == 0, done.stdout + done.stderr
        assert len(file.read_text().splitlines()) < 80
        return done.stdout
    return run


def figures(pattern, text):
    found = re.search(pattern, text)
    assert found, text
    return [float(figure) for figure in found.groups()]


def test_the_draped_sheet_comes_to_rest_clear_of_the_ball(run_example):
    text = run_example('drape')
    time, lowest = figures(r'at rest after ([\d.]+) s.* lowest vertex (-?[\d.]+) m', text)
    assert time < 10.0 and -0.4 < lowest < 0.0
    pairs, distance = figures(r'(\d+) intersecting pairs, smallest distance ([\d.]+) mm', text)
    assert pairs == 0 and 0.0 < distance < 5.5


def test_the_gripper_pulls_no_harder_than_it_may_and_gets_the_towel(run_example):
    text = run_example('gripper')
    (most,) = figures(r'at most ([\d.]+) N while', text)
    share, pull = figures(r'(\d+)% of the vertices.* largest pull was ([\d.]+) N', text)
    assert share == 0 and 0.3 * most < pull < 0.5


def test_the_fit_finds_the_stiffness_that_was_measured(run_example):
    (found,) = figures(r'found: bend_stiffness = (\S+) N m', run_example('fit_fabric'))
    assert found == pytest.approx(2e-5, rel=0.25)  # the coefficient jumps with the number of folds


def test_the_sweep_runs_every_setting_in_threads(run_example):
    rows = [line.split() for line in run_example('sweep', '4').splitlines()[1:]]
    assert len(rows) == 9 and {row[-1] for row in rows} == {'yes'}
    assert [row[:2] for row in rows] == sorted(([row[0], row[1]] for row in rows), key=lambda row: (float(row[0]), -float(row[1])))


def test_the_program_of_the_readme_runs(source_dir):
    text = (source_dir / 'scenes' / 'python' / 'README.md').read_text()
    code = text.split('```python\n')[1].split('```')[0]
    done = subprocess.run([sys.executable, '-B', '-c', code + 'assert result.passed and len(result.frames) == 16\n'],
                          capture_output=True, text=True, check=False, cwd=source_dir, timeout=300)
    assert done.returncode == 0, done.stderr
    assert 'nan' not in done.stdout


def test_the_bench_of_a_step_prints_its_figures(source_dir):
    done = subprocess.run([sys.executable, '-B', source_dir / 'tests' / 'python' / 'step_overhead.py', '20'], capture_output=True,
                          text=True, check=True, timeout=300)
    assert '33 x 33' in done.stdout and len(done.stdout.splitlines()) == 5
