#!/usr/bin/env python3
"""Lets a square sheet fall on a ball until it is at rest, and certifies where it lies: drape.py [PICTURE.png].

Prints how the sheet comes to rest, and the heights of its middle row as bars. With a file name, and matplotlib installed, draws it.
"""
import sys

import numpy as np

import percale

SIZE, COUNT, RADIUS = 0.8, 41, 0.2  # m, vertices a side, m
THICKNESS = 0.005  # m, the gap that cloth keeps


def build():
    simulation = percale.Simulation(time_step=1 / 60, kinetic_damping=True)
    sheet = percale.make_grid(SIZE, SIZE, COUNT, COUNT)
    cloth = simulation.add_cloth(sheet, percale.Fabric(preset='cotton', thickness=THICKNESS),
                                 percale.Pose((0, RADIUS + 2 * THICKNESS, 0)), name='sheet')
    simulation.add_obstacle(percale.make_sphere(RADIUS, 4), friction=0.4, name='ball')
    return simulation, cloth, sheet


def settle(simulation, longest=10.0):
    """Steps until all cloth has been proven at rest, s."""
    while simulation.time < longest:
        report = simulation.step()
        if not report.ok:
            sys.exit(report.explanation)
        if report.slept:
            break
    return simulation.time


def draw(file, positions, triangles):
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    axes = pyplot.figure(figsize=(6, 5)).add_subplot(projection='3d')
    x, y, z = positions.T
    axes.plot_trisurf(x, z, y, triangles=triangles, color='steelblue', edgecolor='none')
    axes.set_aspect('equal')
    pyplot.savefig(file, dpi=120)


def main():
    simulation, cloth, sheet = build()
    time = settle(simulation)
    positions = simulation.positions(cloth)
    certificate = percale.certify((positions, sheet.triangles), percale.make_sphere(RADIUS, 4))
    print(f'at rest after {time:.2f} s; largest strain {100 * simulation.largest_strain():.1f} %, '
          f'lowest vertex {positions[:, 1].min():.3f} m')
    print(f'certificate: {len(certificate.pairs)} intersecting pairs, smallest distance {1000 * certificate.smallest_distance:.2f} mm')
    for x, y, _ in positions.reshape(COUNT, COUNT, 3)[COUNT // 2, ::4]:
        print(f'{x:7.3f} m {y:7.3f} m ' + '#' * int(np.rint(50 * (y - positions[:, 1].min()) / RADIUS / 2)))
    if len(sys.argv) > 1:
        draw(sys.argv[1], positions, sheet.triangles)
    return 0 if certificate.clean else 1


if __name__ == '__main__':
    sys.exit(main())
