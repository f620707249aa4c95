"""What becomes of threads at the end of the program."""
import subprocess
import sys

import pytest

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
