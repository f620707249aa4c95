"""What a simulation is made of, its steps and its saved states."""
import numpy as np
import pytest

import percale
from conftest import SHEET, BallScene


def test_cloth_falls_freely_by_the_law_of_backward_euler():
    simulation = percale.Simulation(time_step=0.01)
    cloth = simulation.add_cloth(percale.make_grid(1, 1, 3, 3), SHEET, {'translation': (0, 2, 0)})
    for n in range(1, 11):
        assert simulation.step().ok
        assert simulation.positions(cloth)[:, 1] == pytest.approx(2 - 9.81 * 1e-4 * n * (n + 1) / 2, abs=1e-12)


def test_poses_place_and_scale_a_cloth():
    simulation = percale.Simulation()
    mesh = percale.make_grid(1, 1, 4, 4)
    pose = percale.Pose((1, 2, 3), percale.rotation_about((1, 1, 0), 0.7), 2.0)
    cloth = simulation.add_cloth(mesh, SHEET, pose)
    assert np.allclose(simulation.positions(cloth), pose.transform(mesh.vertices), atol=1e-15)
    assert simulation.masses(cloth).sum() == pytest.approx(0.2 * 4.0)
    assert simulation.largest_strain() == pytest.approx(0.0, abs=1e-12)


def test_a_rest_shape_apart_from_the_start_pulls_the_cloth_together():
    mesh = percale.Mesh(*percale.make_grid(1, 1, 4, 4))
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(mesh, {'springs': {'structural': 1000.0}}, rest=mesh.vertices / 1.25)
    assert simulation.largest_strain(cloth) == pytest.approx(0.25)
    by_corners = simulation.add_cloth(mesh, {'springs': {'structural': 1000.0}}, {'translation': (0, 3, 0)},
                                      rest=(mesh.vertices / 1.5)[mesh.triangles])
    assert simulation.largest_strain(by_corners) == pytest.approx(0.5)


def test_a_free_mesh_has_a_warp():
    mesh = percale.Mesh(*percale.make_grid(1, 1, 4, 4))
    fabric = percale.Fabric(stretch_stiffness=[500.0, 100.0], shear_stiffness=50.0)
    simulation = percale.Simulation()
    simulation.add_cloth(mesh, fabric, warp=(1, 0, 0))
    with pytest.raises(percale.SceneError, match='warp'):
        simulation.add_cloth(mesh, fabric)


@pytest.mark.parametrize('arguments, words', [
    (('mesh', SHEET), ['towel', 'percale.Mesh', 'str']),
    ((percale.make_grid(1, 1, 3, 3), 'cotton'), ['percale.Fabric', 'str']),
    ((percale.make_grid(1, 1, 3, 3), SHEET, (0, 1, 0)), ['percale.Pose', 'tuple']),
    ((percale.Mesh(*percale.make_grid(1, 1, 3, 3)), SHEET), ['towel', 'shear']),
    ((([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]), {'springs': {'structural': 1.0}}), ['towel', 'area']),
    ((percale.make_grid(1, 1, 3, 3), {'springs': {'structural': 1.0}, 'pressure': 5.0}), ['towel', 'closed'])])
def test_cloth_that_cannot_be_is_refused(ball, refused, arguments, words):
    refused(ball.simulation, lambda s: s.add_cloth(*arguments, name='towel'), *words)
    assert ball.simulation.cloth_count == 1


def test_arguments_that_nobody_takes_are_refused(ball, refused):
    refused(ball.simulation, lambda s: s.add_cloth(percale.make_grid(1, 1, 3, 3), SHEET, wrap=(1, 0, 0)), "'wrap'", 'warp')
    refused(ball.simulation, lambda s: s.add_obstacle(percale.make_plane(), frictoin=0.2), "'frictoin'", 'friction')


