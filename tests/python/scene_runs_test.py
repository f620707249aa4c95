"""Scene files and dicts, run."""
import _thread
import json
import subprocess

import numpy as np
import pytest

import percale
from conftest import SHEET

SCENE = {
    'title': 'towel', 'duration': 0.2,
    'fabric': {'sheet': SHEET},
    'cloth': [{'name': 'towel', 'fabric': 'sheet', 'grid': {'size': [0.5, 0.5], 'vertices': [9, 9]},
               'pose': {'translation': [0.0, 0.215, 0.0]}}],
    'obstacle': [{'name': 'ball', 'shape': {'sphere': {'radius': 0.2}}}],
    'output': {'fps': 10.0},
    'expect': {'intersections': 0, 'largest_strain': {'below': 0.5}},
}
SHIPPED = ['hang', 'six_particles', 'strip_without_bend', 'strip_with_hinges', 'incline_slide', 'rotating_sphere',
           'tablecloth_on_sphere', 'flag', 'beach_ball', 'sewn_tube']


@pytest.mark.parametrize('name', SHIPPED)
def test_a_run_ends_with_the_bits_of_the_program(source_dir, hash_of_program, name):
    scene = source_dir / 'data' / 'scenes' / f'{name}.toml'
    result = percale.run(scene, overrides={'duration': 0.4})
    assert result.state_hash == hash_of_program(scene, '--set', 'duration=0.4')


def test_steps_that_were_not_solved_are_a_status_and_a_warning():
    hurried = {'step.newton_iterations': 2, 'step.newton_tolerance': 1e-12}
    with pytest.warns(RuntimeWarning, match='unsolved: .* taken unsolved'):
        result = percale.run(SCENE, overrides=hurried)
    assert result.status == result.report['status'] == 'unsolved' and not result.passed
    assert result.reason == result.report['reason']


def test_calls_end_with_the_bits_of_a_scene(tmp_path, hash_of_program):
    scene = tmp_path / 'towel.toml'
    scene.write_text('duration = 0.5\n[fabric.sheet]\nsprings = { structural = 1000.0, shear = 500.0, bend = 10.0 }\n'
                     '[[cloth]]\nname = "towel"\nfabric = "sheet"\ngrid = { size = [0.5, 0.5], vertices = [9, 9] }\n'
                     'pose = { translation = [0.0, 0.215, 0.0] }\n[[obstacle]]\nname = "box"\n'
                     'shape = { box = { size = [0.3, 0.4, 0.3] } }\nfriction = 0.4\n')
    simulation = percale.Simulation()
    simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, {'translation': (0, 0.215, 0)})
    simulation.add_obstacle(percale.make_box((0.3, 0.4, 0.3)), friction=0.4)
    for _ in range(30):
        assert simulation.step().ok
    assert simulation.state_hash() == hash_of_program(scene)


def test_calls_with_pins_end_with_the_bits_of_a_scene(tmp_path, hash_of_program):
    scene = tmp_path / 'hang.toml'
    scene.write_text('duration = 0.3\n[step]\ntime_step = 0.01\nscheme = "tr_bdf2"\n[fabric.cotton]\npreset = "cotton"\n'
                     '[[cloth]]\nname = "sheet"\nfabric = "cotton"\ngrid = { size = [1.0, 1.0], vertices = [9, 9] }\npin = [0, 8]\n'
                     '[[event]]\ntime = 0.1\nunpin = { cloth = "sheet", vertices = [8] }\n')
    simulation = percale.Simulation(time_step=0.01, scheme='tr_bdf2')
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, 9, 9), {'preset': 'cotton'})
    simulation.pin(cloth, [0, 8])
    for step in range(30):
        if step == 10:
            simulation.unpin(cloth, 8)
        assert simulation.step().ok
    assert simulation.state_hash() == hash_of_program(scene)


def test_a_dict_runs_as_the_file_that_says_the_same(tmp_path, hash_of_program):
    file = tmp_path / 'towel.toml'
    file.write_text('duration = 0.2\n[fabric.sheet]\nsprings = { structural = 1000.0, shear = 500.0, bend = 10.0 }\n'
                    '[[cloth]]\nname = "towel"\nfabric = "sheet"\ngrid = { size = [0.5, 0.5], vertices = [9, 9] }\n'
                    'pose = { translation = [0.0, 0.215, 0.0] }\n[[obstacle]]\nname = "ball"\nshape = { sphere = { radius = 0.2 } }\n')
    result = percale.run(SCENE)
    assert result.state_hash == hash_of_program(file)
    assert result.state_hash == percale.run(percale.load_scene(SCENE)).state_hash


def test_a_result_tells_of_its_run():
    result = percale.run(SCENE, certify_steps=True)
    assert result.status == 'finished' and result.reason == '' and result.passed
    assert result.measures['intersections'] == 0 and 0 < result.measures['largest_strain'] < 0.5
    assert [e['measure'] for e in result.expectations][:2] == ['intersections', 'largest_strain']
    assert all(e['passed'] for e in result.expectations)
    report = result.report
    assert report['status'] == 'finished' and report['steps'] == 12 and len(report['frames']) == 3
    assert report['step_certificate']['states'] == 13
    assert result.frames == []
    assert repr(result) == '<percale.RunResult: finished, 12 steps>'


def test_what_is_found_in_a_run_has_kinds():
    late = {**SCENE, 'event': [{'time': 5.0, 'wind': [1.0, 0.0, 0.0]}]}
    result = percale.run(late)
    (finding,) = [f for f in result.findings if f['kind'] == 'late_events']
    assert finding['severity'] == 'warning' and finding['fix'] == '' and finding['place']
    assert finding['what'] in result.warnings and finding['what'] in result.report['warnings']
    assert result.findings == result.report['findings']
    assert 'late_events' in [f['kind'] for f in percale.plan(late)['findings']]


