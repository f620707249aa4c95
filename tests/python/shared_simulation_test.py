"""Arrays that show a simulation, and threads."""
import gc
import threading
import weakref

import numpy as np
import pytest

import percale
from conftest import SHEET, BallScene

SHOWN = ['positions', 'velocities', 'masses']


def view(simulation, what, cloth):
    return getattr(simulation, what)(cloth)


@pytest.mark.parametrize('what', SHOWN)
def test_calls_give_the_same_memory_read_only(ball, what):
    first, second = (view(ball.simulation, what, ball.cloth) for _ in range(2))
    assert np.shares_memory(first, second)
    assert first.shape == ((81,) if what == 'masses' else (81, 3)) and first.dtype == np.float64
    assert first.flags.c_contiguous and not first.flags.writeable
    with pytest.raises(ValueError):
        first[0] = 1.0
    with pytest.raises(ValueError):
        first.flags.writeable = True


def test_what_is_held_follows_every_step(hanging):
    simulation, cloth = hanging
    positions, velocities, corner = simulation.positions(cloth), simulation.velocities(cloth), simulation.positions(cloth)[12]
    for _ in range(5):
        before = positions.copy()
        simulation.step()
        assert np.array_equal(corner, positions[12]) and not np.array_equal(corner, before[12])
        assert np.allclose(velocities, (positions - before) * 60, rtol=1e-9, atol=1e-12)  # backward Euler
        assert np.array_equal(simulation.positions(cloth), positions)


@pytest.mark.parametrize('change', [
    lambda s, cloth: s.set_positions(cloth, np.zeros((25, 3)) + np.arange(25)[:, None]),
    lambda s, cloth: s.teleport([cloth], [], {'translation': (0, 5, 0)}),
    lambda s, cloth: (s.step(), s.reset(cloth))], ids=['set_positions', 'teleport', 'reset'])
def test_what_is_held_follows_every_other_change(hanging, change):
    simulation, cloth = hanging
    simulation.step()
    positions, velocities = simulation.positions(cloth), simulation.velocities(cloth)
    before = positions.copy()
    change(simulation, cloth)
    assert not np.array_equal(positions, before)
    saved = simulation.save()
    fresh = percale.Simulation()
    other = fresh.add_cloth(percale.make_grid(1.0, 1.0, 5, 5), SHEET)
    fresh.pin(other, [0, 4])
    fresh.restore(saved)
    assert np.array_equal(fresh.positions(other), positions)
    assert np.array_equal(fresh.velocities(other), velocities)


def test_masses_follow_the_fabric(hanging):
    simulation, cloth = hanging
    masses = simulation.masses(cloth)
    total = masses.sum()
    simulation.set_fabric(cloth, {**SHEET, 'area_density': 0.4})
    assert masses.sum() == pytest.approx(2 * total)


def test_what_is_held_outlives_cloths_that_come_and_go(hanging):
    simulation, cloth = hanging
    positions = simulation.positions(cloth)
    others = [simulation.add_cloth(percale.make_grid(1.0, 1.0, 40, 40), SHEET, {'translation': (0, k, 0)}) for k in range(1, 20)]
    simulation.step()
    assert np.array_equal(positions, simulation.positions(cloth))
    simulation.remove_cloth(others[0])
    simulation.step()
    assert np.array_equal(positions, simulation.positions(cloth))
    last = positions.copy()
    simulation.remove_cloth(cloth)
    simulation.step()
    assert np.array_equal(positions, last)
    with pytest.raises(percale.SceneError, match='cloth 0 was removed'):
        simulation.positions(cloth)


def test_what_is_held_outlives_the_simulation():
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, 5, 5), SHEET)
    positions, kept = simulation.positions(cloth), simulation.positions(cloth).copy()
    gone = weakref.ref(simulation)
    del simulation
    gc.collect()
    assert gone() is None
    assert np.array_equal(positions, kept)


def test_memory_does_not_grow_with_calls(hanging):
    simulation, cloth = hanging
    held = {simulation.positions(cloth).ctypes.data for _ in range(100)}
    assert len(held) == 1


def hashes(steps, started=None):
    scene = BallScene()
    if started:
        started.wait()
    found = []
    for _ in range(steps):
        scene.simulation.step()
        found.append(scene.simulation.state_hash())
    return found


def test_simulations_in_threads_make_the_steps_that_they_make_alone():
    alone = hashes(30)
    started, found = threading.Barrier(4), [None] * 4

    def work(number):
        found[number] = hashes(30, started)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [alone] * 4


def test_a_simulation_that_steps_refuses_other_threads_and_lets_them_run():
    # Thousands of parts in one step: half a second or so.
    simulation = percale.Simulation(time_step='auto', tolerance=1e-4, scheme='backward_euler')
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, 33, 33), SHEET)
    simulation.pin(cloth, [0, 32])
    positions = simulation.positions(cloth)
    start = positions.copy()
    thread = threading.Thread(target=simulation.step)
    thread.start()
    refusals, seen = 0, []
    while thread.is_alive():
        seen.append(np.array_equal(positions, start) or not thread.is_alive())
        try:
            simulation.positions(cloth)
        except RuntimeError as error:
            assert 'another thread' in str(error)
            refusals += 1
    thread.join()
    assert refusals > 0 and all(seen[:refusals])
    assert np.array_equal(simulation.positions(cloth), positions)
