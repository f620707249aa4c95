"""What calls raise."""
import pytest

import percale
from conftest import SHEET


def test_a_scene_error_is_a_value_error_with_subject_and_reason(ball):
    with pytest.raises(ValueError) as caught:
        ball.simulation.set_friction(ball.ball, 11.0)
    error = caught.value
    assert type(error) is percale.SceneError
    assert error.subject == 'ball'
    assert error.reason in str(error) and '0 ... 10' in error.reason
    assert (error.file, error.line, error.column) == ('', 0, 0)


def test_a_file_error_has_its_place(tmp_path):
    file = tmp_path / 'scene.toml'
    file.write_text('duration = 1.0\n\nstep = { time_stp = 1 }\n')
    with pytest.raises(percale.SceneError) as caught:
        percale.load_scene(file)
    assert (caught.value.file, caught.value.line, caught.value.column) == (str(file), 3, 10)
    assert "did you mean 'time_step'" in str(caught.value)


def test_a_start_error_tells_what_crosses():
    simulation = percale.Simulation(start='refuse')
    simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET)
    ball = simulation.add_obstacle(percale.make_sphere(0.2, 3), name='ball')
    before = simulation.state_hash()
    with pytest.raises(percale.StartError) as caught:
        simulation.step()
    error = caught.value
    assert isinstance(error, percale.SceneError)
    assert error.obstacle == ball.index
    assert error.intersecting_pairs > 0
    assert error.vertices_inside == len(error.inside_vertices) > 0
    assert error.inside_vertex in error.inside_vertices
    assert not error.between_cloths and error.other_cloth_triangle == -1
    assert 'ball' in str(error)
    assert simulation.state_hash() == before


def test_errors_are_documented_and_of_the_package():
    for error in (percale.SceneError, percale.StartError):
        assert error.__module__ == 'percale'
        assert len(error.__doc__) > 80