def test_frames_are_kept_where_they_are_asked_for():
    frames = percale.run(SCENE, frames=True).frames
    assert [frame['index'] for frame in frames] == [0, 1, 2]
    assert [frame['time'] for frame in frames] == pytest.approx([0.0, 0.1, 0.2])
    assert all(frame['intersections'] == 0 and frame['cloths']['towel'].shape == (81, 3) for frame in frames)
    assert np.all(frames[0]['cloths']['towel'][:, 1] == 0.215)
    assert np.array_equal(frames[0]['obstacles']['ball'], frames[2]['obstacles']['ball'])


def test_an_output_folder_is_that_of_the_program(tmp_path, program):
    out = tmp_path / 'out'
    result = percale.run(SCENE, output=out)
    report = json.loads((out / 'report.json').read_text())
    assert report['status'] == 'finished'
    assert (out / 'frames' / 'towel_00002.obj').exists()
    assert len((out / 'steps.csv').read_text().splitlines()) == 13
    assert format(result.state_hash, '016x') in (out / 'steps.csv').read_text().splitlines()[-1]
    assert subprocess.run([program, 'certify', str(out)], check=False, capture_output=True).returncode == 0
    last = percale.read_mesh(out / 'frames' / 'towel_00002.obj')
    assert np.array_equal(last.vertices, percale.run(SCENE, frames=True).frames[2]['cloths']['towel'])


def test_expectations_that_are_not_met_fail_the_check():
    good, bad = percale.check(SCENE, {**SCENE, 'expect': {'lowest_vertex': {'above': 1.0}}})
    assert good.passed
    assert not bad.passed and bad.status == 'finished'
    (expectation,) = bad.expectations
    assert expectation['value'] == bad.measures['lowest_vertex'] and expectation['limit'] == '> 1'
    assert 'failed' in expectation['text']


def test_on_step_sees_every_step_and_may_stop_the_run(tmp_path):
    seen = []

    def on_step(report, view):
        seen.append((report.time, view.time, view.positions('towel'), view.velocities('towel'), view.force_on('ball'),
                     view.state_hash()))
        return len(seen) == 7

    result = percale.run(SCENE, on_step=on_step)
    assert len(seen) == 7 and result.status == 'stopped' and 'stopped' in result.reason and not result.passed
    assert seen[-1][5] == result.state_hash
    assert all(report == view for report, view, *_ in seen)
    assert not np.array_equal(seen[0][2], seen[1][2])


def test_an_error_in_on_step_ends_the_run_and_leaves_no_files(tmp_path):
    kept = []

    def on_step(report, view):
        kept.append(view)
        if len(kept) == 3:
            raise KeyError('mine')

    with pytest.raises(KeyError, match='mine'):
        percale.run(SCENE, output=tmp_path / 'out', on_step=on_step)
    assert not (tmp_path / 'out').exists()
    with pytest.raises(percale.SceneError, match='on_step alone'):
        kept[0].positions('towel')


def test_an_interrupt_ends_a_run_and_leaves_no_files(tmp_path):
    steps = []

    def on_step(report, view):
        steps.append(report)
        if len(steps) == 5:
            _thread.interrupt_main()  # as the key does

    with pytest.raises(KeyboardInterrupt):
        percale.run(SCENE, output=tmp_path / 'out', on_step=on_step)
    assert len(steps) <= 6 and not (tmp_path / 'out').exists()


def test_on_step_is_told_of_names_that_are_not_there():
    with pytest.raises(percale.SceneError, match="no cloth 'towl'.*towel"):
        percale.run(SCENE, on_step=lambda report, view: view.positions('towl'))


def test_plans_and_settings_are_dicts():
    plan = percale.plan(SCENE)
    assert plan['vertices'] == 81
    assert percale.load_scene(SCENE).settings['step']['detector'] == 'fcl'
    scene = percale.load_scene(SCENE, overrides={'duration': 0.7})
    assert (scene.title, scene.duration, scene.file) == ('towel', 0.7, 'scene')
    assert repr(scene) == '<percale.Scene: scene>'


@pytest.mark.parametrize('call, words', [
    (lambda: percale.run('no_such.toml'), ['no_such.toml', 'cannot be read']),
    (lambda: percale.run(3), ['scene', 'int']),
    (lambda: percale.run({}), ['scene', 'empty']),
    (lambda: percale.run({**SCENE, 'cloth': [{**SCENE['cloth'][0], 'fabric': 'shet'}]}), ["'shet'", "did you mean 'sheet'"]),
    (lambda: percale.run({**SCENE, 'cloth': [{**SCENE['cloth'][0], 'pin': [99]}]}), ['99', '0 ... 80']),
    (lambda: percale.run(SCENE, output=''), ['output']),
    (lambda: percale.run(SCENE, on_step=3), ['on_step']),
    (lambda: percale.run(percale.load_scene(SCENE), overrides={'duration': 1.0}), ['overrides', 'load_scene']),
    (lambda: percale.run({**SCENE, 'step': {'start': 'refuse'},
                          'cloth': [{**SCENE['cloth'][0], 'pose': {'translation': [0.0, 0.1, 0.0]}}]}), ['towel', 'ball']),
    (lambda: percale.check(SCENE, overrides={'step.time_step': 7}), ['step.time_step = 7', '1e-7 ... 1'])])
def test_wrong_runs_are_refused_in_words(call, words):
    with pytest.raises(percale.SceneError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)
