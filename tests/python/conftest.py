"""What tests of the Python module share."""
import os
import subprocess
from pathlib import Path

import pytest

import percale

SHEET = {'springs': {'structural': 1000.0, 'shear': 500.0, 'bend': 10.0}}


class BallScene:
    """A sheet of 9 x 9 vertices 1 cm above a ball."""

    def __init__(self, **settings):
        self.simulation = percale.Simulation(**settings)
        self.cloth = self.simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, {'translation': (0, 0.215, 0)}, 'towel')
        self.ball = self.simulation.add_obstacle(percale.make_sphere(0.2, 3), name='ball')


@pytest.fixture
def ball():
    return BallScene()


@pytest.fixture
def hanging():
    """(simulation, cloth): a sheet of 5 x 5 vertices held at two corners."""
    simulation = percale.Simulation()
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, 5, 5), SHEET)
    simulation.pin(cloth, [0, 4])
    return simulation, cloth


@pytest.fixture(scope='session')
def program():
    return os.environ['PERCALE_PROGRAM']


@pytest.fixture(scope='session')
def source_dir():
    return Path(os.environ['PERCALE_SOURCE_DIR'])


@pytest.fixture(scope='session')
def hash_of_program(program):
    """A function: the state hash with which the program ends a run of a scene file; arguments as on the command line."""
    def state_hash(scene, *arguments):
        done = subprocess.run([program, 'check', str(scene), '--replay-hash', *arguments], capture_output=True, text=True, check=False)
        words = [line.split() for line in done.stdout.splitlines() if 'state_hash' in line]
        assert words, done.stdout + done.stderr
        return int(words[0][1], 16)
    return state_hash


@pytest.fixture
def refused():
    """A function: that a call raises SceneError with these words and leaves a simulation as it was."""
    def check(simulation, call, *words, error=percale.SceneError):
        before = simulation.state_hash(), simulation.save()
        with pytest.raises(error) as caught:
            call(simulation)
        for word in words:
            assert word in str(caught.value)
        assert (simulation.state_hash(), simulation.save()) == before
    return check
