#!/usr/bin/env python3
"""Cloth that starts through cloth, of other projects: fetched, untangled, stepped for a tenth of a second, and how it ended.

    tests/validation/real_tangles.py build/percale build/real_garments

DiffCloth's dress, a mesh that crosses itself, and two T-shirts of SNUG, the second moved by 5 mm so that they interleave. As in
real_garments.py nothing of what is fetched belongs to this project. Exit code 1 if one was neither untangled nor refused by name
in 10 wall seconds, or crosses later.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

from real_garments import fetch

FILES = {"isantesteban/snug": ["assets/meshes/tshirt.obj"], "omegaiota/DiffCloth": ["src/assets/meshes/remeshed/dress-v7k-f14k.obj"]}
LIMIT_S, RUN_LIMIT_S = 10.0, 300.0

# name: keys of each cloth
TANGLES = {
    "dress (DiffCloth) through itself": ['mesh = "dress-v7k-f14k.obj"\npose = { scale = 0.01 }'],
    "two T-shirts (SNUG), 5 mm apart": [
        'mesh = "tshirt.obj"\nlayer = 0',
        'mesh = "tshirt.obj"\nlayer = 1\npose = { translation = [0.005, 0.001, 0.003] }'],
}


def scene(name, cloths):
    text = f'''title = "{name}"
duration = 0.1
gravity = [0.0, 0.0, 0.0]

[step]
time_step = 0.016666666666666666

[fabric.cloth]
preset = "cotton"
thickness = 0.001
self_contact = true
'''
    for number, keys in enumerate(cloths):
        text += f'\n[[cloth]]\nname = "cloth_{number}"\nfabric = "cloth"\n{keys}\n'
    return text + "\n[expect]\nintersections = 0\n"


def timed(command):
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=RUN_LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        done = subprocess.CompletedProcess(command, 1, "", f"took longer than {RUN_LIMIT_S:g} s")
    return done, time.monotonic() - start


def last_line(text):
    return text.strip().splitlines()[-1] if text.strip() else "no message"


def untangle(program, folder, name, cloths):
    number = list(TANGLES).index(name) + 1
    file, out = folder / f"tangle_{number}.toml", folder / f"tangle_{number}"
    file.write_text(scene(name, cloths))
    plan, start_s = timed([program, "plan", str(file)])
    if plan.returncode == 2 and "starts through" in plan.stderr:
        print(f"{name:34} refused in {start_s:.1f} s: {last_line(plan.stderr)}")
        return start_s <= LIMIT_S
    run, run_s = timed([program, "run", str(file), "-o", str(out)])
    if plan.returncode != 0 or run.returncode != 0:
        print(f"{name:34} {last_line(plan.stderr + run.stderr)}")
        return False
    report = json.loads((out / "report.json").read_text())
    moved = report["start_repair"]
    crossing = sum(1 for frame in report["frames"] if frame["intersections"] > 0)
    print(f"{name:34} untangled in {start_s:4.1f} s: {sum(part['vertices_moved'] for part in moved)} vertices moved, the farthest by "
          f"{1e3 * max((part['largest_move'] for part in moved), default=0.0):.1f} mm; then {report['steps']} steps in {run_s - start_s:.1f} s,"
          f" {report['newton_iterations']} Newton and {report['linear_iterations']} linear iterations; {crossing} of "
          f"{len(report['frames'])} frames cross")
    return bool(moved) and start_s <= LIMIT_S and crossing == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="where the files go, outside the repository or under build/")
    parser.add_argument("--source", default="https://github.com/{owner}/{name}")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    fetch(options.source, options.folder, FILES)
    program = str(pathlib.Path(options.program).resolve())
    ends = [untangle(program, options.folder, name, cloths) for name, cloths in TANGLES.items()]
    return 0 if all(ends) else 1


if __name__ == "__main__":
    sys.exit(main())
