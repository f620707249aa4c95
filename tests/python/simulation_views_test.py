"""What a simulation shows."""
import numpy as np
import pytest

import percale
from conftest import SHEET


@pytest.fixture(scope='module')
def resting():
    """(simulation, cloth, table): a sheet that has come to rest on a box."""
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(percale.make_grid(0.3, 0.3, 9, 9), SHEET, {'translation': (0, 0.106, 0)}, 'towel')
    table = simulation.add_obstacle(percale.make_box((1.0, 0.2, 1.0)), friction=0.5, name='table')
    for _ in range(240):
        assert simulation.step().ok
    return simulation, cloth, table


def test_resting_cloth_presses_with_its_weight(resting):
    simulation, cloth, table = resting
    weight = 9.81 * simulation.masses(cloth).sum()
    assert simulation.force_on(table) == pytest.approx([0, -weight, 0], abs=1e-2 * weight)


def test_contact_loads_are_a_table_whose_sums_are_force_and_torque(resting):
    simulation, cloth, table = resting
    loads = simulation.contact_loads(cloth)
    assert loads.dtype.names == ('vertex', 'obstacle', 'normal', 'friction', 'cloth_point', 'obstacle_point')
    assert len(loads) > 0 and set(loads['obstacle']) == {table.index}
    assert np.all(np.diff(loads['vertex']) > 0)
    forces = loads['normal'] + loads['friction']
    assert simulation.force_on(table) == pytest.approx(-forces.sum(axis=0), abs=1e-12)
    about = np.array([0.3, -0.2, 0.1])
    torque = -np.cross(loads['cloth_point'] - about, forces).sum(axis=0)
    assert simulation.torque_on(table, about) == pytest.approx(torque, abs=1e-12)
    assert np.array_equal(loads['cloth_point'], simulation.positions(cloth)[loads['vertex']])
    assert loads['obstacle_point'][:, 1] == pytest.approx(0.1, abs=1e-9)
    assert np.all(loads['normal'][:, 1] > 0)


def test_impulses_are_kept_on_demand(resting, refused):
    simulation, _, table = resting
    refused(simulation, lambda s: s.impulse_on(table), 'keep_impulses')
    refused(simulation, lambda s: s.angular_impulse_on(table, (0, 0, 0)), 'keep_impulses')
    simulation.keep_impulses()
    assert simulation.impulse_on(table).tolist() == [0, 0, 0]
    assert simulation.step().ok
    impulse = simulation.force_on(table) / 60
    assert simulation.impulse_on(table) == pytest.approx(impulse, abs=1e-12)
    about = np.array([0.3, -0.2, 0.1])
    assert simulation.angular_impulse_on(table, about) == pytest.approx(simulation.torque_on(table, about) / 60, abs=1e-12)
    simulation.keep_impulses(False)
    refused(simulation, lambda s: s.impulse_on(table), 'keep_impulses')


def test_before_the_first_step_nothing_presses(ball):
    assert len(ball.simulation.contact_loads(ball.cloth)) == 0
    assert ball.simulation.force_on(ball.ball).tolist() == [0, 0, 0]


def test_normals_look_up_where_cloth_lies_and_go_into_memory_of_the_callers(resting):
    simulation, cloth, _ = resting
    normals = simulation.normals(cloth)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12) and np.all(normals[:, 1] > 0.9)
    out = np.zeros((81, 3))
    assert simulation.normals(cloth, out=out) is out
    assert np.array_equal(out, normals)


@pytest.mark.parametrize('out', [
    np.zeros((80, 3)), np.zeros((81, 3), np.float32), np.zeros((3, 81)).T, np.zeros(243), [[0.0] * 3] * 81])
def test_memory_that_does_not_fit_is_refused(resting, refused, out):
    simulation, cloth, _ = resting
    refused(simulation, lambda s: s.normals(cloth, out), 'out', 'array')


def test_memory_that_is_read_only_is_refused(resting, refused):
    simulation, cloth, _ = resting
    refused(simulation, lambda s: s.normals(cloth, s.positions(cloth)), 'writable')


def test_positions_between_steps_lie_on_lines(hanging, refused):
    simulation, cloth = hanging
    refused(simulation, lambda s: s.interpolate(0.5, cloth), 'keep_previous_positions')
    simulation.keep_previous_positions()
    before = simulation.positions(cloth).copy()
    simulation.step()
    after = simulation.positions(cloth)
    for fraction in (0.0, 0.25, 1.0):
        assert np.allclose(simulation.interpolate(fraction, cloth), before + fraction * (after - before), atol=1e-15)
    out = np.empty((25, 3))
    assert simulation.interpolate(0.0, cloth, out) is out and np.array_equal(out, before)
    refused(simulation, lambda s: s.interpolate(1.5, cloth), '0 ... 1')
    simulation.keep_previous_positions(False)
    refused(simulation, lambda s: s.interpolate(0.5, cloth), 'keep_previous_positions')


def test_figures_are_those_of_the_arrays(hanging):
    simulation, cloth = hanging
    for _ in range(10):
        simulation.step()
    x, v, m = simulation.positions(cloth), simulation.velocities(cloth), simulation.masses(cloth)
    assert simulation.largest_speed() == pytest.approx(np.linalg.norm(v, axis=1).max(), rel=1e-14)
    free = np.setdiff1d(np.arange(25), [0, 4])
    energy = simulation.energy()
    assert energy.kinetic == pytest.approx(0.5 * (m[free] * (v[free] ** 2).sum(axis=1)).sum(), rel=1e-12)
    assert energy.work == 0.0
    assert simulation.largest_strain() == simulation.largest_strain(cloth) > 0
    assert simulation.largest_strain(cloth=None) == simulation.largest_strain()
    assert simulation.time == pytest.approx(10 / 60)
    assert x.shape == v.shape == (25, 3)


def test_the_state_hash_depends_on_one_bit(hanging):
    simulation, cloth = hanging
    before = simulation.state_hash()
    assert 0 <= before < 2 ** 64
    positions = simulation.positions(cloth).copy()
    positions[12, 1] = np.nextafter(positions[12, 1], 1.0)
    simulation.set_positions(cloth, positions)
    assert simulation.state_hash() != before
