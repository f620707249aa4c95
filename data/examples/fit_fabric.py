#!/usr/bin/env python3
"""Finds a bending stiffness from a drape coefficient, as measured by Cusick's test: fit_fabric.py [COEFFICIENT].

A disc of cloth, 30 cm across, hangs over a smaller one of 18 cm. The drape coefficient is the area of its shadow beside what is
not supported: 1 for a board, towards 0 for silk. The stiffness is found by halving an interval of its logarithm; no derivatives.
Without a coefficient one is measured of a stiffness that is then found again.
"""
import sys

import numpy as np

import percale

CLOTH, SUPPORT, RINGS = 0.15, 0.09, 14  # m, m
LOWEST, HIGHEST = 1e-6, 1e-3  # N m


def disc(radius, rings):
    """A mesh of concentric rings, 6 k vertices on ring k; the rim comes last."""
    points, triangles = [[0.0, 0.0, 0.0]], []
    first = [0] + [1 + 3 * k * (k - 1) for k in range(1, rings + 1)]
    for k in range(1, rings + 1):
        angle = 2 * np.pi * np.arange(6 * k) / (6 * k)
        points += (radius * k / rings * np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])).tolist()
        for i in range(6 * k):
            side, place = divmod(i, k)
            inner = [first[k - 1] + (side * (k - 1) + place + j) % max(1, 6 * (k - 1)) for j in (0, -1)]
            outer = [first[k] + i, first[k] + (i + 1) % (6 * k)]
            triangles.append([inner[0], outer[0], outer[1]])
            if place > 0:
                triangles.append([inner[1], outer[0], inner[0]])
    return percale.Mesh(points, triangles)


def drape_coefficient(bend_stiffness):
    """The share of the free ring's area that its shadow covers once the cloth is at rest."""
    mesh = disc(CLOTH, RINGS)
    simulation = percale.Simulation(kinetic_damping=True)
    fabric = percale.Fabric(area_density=0.15, thickness=0.003, stretch_stiffness=[1000.0, 1000.0], bend_stiffness=bend_stiffness)
    cloth = simulation.add_cloth(mesh, fabric, percale.Pose((0, 0.0135, 0)))
    simulation.add_obstacle(percale.make_cylinder(SUPPORT, 0.02, 96), friction=0.5)
    inner = np.flatnonzero(np.linalg.norm(mesh.vertices, axis=1) < 0.3 * SUPPORT)
    simulation.pin(cloth, inner)  # the upper plate of the apparatus
    while simulation.time < 6.0:
        report = simulation.step()
        if not report.ok:
            sys.exit(report.explanation)
        if report.slept:
            break
    z, _, x = simulation.positions(cloth)[-6 * RINGS:].T
    shadow = 0.5 * abs(np.dot(x, np.roll(z, -1)) - np.dot(z, np.roll(x, -1)))
    return (shadow - np.pi * SUPPORT ** 2) / (np.pi * (CLOTH ** 2 - SUPPORT ** 2))


def fit(wanted, rounds=8):
    """The stiffness, N m, with that coefficient: a stiffer cloth covers more."""
    low, high = np.log10([LOWEST, HIGHEST])
    for _ in range(rounds):
        middle = (low + high) / 2
        found = drape_coefficient(10 ** middle)
        print(f'bend_stiffness {10 ** middle:9.3g} N m: drape coefficient {found:.3f}')
        low, high = (middle, high) if found < wanted else (low, middle)
    return 10 ** ((low + high) / 2)


if __name__ == '__main__':
    target = float(sys.argv[1]) if len(sys.argv) > 1 else drape_coefficient(2e-5)
    print(f'wanted: drape coefficient {target:.3f}')
    print(f'found: bend_stiffness = {fit(target):.3g} N m')
