"""Python values as scene files have them."""
from pathlib import Path

import numpy as np
import pytest

import percale

SCENE = {
    'duration': 0.05,
    'step': {'time_step': 0.01},
    'fabric': {'sheet': {'springs': {'structural': 1000.0}}},
    'cloth': [{'name': 'flag', 'fabric': 'sheet', 'grid': {'size': [1.0, 1.0], 'vertices': [3, 3]}}],
}


def settings_with(**changes):
    return percale.load_scene({**SCENE, **changes}).settings


@pytest.mark.parametrize('gravity', [[0, -1.5, 0.25], (0, -1.5, 0.25), np.array([0, -1.5, 0.25]), [0, np.float64(-1.5), np.float32(0.25)]])
def test_lists_tuples_and_arrays_are_lists(gravity):
    assert settings_with(gravity=gravity)['gravity'] == [0.0, -1.5, 0.25]


def test_numbers_keep_every_bit():
    step = 0.1 + 0.2 - 0.29
    assert settings_with(step={'time_step': step})['step']['time_step'] == step
    changed = percale.load_scene(SCENE, overrides={'step.time_step': step})
    assert changed.settings['step']['time_step'] == step


def test_flags_and_numbers_of_numpy_are_taken():
    step = settings_with(step={'skip': np.bool_(False), 'newton_iterations': np.int16(7)})['step']
    assert step['skip'] is False
    assert step['newton_iterations'] == 7


@pytest.mark.parametrize('scene, words', [
    ({**SCENE, 'step': {'time_step': '0.01'}}, ['step.time_step', 'a number', 'the text "0.01"']),
    ({**SCENE, 'step': {'skip': 1}}, ['step.skip', 'true or false']),
    ({**SCENE, 'step': {'newton_iterations': 3.5}}, ['step.newton_iterations', '3.5']),
    ({**SCENE, 'step': {'newton_iterations': 2 ** 70}}, ['step.newton_iterations', str(2 ** 70), '64 bits']),
    ({**SCENE, 'step': {'time_step': None}}, ['step.time_step', 'NoneType']),
    ({**SCENE, 'step': {'time_step': 1j}}, ['step.time_step', 'complex']),
    ({**SCENE, 'step': {3: 1}}, ['step', '3', 'str']),
    ({**SCENE, 'cloth': [{**SCENE['cloth'][0], 'pin': [object()]}]}, ['cloth[0].pin[0]', 'object']),
    ({**SCENE, 'stpe': {}}, ["'stpe'", "did you mean 'step'"])])
def test_what_is_no_value_of_a_scene_is_refused_by_its_key(scene, words):
    with pytest.raises(percale.SceneError) as caught:
        percale.load_scene(scene)
    for word in words:
        assert word in str(caught.value)


def test_a_dict_that_holds_itself_is_an_error_and_no_crash():
    scene = dict(SCENE)
    scene['step'] = scene
    with pytest.raises(RecursionError):
        percale.load_scene(scene)


@pytest.mark.parametrize('key, value, found', [
    ('title', 'a "quoted" \\ title', lambda scene: scene.title),
    ('title', 'two\nlines\tand é', lambda scene: scene.title),
    ('gravity', [0.0, -1.62, 0.0], lambda scene: scene.settings['gravity']),
    ('cloth.flag.pin', [0, 2], lambda scene: scene.settings['cloth'][0]['pin'])])
def test_overrides_take_every_value(key, value, found):
    assert found(percale.load_scene(SCENE, overrides={key: value})) == value


def test_overrides_that_lead_nowhere_name_themselves():
    with pytest.raises(percale.SceneError, match=r'overrides\["cloth.flg.pin"\].*flag'):
        percale.load_scene(SCENE, overrides={'cloth.flg.pin': [0]})
    with pytest.raises(percale.SceneError, match='overrides: must be a dict'):
        percale.load_scene(SCENE, overrides='step.time_step=1')


def test_paths_are_texts():
    scene = {**SCENE, 'cloth': [{'name': 'flag', 'fabric': 'sheet', 'mesh': Path('no') / 'such.obj'}]}
    with pytest.raises(percale.SceneError, match='no/such.obj'):
        percale.run(scene)
