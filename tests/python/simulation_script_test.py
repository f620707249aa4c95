"""What the caller prescribes: pins, obstacles, seams, gravity, wind."""
import numpy as np
import pytest

import percale
from conftest import SHEET

NAN = float('nan')
SELF = {**SHEET, 'self_contact': True}


def test_pins_hold_and_move_one_by_one_and_together(hanging):
    simulation, cloth = hanging
    simulation.pin(cloth, 20)
    simulation.pin(cloth, np.array([24, 12]))
    assert simulation.pinned_vertices(cloth).tolist() == [0, 4, 12, 20, 24]
    start = simulation.positions(cloth).copy()
    simulation.step()
    assert np.array_equal(simulation.positions(cloth)[[0, 4, 12, 20, 24]], start[[0, 4, 12, 20, 24]])
    targets = start[[24, 0]] + [0, 0.01, 0]
    simulation.move_pin(cloth, [24, 0], targets)
    simulation.move_pin(cloth, 12, start[12] - [0, 0.01, 0])
    simulation.step()
    assert np.array_equal(simulation.positions(cloth)[[24, 0]], targets)
    assert np.array_equal(simulation.positions(cloth)[12], start[12] - [0, 0.01, 0])
    simulation.unpin(cloth, simulation.pinned_vertices(cloth))
    assert simulation.pinned_vertices(cloth).tolist() == []


WRONG_CALLS = {
    'pin of no vertex': (lambda s, c: s.pin(c, [1, 25]), ['vertex 25', '0 ... 24']),
    'pin below 0': (lambda s, c: s.pin(c, -1), ['vertex -1']),
    'pin twice': (lambda s, c: s.pin(c, [3, 7, 3]), ['vertex 3', 'twice']),
    'pin of numbers': (lambda s, c: s.pin(c, [1.0]), ['pin', 'integers']),
    'pin of a table': (lambda s, c: s.pin(c, [[1, 2]]), ['pin', '(1, 2)', '(n,)']),
    'unpin of what is free': (lambda s, c: s.unpin(c, [0, 1]), ['vertex 1', 'not pinned']),
    'unpin of no vertex': (lambda s, c: s.unpin(c, [0, 99]), ['vertex 99']),
    'move of what is free': (lambda s, c: s.move_pin(c, [0, 1], np.zeros((2, 3))), ['vertex 1', 'not pinned']),
    'move of fewer': (lambda s, c: s.move_pin(c, [0, 4], np.zeros((1, 3))), ['targets', '(1, 3)', '(2, 3)']),
    'move to nowhere': (lambda s, c: s.move_pin(c, [0, 4], [[0, 0, 0], [0, NAN, 0]]), ['finite']),
    'positions of fewer': (lambda s, c: s.set_positions(c, np.zeros((24, 3))), ['cloth', '24', '25']),
    'positions not finite': (lambda s, c: s.set_positions(c, np.full((25, 3), NAN)), ['finite']),
    'velocities not finite': (lambda s, c: s.set_velocities(c, np.full((25, 3), np.inf)), ['finite']),
    'gravity too large': (lambda s, c: s.set_gravity((0, 1e9, 0)), ['gravity']),
    'gravity of two': (lambda s, c: s.set_gravity((0, 1)), ['gravity', '(3,)']),
    'wind not finite': (lambda s, c: s.set_wind((0, NAN, 0)), ['wind']),
    'time step 0': (lambda s, c: s.set_time_step(0.0), ['time_step', '1e-07 ... 1']),
    'time limit': (lambda s, c: s.set_time_limit(-1.0), ['1e-06']),
    'work limit': (lambda s, c: s.set_work_limit(-1), ['work_limit']),
    'teleport of two scales': (lambda s, c: s.teleport([c], [], {'scale': 2.0}), ['teleport', 'scale']),
    'teleport otherwise': (lambda s, c: s.teleport([c], [], None, 'stop'), ["'stop'", 'keep, clear']),
    'seam of nothing': (lambda s, c: s.add_seam(c, c), ['seam', 'at least one']),
    'seam to itself': (lambda s, c: s.add_seam(c, c, [[1, 1]]), ['vertex 1', 'itself']),
    'seam of no vertex': (lambda s, c: s.add_seam(c, c, [[1, 77]]), ['vertex 77']),
    'seam of half vertices': (lambda s, c: s.add_seam(c, c, points=[[1.5, 2, 3, 0.5]]), ['1.5', 'integer']),
    'seam beyond its edge': (lambda s, c: s.add_seam(c, c, points=[[1, 2, 3, 1.5]]), ['share', '1.5']),
    'seam too stiff': (lambda s, c: s.add_seam(c, c, [[1, 2]], stiffness=1e12), ['stiffness']),
    'seam by a word': (lambda s, c: s.add_seam(c, c, [[1, 2]], stiffness='high'), ['stiffness', 'number', '"high"']),
    'seam by a number': (lambda s, c: s.add_seam(c, c, [[1, 2]], weld=1), ['weld', 'True or False']),
    'seam of no name': (lambda s, c: s.add_seam(c, c, [[1, 2]], name=3), ['name', 'str', '3']),
    'seam unknown': (lambda s, c: s.add_seam(c, c, [[1, 2]], stifness=1.0), ["did you mean 'stiffness'"]),
    'pair without contact': (lambda s, c: s.set_pair(c, c, contact=False), ['self_contact']),
    'layer without contact': (lambda s, c: s.set_layer(c, 1), ['self_contact']),
}


