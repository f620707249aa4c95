#!/usr/bin/env python3
"""Prints what a step costs more from Python than from C++: tests/python/step_overhead.py [STEPS].

The hanging sheet of 33 x 33 vertices. `cpu_s` of a report is what the C++ step took, all threads; with one thread the rest of the
time of the calling thread is what Python adds: the call, the report, and arrays that are brought up to date where they are held.
Needs the module on PYTHONPATH, or installed. Nothing is asserted.
"""
import statistics
import sys
import time

import percale

SIZE = 33


def overheads(steps, what):
    """us a step beyond the C++ step, in ascending order, with these arrays held; and the median of the C++ step."""
    simulation = percale.Simulation(threads=1)
    cloth = simulation.add_cloth(percale.make_grid(1.0, 1.0, SIZE, SIZE), {'springs': {'structural': 1000.0, 'shear': 500.0, 'bend': 10.0}})
    simulation.pin(cloth, [0, SIZE - 1])
    held = [getattr(simulation, name)(cloth) for name in what]
    differences, costs = [], []
    for _ in range(steps):
        start = time.thread_time()
        report = simulation.step()
        differences.append(1e6 * (time.thread_time() - start - report.cpu_s))
        costs.append(1e6 * report.cpu_s)
    assert len(held) == len(what)
    return sorted(differences), statistics.median(costs)


def main():
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    print(f'hanging sheet of {SIZE} x {SIZE} vertices, {steps} steps, one thread; us a step')
    print(f'{"arrays held":32} {"C++ step":>10} {"median more":>12} {"95 %":>8}')
    for what in ([], ['positions'], ['positions', 'velocities', 'masses']):
        more, cost = overheads(steps, what)
        print(f'{", ".join(what) or "none":32} {cost:10.1f} {statistics.median(more):12.2f} {more[int(0.95 * len(more))]:8.2f}')


if __name__ == '__main__':
    main()
