"""The class itself."""
import pytest

import percale
from conftest import SHEET


def test_ids_compare_and_hash_by_their_number(ball):
    again = percale.Simulation().add_cloth(percale.make_grid(1, 1, 3, 3), SHEET)
    assert ball.cloth == again and hash(ball.cloth) == hash(again)
    other = ball.simulation.add_cloth(percale.make_grid(1, 1, 3, 3), SHEET)
    assert other != ball.cloth and {ball.cloth: 1, other: 2}[other] == 2
    assert repr(other) == '<percale.ClothId 1>'
    assert ball.ball.index == 0


def test_a_cloth_is_not_taken_for_an_obstacle(ball, refused):
    refused(ball.simulation, lambda s: s.force_on(ball.cloth), 'ObstacleId', error=TypeError)
    refused(ball.simulation, lambda s: s.positions(0), 'ClothId', error=TypeError)


def test_obstacles_need_a_detector(refused):
    simulation = percale.Simulation(detector='none')
    simulation.add_cloth(percale.make_grid(1, 1, 3, 3), SHEET)
    refused(simulation, lambda s: s.add_obstacle(percale.make_sphere(0.2), name='ball'), 'ball', 'detector')


def test_settings_follow_what_is_set(hanging):
    simulation, _ = hanging
    simulation.set_gravity((0, -1.62, 0))
    simulation.set_wind((1, 2, 3))
    simulation.set_time_step(0.005)
    simulation.set_work_limit(0)
    settings = simulation.settings
    assert settings['gravity'].tolist() == [0, -1.62, 0] and settings['wind'].tolist() == [1, 2, 3]
    assert settings['time_step'] == 0.005 and settings['work_limit'] == 'auto'
    assert simulation.step().dt == 0.005


@pytest.mark.parametrize('detector', ['fcl', 'bullet', 'brute_force'])
def test_every_detector_makes_the_same_steps(detector):
    def last_hash(kind):
        simulation = percale.Simulation(detector=kind)
        simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, {'translation': (0, 0.215, 0)})
        simulation.add_obstacle(percale.make_sphere(0.2, 3))
        for _ in range(20):
            assert simulation.step().ok
        return simulation.state_hash()
    assert last_hash(detector) == last_hash('fcl')