@pytest.mark.parametrize('name', WRONG_CALLS)
def test_wrong_calls_say_what_is_wrong_and_change_nothing(hanging, refused, name):
    simulation, cloth = hanging
    for _ in range(3):
        simulation.step()
    call, words = WRONG_CALLS[name]
    refused(simulation, lambda s: call(s, cloth), *words)
    assert simulation.pinned_vertices(cloth).tolist() == [0, 4]


WRONG_MOVES = {
    'scale': (lambda s, b: s.move_obstacle(b, {'scale': 2.0}), ['ball', 'scale']),
    'shape of a rigid one': (lambda s, b: s.deform_obstacle(b, np.zeros((642, 3))), ['ball', 'rigid']),
    'friction': (lambda s, b: s.set_friction(b, -0.1), ['ball', 'friction']),
    'restitution': (lambda s, b: s.set_restitution(b, 1.5), ['ball', 'restitution']),
    'torque': (lambda s, b: s.torque_on(b, (0, NAN, 0)), ['ball', 'finite']),
}


@pytest.mark.parametrize('name', WRONG_MOVES)
def test_wrong_moves_of_obstacles_change_nothing(ball, refused, name):
    call, words = WRONG_MOVES[name]
    refused(ball.simulation, lambda s: call(s, ball.ball), *words)


def test_obstacles_move_carry_and_deform():
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(percale.make_grid(0.3, 0.3, 9, 9), SHEET, {'translation': (0, 0.106, 0)})
    mesh = percale.make_box((1.0, 0.2, 1.0))
    table = simulation.add_obstacle(mesh, friction=0.8, name='table', deforming=True)
    for step in range(60):
        simulation.move_obstacle(table, {'translation': (0.002 * (step + 1), 0, 0)})
        assert simulation.step().ok
    assert simulation.obstacle_pose(table).translation.tolist() == pytest.approx([0.12, 0, 0])
    assert 0.05 < simulation.positions(cloth)[:, 0].mean() <= 0.12
    simulation.deform_obstacle(table, mesh.vertices * [1, 1.05, 1])
    assert simulation.step().ok
    assert np.array_equal(simulation.obstacle_shape(table), mesh.vertices * [1, 1.05, 1])
    simulation.set_friction(table, 0.0)
    simulation.set_restitution(table, 0.5)
    assert simulation.step().ok


def test_seams_close():
    simulation = percale.Simulation(gravity=(0, 0, 0))
    grid = percale.make_grid(1, 1, 3, 3)
    left = simulation.add_cloth(grid, SHEET, {'translation': (-0.55, 0, 0)})
    right = simulation.add_cloth(grid, SHEET, {'translation': (0.55, 0, 0)})
    pairs = [[2, 0], [5, 3]]
    seam = simulation.add_seam(left, right, pairs, points=[[8, 6, 6, 0.0]], over=0.5, stiffness=2000.0, name='middle')
    assert simulation.seam_gaps(seam) == pytest.approx([0.1, 0.1, 0.1])
    for _ in range(120):
        assert simulation.step().ok
    assert np.all(simulation.seam_gaps(seam) < 1e-3)
    assert simulation.plan().springs['seam'] == 3


def test_pairs_and_layers_say_what_meets():
    simulation = percale.Simulation()
    one, other = (simulation.add_cloth(percale.make_grid(1, 1, 3, 3), SELF, {'translation': (0, k, 0)}) for k in range(2))
    assert simulation.meets(one, other) and simulation.meets(one, one)
    simulation.set_pair(one, other, contact=False)
    assert not simulation.meets(one, other)
    simulation.set_pair(one, other, thickness=0.01)
    assert simulation.meets(one, other)
    simulation.set_layer(other, 1)
    with pytest.raises(percale.SceneError, match='-1000 ... 1000'):
        simulation.set_layer(other, 1001)


def test_teleported_cloth_keeps_or_loses_its_velocity(ball):
    simulation, cloth = ball.simulation, ball.cloth
    simulation.step()
    velocities, positions = simulation.velocities(cloth).copy(), simulation.positions(cloth).copy()
    motion = percale.Pose((5, 0, 0), percale.rotation_about((0, 1, 0), np.pi / 2))
    simulation.teleport([cloth], [ball.ball], motion)
    assert np.allclose(simulation.positions(cloth), motion.transform(positions), atol=1e-14)
    assert np.allclose(simulation.velocities(cloth)[:, 1], velocities[:, 1], atol=1e-15)
    assert simulation.obstacle_pose(ball.ball).translation.tolist() == pytest.approx([5, 0, 0])
    simulation.teleport([cloth], [], None, velocities='clear')
    assert not simulation.velocities(cloth).any()


def test_gravity_and_wind_act():
    simulation = percale.Simulation(gravity=(0, 0, 0))
    cloth = simulation.add_cloth(percale.make_grid(1, 1, 5, 5), SHEET)
    simulation.step()
    assert simulation.largest_speed() < 1e-12
    simulation.set_wind((0, 3, 0))
    simulation.step()
    assert np.all(simulation.velocities(cloth)[:, 1] > 0)
    simulation.set_gravity((0, -100, 0))
    simulation.step()
    assert np.all(simulation.velocities(cloth)[:, 1] < 0)
