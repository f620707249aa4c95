"""Reports of steps, and plans."""
import math

import numpy as np

import percale
from conftest import SHEET, BallScene


def test_a_report_tells_of_a_good_step(ball):
    report = ball.simulation.step()
    assert report.ok and report.status in ('ok', 'halved')
    assert report.time == ball.simulation.time == report.dt > 0
    assert report.newton_iterations > 0
    assert report.linear_solver == 'cg'
    assert report.status in report.explanation or 'step' in report.explanation
    assert report.explanation in repr(report)
    assert report.blocked_cloth == -1 and report.blocked_name == ''
    assert report.pinching == [-1, -1]
    assert report.dropped.total == report.halvings + report.rejected
    assert report.cpu_s >= report.stages.solve >= 0
    assert math.isnan(report.energy.total) and math.isnan(report.largest_strain)


def test_measured_steps_have_energy_and_the_ledger_closes():
    scene = BallScene(measure='ledger')
    before = scene.simulation.energy().total
    for _ in range(10):
        report = scene.simulation.step()
        energy = report.energy
        change = energy.total - before + energy.dissipated - energy.residual_work - energy.work
        assert abs(change - energy.imbalance) < 1e-12
        assert abs(energy.imbalance) < 1e-9
        before = energy.total
    assert report.largest_speed == scene.simulation.largest_speed()
    assert report.largest_strain == scene.simulation.largest_strain()
    assert energy.total == energy.kinetic + energy.gravity + energy.elastic + energy.contact


def test_a_failed_step_says_why_and_leaves_all_as_it_was(ball):
    simulation = ball.simulation
    simulation.step()
    simulation.pin(ball.cloth, 40)
    before = simulation.positions(ball.cloth).copy()
    simulation.move_pin(ball.cloth, 40, (0, -0.1, 0))
    report = simulation.step()
    assert not report.ok
    assert report.status == 'pin_blocked'
    assert report.blocked_vertex == 40 and report.blocked_name == 'towel'
    assert report.blocking_obstacle == ball.ball.index and report.blocking_name == 'ball'
    assert 'towel' in report.explanation and 'ball' in report.explanation
    assert np.array_equal(simulation.positions(ball.cloth), before)


def test_work_limits_end_a_step(ball):
    ball.simulation.set_work_limit(1)
    for _ in range(60):
        report = ball.simulation.step()
        if not report.ok:
            break
    assert report.status == 'work_limit'
    assert ball.simulation.settings['work_limit'] == 1


def test_a_plan_counts_what_there_is(ball):
    ball.simulation.pin(ball.cloth, [0, 8])
    plan = ball.simulation.plan()
    assert (plan.vertices, plan.pinned_vertices, plan.obstacles) == (81, 2, 1)
    assert plan.obstacle_triangles == 1280
    assert plan.springs['structural'] == 2 * 9 * 8 and plan.springs['shear'] == 2 * 8 * 8 and plan.springs['bend'] == 2 * 9 * 7
    assert plan.scheme == 'backward_euler' and plan.stable_step == math.inf
    assert plan.memory_bytes > 0 and plan.evaluations_a_step > 0
    assert ('drag of the air', 'no wind was ever set') in plan.skipped
    stiff = percale.Simulation(scheme='rk4')
    stiff.add_cloth(percale.make_grid(1, 1, 9, 9), SHEET)
    (warning,) = stiff.plan().warnings
    assert warning.startswith('time_step ') and 'longest stable one of rk4' in warning


def test_repairs_of_a_start_are_told():
    simulation = percale.Simulation()
    simulation.add_cloth(percale.make_grid(0.5, 0.5, 9, 9), SHEET, {'translation': (0, 0.19, 0)}, 'towel')
    ball = simulation.add_obstacle(percale.make_sphere(0.2, 3), name='ball')
    simulation.prepare()
    (move,) = simulation.start_repair()
    assert (move.cloth, move.obstacle, move.cloth_name, move.obstacle_name) == (0, ball.index, 'towel', 'ball')
    assert move.vertices_moved > 0 and 0.01 < move.largest_move < 0.1
