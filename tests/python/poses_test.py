"""Poses and rotations."""
import math

import numpy as np
import pytest

import percale


def test_a_pose_turns_scales_and_moves():
    pose = percale.Pose((1, 2, 3), percale.rotation_about((0, 0, 5), math.pi / 2), 2.0)
    assert np.allclose(pose.transform([[1, 0, 0], [0, 1, 0]]), [[1, 4, 3], [-1, 2, 3]], atol=1e-15)


def test_a_pose_shows_what_it_was_given():
    pose = percale.Pose(translation=[0.1, 0.2, 0.3], scale=3)
    assert pose.translation.tolist() == [0.1, 0.2, 0.3]
    assert pose.rotation == (1.0, 0.0, 0.0, 0.0)
    assert pose.scale == 3.0
    assert pose == percale.Pose((0.1, 0.2, 0.3), (1, 0, 0, 0), 3.0)
    assert pose != percale.Pose()
    assert repr(pose) == 'Pose(translation=(0.1, 0.2, 0.3), rotation=(1, 0, 0, 0), scale=3)'
    assert eval(repr(pose), {'Pose': percale.Pose}) == pose


@pytest.mark.parametrize('arguments, words', [
    ({'rotation': (2, 0, 0, 0)}, ['rotation', 'length is 2', '0.999 ... 1.001']),
    ({'rotation': (1, 0, 0)}, ['rotation', '(4,)']),
    ({'translation': (0, 0)}, ['translation', '(3,)']),
    ({'translation': (0, np.inf, 0)}, ['translation', 'finite']),
    ({'scale': 0.0}, ['scale', 'above 0']),
    ({'scale': np.nan}, ['scale', 'above 0'])])
def test_wrong_poses_are_refused(arguments, words):
    with pytest.raises(percale.SceneError) as caught:
        percale.Pose(**arguments)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize('pose, words', [
    ({'translatoin': (0, 0, 0)}, ["'translatoin'", "did you mean 'translation'"]),
    ({'scale': 'two'}, ['scale', 'number', '"two"']),
    ((0, 0, 0), ['percale.Pose', 'tuple'])])
def test_what_is_no_pose_is_refused(ball, refused, pose, words):
    refused(ball.simulation, lambda simulation: simulation.move_obstacle(ball.ball, pose), *words)


def test_an_axis_needs_a_length():
    with pytest.raises(percale.SceneError, match='axis'):
        percale.rotation_about((0, 0, 0), 1.0)
