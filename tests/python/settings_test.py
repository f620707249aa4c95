"""Settings and fabrics by the tables of scene files."""
import numpy as np
import pytest

import percale

STRETCHED = {'stretch_stiffness': [500.0, 400.0]}


def test_every_setting_is_the_key_of_a_scene_file_with_its_default(source_dir):
    keys = (source_dir / 'scenes' / 'scene_keys.md').read_text()
    settings = percale.Simulation().settings
    for name, option in percale.step_options().items():
        assert f'`{name}`' in keys or f'step.{name}' in keys
        assert option['sentence'] in percale.Simulation.__doc__
        assert name in settings
        assert str(settings[name]).lower() == option['default'] or float(settings[name]) == pytest.approx(float(option['default']))


def extremes():
    """(name, a value out of range, a value in range) of every number and word."""
    for name, option in percale.step_options().items():
        if option['choices']:
            yield name, 'no_such_word', option['choices'][-1]
        elif np.isfinite(option['highest']):
            whole = 'whole' in option['kind']
            yield name, option['highest'] * 2 if not whole else int(option['highest']) * 2, \
                int(option['highest']) if whole else option['highest']


@pytest.mark.parametrize('name, outside, inside', [pytest.param(*each, id=each[0]) for each in extremes()])
def test_every_setting_is_checked_against_its_range(name, outside, inside):
    with pytest.raises(percale.SceneError, match=name):
        percale.Simulation(**{name: outside})
    assert percale.Simulation(**{name: inside}).settings[name] == inside


def test_settings_show_what_was_given():
    settings = percale.Simulation(detector='brute_force', time_step=0.01, gravity=(0, -1.62, 0), wind=[1, 0, 0]).settings
    assert settings['detector'] == 'brute_force'
    assert settings['time_step'] == 0.01
    assert settings['gravity'].tolist() == [0, -1.62, 0]
    assert settings['wind'].tolist() == [1, 0, 0]
    assert percale.Simulation().settings['wind'] is None


def test_automatic_steps_take_the_scheme_of_scene_files():
    assert percale.Simulation(time_step='auto').settings['scheme'] == 'tr_bdf2'
    assert percale.Simulation(time_step='auto', scheme='trapezoid').settings['scheme'] == 'trapezoid'


@pytest.mark.parametrize('arguments, words', [
    ({'time_stp': 0.01}, ["'time_stp'", "did you mean 'time_step'"]),
    ({'gravty': (0, 0, 0)}, ["did you mean 'gravity'"]),
    ({'detector': 'flc'}, ["'flc'", "did you mean 'fcl'", 'brute_force']),
    ({'gravity': (0, 0)}, ['gravity', '(3,)']),
    ({'gravity': (0, np.nan, 0)}, ['gravity']),
    ({'wind': 'north'}, ['wind', 'numbers']),
    ({'time_step': 'fast'}, ['step.time_step', '"fast"'])])
def test_wrong_settings_are_refused(arguments, words):
    with pytest.raises(percale.SceneError) as caught:
        percale.Simulation(**arguments)
    for word in words:
        assert word in str(caught.value)


def test_a_fabric_has_what_was_given_and_defaults():
    fabric = percale.Fabric(area_density=0.3, springs={'structural': 800.0, 'bend': 2.0})
    assert fabric.area_density == 0.3
    assert fabric.springs == {'structural': 800.0, 'shear': 0.0, 'bend': 2.0}
    assert fabric.thickness == float(percale.fabric_options()['thickness']['default'])
    assert fabric.stretch_stiffness is None
    assert fabric == percale.Fabric(**fabric.to_dict())
    assert fabric != percale.Fabric(springs={'structural': 800.0})
    assert 'area_density=0.3' in repr(fabric)


def test_presets_are_fabrics_that_single_keys_override():
    cotton = percale.Fabric(preset='cotton')
    assert percale.fabric_presets()['cotton'] == cotton
    heavy = percale.Fabric(preset='cotton', area_density=2.5)
    assert heavy.area_density == 2.5
    assert heavy.stretch_stiffness == cotton.stretch_stiffness
    even = percale.isotropic(cotton)
    assert even.stretch_stiffness[0] == even.stretch_stiffness[1]


@pytest.mark.parametrize('keys, words', [
    ({}, ['[fabric]', 'springs', 'stretch_stiffness', 'preset']),
    ({'springs': {'structural': 1e10}}, ['fabric.springs.structural', '0 ... 1e9']),
    ({'springs': {'shear': 1.0}}, ['fabric.springs', "lacks 'structural'"]),
    ({**STRETCHED, 'springs': {'structural': 1.0}}, ['springs', 'stretch_stiffness']),
    ({**STRETCHED, 'thicknes': 1.0}, ["did you mean 'thickness'"]),
    ({**STRETCHED, 'spring_damping': 0.1, 'damping_time': 0.1}, ['spring_damping', 'damping_time']),
    ({**STRETCHED, 'pressure': 1.0, 'gas_volume': 1.0}, ['pressure', 'gas_volume']),
    ({'preset': 'coton'}, ["did you mean 'cotton'"])])
def test_wrong_fabrics_are_refused_by_fabric_and_by_dict(hanging, refused, keys, words):
    with pytest.raises(percale.SceneError) as caught:
        percale.Fabric(**keys)
    for word in words:
        assert word in str(caught.value)
    simulation, cloth = hanging
    refused(simulation, lambda s: s.set_fabric(cloth, keys), *words)
    refused(simulation, lambda s: s.add_cloth(percale.make_grid(1, 1, 3, 3), keys), *words)
    assert simulation.cloth_count == 1


def test_former_names_are_a_deprecation_warning():
    with pytest.warns(DeprecationWarning, match='newton_share is called newton_error_ratio'):
        simulation = percale.Simulation(newton_share=0.5)
    assert simulation.settings['newton_error_ratio'] == 0.5
    with pytest.warns(DeprecationWarning, match='DroppedSubsteps'):
        assert percale.DroppedSpans is percale.DroppedSubsteps
    with pytest.raises(AttributeError, match='NoSuchName'):
        percale.NoSuchName
