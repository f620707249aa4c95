#!/usr/bin/env python3
"""A gripper pulls a cloth over the edge of a table by force feedback.

The cloth lies on a table, its front row in the gripper. Before every step the controller reads the force with which the cloth drags
the table along, as a load cell below it would, and sets the gripper's speed: the nearer the pull is to the limit, the slower. As
the cloth leaves the table friction falls and the gripper speeds up, until nothing is left to pull.
"""
import sys

import numpy as np

import percale

TABLE = np.array([0.6, 0.1, 0.6])  # m
LENGTH, WIDTH, ROWS, COLUMNS = 0.4, 0.2, 33, 17
DENSITY, FRICTION, STEP = 1.0, 0.4, 1 / 120  # kg/m^2, of a heavy towel; s
LIMIT, FASTEST, SMOOTHING = 0.5, 0.4, 0.1  # N, m/s, s


def build():
    simulation = percale.Simulation(time_step=STEP)
    top = TABLE[1] / 2
    table = simulation.add_obstacle(percale.make_box(TABLE), friction=FRICTION, name='table')
    # The front row hangs just over the front edge of the table, at z = TABLE[2] / 2.
    fabric = percale.Fabric(preset='cotton', area_density=DENSITY, thickness=0.004)
    cloth = simulation.add_cloth(percale.make_grid(WIDTH, LENGTH, COLUMNS, ROWS), fabric,
                                 percale.Pose((0, top + 0.0045, TABLE[2] / 2 + 0.02 - LENGTH / 2)), name='towel')
    front = np.arange((ROWS - 1) * COLUMNS, ROWS * COLUMNS)
    simulation.pin(cloth, front)
    return simulation, cloth, table, front


def pull(simulation, cloth, table, front, longest=6.0):
    """Yields (time s, pull N, speed m/s, how far the gripper is m) of every step; the gripper goes out and slightly down."""
    direction = np.array([0.0, -0.2, 1.0]) / np.hypot(0.2, 1.0)
    start = simulation.positions(cloth)[front].copy()
    travelled, smooth, slid = 0.0, 0.0, False
    while simulation.time < longest and not (slid and smooth < 0.01 * LIMIT):
        felt = simulation.force_on(table)[2]
        smooth += (felt - smooth) * STEP / SMOOTHING
        speed = FASTEST * np.clip(1 - smooth / LIMIT, 0.0, 1.0)
        slid = slid or smooth > 0.1 * LIMIT
        travelled += speed * STEP
        simulation.move_pin(cloth, front, start + travelled * direction)
        report = simulation.step()
        if not report.ok:
            sys.exit(report.explanation)
        yield simulation.time, smooth, speed, travelled


def main():
    simulation, cloth, table, front = build()
    weight = 9.81 * simulation.masses(cloth).sum()
    print(f'the towel weighs {weight:.3f} N, so friction on the table is at most {FRICTION * weight:.3f} N while it slides')
    print('time s   pull N   speed m/s   gripper m')
    log = list(pull(simulation, cloth, table, front))
    for time, felt, speed, travelled in log[::30]:
        print(f'{time:6.2f} {felt:8.3f} {speed:11.3f} {travelled:11.3f}')
    z = simulation.positions(cloth)[:, 2]
    print(f'{np.mean(z < TABLE[2] / 2):.0%} of the vertices are still above the table; '
          f'the largest pull was {max(felt for _, felt, *_ in log):.3f} N')


if __name__ == '__main__':
    main()