@pytest.mark.parametrize('arguments, words', [
    ({'friction': 11.0}, ['floor', 'friction', '0 ... 10']),
    ({'restitution': 2.0}, ['floor', 'restitution', '0 ... 1']),
    ({'restitution': 'none'}, ['floor', 'restitution', 'number', '"none"']),
    ({'deforming': 1}, ['floor', 'deforming', 'True or False']),
    ({'pose': {'scale': -1.0}}, ['scale'])])
def test_obstacles_out_of_range_are_refused(ball, refused, arguments, words):
    refused(ball.simulation, lambda s: s.add_obstacle(percale.make_plane(), name='floor', **arguments), *words)


def test_cloth_and_obstacles_come_and_go(ball, refused):
    simulation = ball.simulation
    second = simulation.add_cloth(percale.make_grid(0.2, 0.2, 4, 4), SHEET, {'translation': (0, 1, 0)}, 'napkin')
    assert simulation.step().ok and simulation.cloth_count == 2
    simulation.remove_cloth(ball.cloth)
    simulation.remove_obstacle(ball.ball)
    assert simulation.step().ok and simulation.cloth_count == 1
    refused(simulation, lambda s: s.positions(ball.cloth), 'was removed')
    refused(simulation, lambda s: s.force_on(ball.ball), 'was removed')
    assert simulation.positions(second).shape == (16, 3)


def test_a_fabric_changes_on_the_way(hanging):
    simulation, cloth = hanging
    for _ in range(60):
        simulation.step()
    strain = simulation.largest_strain()
    simulation.set_fabric(cloth, {'springs': {'structural': 100.0, 'shear': 50.0}})
    assert simulation.largest_strain() == pytest.approx(strain)
    for _ in range(120):
        simulation.step()
    assert simulation.largest_strain() > 5 * strain


@pytest.mark.parametrize('threads', [1, 2])
def test_a_restored_simulation_makes_the_same_steps(threads):
    def step_all(scene, count):
        for _ in range(count):
            assert scene.simulation.step().ok
        return scene.simulation.state_hash()
    first, second = BallScene(threads=1), BallScene(threads=threads)
    step_all(first, 20)
    saved = first.simulation.save()
    assert isinstance(saved, bytes)
    end = step_all(first, 20)
    second.simulation.restore(saved)
    assert second.simulation.time == pytest.approx(20 / 60)
    assert step_all(second, 20) == end


def test_wrong_saved_states_are_refused(ball, hanging, refused):
    saved = ball.simulation.save()
    ball.simulation.step()
    for wrong in (b'', saved[:-1], saved[:40] + bytes([saved[40] ^ 1]) + saved[41:], hanging[0].save()):
        refused(ball.simulation, lambda s, wrong=wrong: s.restore(wrong))
    refused(ball.simulation, lambda s: s.restore('text'), error=TypeError)


def test_a_start_that_is_refused_changes_nothing(refused):
    simulation = percale.Simulation(start='refuse')
    simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, name='towel')
    simulation.add_obstacle(percale.make_sphere(0.2, 3), name='ball')
    for call in (lambda s: s.prepare(), lambda s: s.step()):
        refused(simulation, call, 'towel', 'ball', error=percale.StartError)


def test_reset_puts_a_cloth_back(ball):
    start = ball.simulation.positions(ball.cloth).copy()
    for _ in range(30):
        ball.simulation.step()
    ball.simulation.reset(ball.cloth)
    assert np.array_equal(ball.simulation.positions(ball.cloth), start)
    assert ball.simulation.largest_speed() == 0.0


def test_repair_is_on_demand_too():
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, {'translation': (0, 0.19, 0)})
    ball = simulation.add_obstacle(percale.make_sphere(0.2, 3))
    sphere = percale.make_sphere(0.2, 3)
    assert not percale.certify((simulation.positions(cloth), percale.make_grid(0.5, 0.5, 9, 9).triangles), sphere).clean
    simulation.prepare()
    assert percale.certify((simulation.positions(cloth), percale.make_grid(0.5, 0.5, 9, 9).triangles), sphere).clean
    assert simulation.start_repair()[0].obstacle == ball.index
