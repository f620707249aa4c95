"""What becomes of threads at the end of the program, and of steps that Ctrl-C or another thread ends."""
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import percale
from conftest import SHEET

START = '''
import atexit, threading, time
import percale
simulation = percale.Simulation(time_step=1 / 60)
simulation.add_cloth(percale.make_grid(1.0, 1.0, 60, 60), percale.Fabric(preset='cotton'), percale.Pose((0, 0.4, 0)))
'''
SCENE = "{'duration': 1000.0, 'fabric': {'f': {'springs': {'structural': 100.0}}}, 'cloth': [{'name': 'c', 'fabric': 'f', " \
        "'grid': {'size': [1, 1], 'vertices': [20, 20]}}]}"


def ends(tmp_path, text):
    program = tmp_path / 'program.py'
    program.write_text(START + text)
    done = subprocess.run([sys.executable, program], capture_output=True, text=True, timeout=120, check=False)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize('work', ['while True: simulation.step()', f'percale.run({SCENE}, on_step=lambda *seen: None)'])
def test_a_daemon_thread_that_steps_does_not_abort_the_program_at_its_end(tmp_path, work):
    text = f'def work():\n    {work}\nthreading.Thread(target=work, daemon=True).start()\ntime.sleep(0.3)\nprint("ends")\n'
    for _ in range(5):
        assert ends(tmp_path, text) == (0, 'ends\n', '')


def test_what_runs_at_exit_may_still_step(tmp_path):
    text = 'atexit.register(lambda: print(simulation.step().ok))\n'
    assert ends(tmp_path, text) == (0, 'True\n', '')
    later = 'import sys\ndel sys.modules["percale"]\nimport percale\n' + text
    assert ends(tmp_path, later)[0] == 0


def test_a_child_that_is_forked_while_a_thread_steps_ends(tmp_path):
    text = ('import os\ndef work():\n    while True: simulation.step()\nthreading.Thread(target=work, daemon=True).start()\n'
            'for _ in range(20):\n    time.sleep(0.01)\n    child = os.fork()\n    if child == 0: raise SystemExit(0)\n'
            '    os.waitpid(child, 0)\nprint("ends")\n')
    assert ends(tmp_path, text) == (0, 'ends\n', '')


def interrupted_later():
    """As the key does, in a second, by when a step is under way."""
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


LONG_STEP = {'time_step': 1.0, 'newton_tolerance': 1e-10, 'scheme': 'backward_euler'}  # takes a minute


def test_an_interrupt_ends_a_run_within_a_step(tmp_path):
    long = {'duration': 10.0, 'step': LONG_STEP, 'fabric': {'sheet': SHEET},
            'cloth': [{'name': 'towel', 'fabric': 'sheet', 'grid': {'size': [1.0, 1.0], 'vertices': [401, 401]}, 'pin': [0, 400]}]}
    timer, begun = interrupted_later(), time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        percale.run(long, output=tmp_path / 'out')
    timer.join()
    assert time.monotonic() - begun < 30 and not (tmp_path / 'out').exists()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def long_step():
    simulation = percale.Simulation(**LONG_STEP)
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, 401, 401), SHEET)
    simulation.pin(cloth, [0, 400])
    return simulation


def test_an_interrupt_ends_a_step_and_nothing_has_moved():
    simulation = long_step()
    before = simulation.state_hash()
    timer = interrupted_later()
    with pytest.raises(KeyboardInterrupt):
        simulation.step()
    timer.join()
    assert simulation.state_hash() == before
    simulation.set_time_step(1e-4)
    assert simulation.step().ok


def test_a_handler_of_the_host_gets_its_signal_and_the_step_goes_on():
    simulation, heard = percale.Simulation(), []
    simulation.add_cloth(percale.make_grid(1.0, 1.0, 101, 101), SHEET)
    before = signal.signal(signal.SIGINT, lambda number, frame: heard.append(number))
    timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        while not heard:
            assert simulation.step().ok
    finally:
        signal.signal(signal.SIGINT, before)
        timer.join()


@pytest.mark.parametrize('wish', ['SIG_DFL', 'SIG_IGN'])
def test_what_a_host_makes_of_the_signal_in_on_step_stays(wish):
    scene = {'duration': 0.1, 'fabric': {'sheet': SHEET}, 'cloth': [{'name': 'towel', 'fabric': 'sheet',
                                                                     'grid': {'size': [1.0, 1.0], 'vertices': [5, 5]}}]}
    before = signal.getsignal(signal.SIGINT)
    try:
        percale.run(scene, on_step=lambda *told: signal.signal(signal.SIGINT, getattr(signal, wish)) and None)
        assert signal.getsignal(signal.SIGINT) is getattr(signal, wish)
        if wish == 'SIG_IGN':
            os.kill(os.getpid(), signal.SIGINT)  # nothing
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_signal_that_was_ignored_beside_python_stays_so():
    ends = ('import ctypes, os, signal, percale\nctypes.CDLL(None).signal(int(signal.SIGINT), 1)\nsimulation = percale.Simulation()\n'
            "simulation.add_cloth(percale.make_grid(1.0, 1.0, 5, 5), {'springs': {'structural': 100.0}})\n"
            'assert simulation.step().ok\nos.kill(os.getpid(), signal.SIGINT)\nassert simulation.step().ok\n')
    assert subprocess.run([sys.executable, '-c', ends], check=False, timeout=120).returncode == 0


def test_an_interrupt_ends_a_certificate():
    fine = percale.make_grid(1.0, 1.0, 700, 700)
    timer = interrupted_later()
    with pytest.raises(KeyboardInterrupt):
        while True:
            percale.certify_cloth(fine)
    timer.join()


def test_an_interrupt_ends_the_repair_of_a_start(tmp_path):
    through = {'duration': 1.0, 'fabric': {'sheet': {**SHEET, 'self_contact': True}}, 'obstacle': [
        {'name': 'ball', 'shape': {'sphere': {'radius': 0.3}}}], 'cloth': [
        {'name': 'towel', 'fabric': 'sheet', 'grid': {'size': [1.6, 1.6], 'vertices': [250, 250]}}]}
    timer, begun = interrupted_later(), time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        percale.run(through, output=tmp_path / 'out')
    timer.join()
    assert time.monotonic() - begun < 30 and not (tmp_path / 'out').exists()


def test_another_thread_cancels_a_step():
    simulation = long_step()
    timer = threading.Timer(1.0, simulation.set_cancel, (True,))
    timer.start()
    report = simulation.step()
    timer.join()
    assert not report.ok and report.status == simulation.step().status == 'cancelled'
    simulation.set_cancel(False)
    simulation.set_time_step(1e-4)
    assert simulation.step().ok
