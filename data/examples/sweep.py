#!/usr/bin/env python3
"""Runs one scene over many settings, several at a time, and prints a table: sweep.py [JOBS].

The scene is a dict laid out like a scene file. Runs let other threads of Python work, so threads are enough.
"""
import itertools
import sys
from concurrent.futures import ThreadPoolExecutor

import percale

SCENE = {
    'duration': 1.0,
    'step': {'measure': 'all', 'threads': 1},
    'fabric': {'sheet': {'springs': {'structural': 1000.0, 'shear': 500.0, 'bend': 10.0}}},
    'cloth': [{'name': 'sheet', 'fabric': 'sheet', 'grid': {'size': [0.8, 0.8], 'vertices': [21, 21]},
               'pose': {'translation': [0.0, 0.31, 0.0]}}],
    'obstacle': [{'name': 'ball', 'shape': {'sphere': {'radius': 0.3}}, 'friction': 0.3}],
    'expect': {'intersections': 0, 'largest_strain': {'below': 0.2}},
}
STIFFNESS = [100.0, 1000.0, 10000.0]  # N/m
TIME_STEP = [1 / 30, 1 / 60, 1 / 120]  # s


def run(settings):
    stiffness, time_step = settings
    return settings, percale.run(SCENE, overrides={'fabric.sheet.springs.structural': stiffness,
                                                   'fabric.sheet.springs.shear': stiffness / 2, 'step.time_step': time_step})


def main():
    jobs = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    print('structural N/m   time step s   largest strain   lowest m   crossings   CPU s   as expected')
    with ThreadPoolExecutor(jobs) as pool:
        for (stiffness, time_step), result in pool.map(run, itertools.product(STIFFNESS, TIME_STEP)):
            measures = result.measures
            print(f'{stiffness:14g} {time_step:13.5f} {measures["largest_strain"]:16.3f} {measures["lowest_vertex"]:10.3f} '
                  f'{measures["intersections"]:11g} {result.report["cpu_s"]:7.2f}   {"yes" if result.passed else "no"}')


if __name__ == '__main__':
    main()
