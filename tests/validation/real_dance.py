#!/usr/bin/env python3
"""Fetches a dress and a body that dances, of another project, simulates the dress on it, and says how it went.

    tests/validation/real_dance.py build/percale build/real_dance [--seconds 4.8]

The body has 25,472 triangles, all of which move, 121 frames of them, 25 a second; the dress 15,656 vertices, as it hangs on the
first frame, its rest shape the flat panels. What is fetched belongs to others; what is there already is not fetched again.
Every step is certified. Exit code 1 if one crosses the body.
"""

import argparse
import json
import pathlib
import subprocess
import sys

from real_garments import fetch

PLACE = "Projects/FEMShell/input"
FILES = {"ipc-sim/Codim-IPC": [f"{PLACE}/dress_knife/drape.obj", f"{PLACE}/dress_knife/stage.obj"]
         + [f"{PLACE}/Rumba_Dancing/shell{k}.obj" for k in range(121)]}
DRESS_VERTICES = 15656

SCENE = """title = "a dress on a dance"
duration = {seconds}
[step]
time_step = 0.016666666666666666
threads = {threads}
detector = "{detector}"
[fabric.silk]
area_density = 0.15
thickness = 0.002
stretch_stiffness = [300, 300]
bend_stiffness = 2e-6
damping_time = 0.002
{limit}
[[cloth]]
name = "dress"
fabric = "silk"
mesh = "dress.obj"
rest = "panels.obj"
[[seam]]
file = "mesh"
duration = 0.05
[[obstacle]]
name = "body"
mesh = "shell%d.obj"
frames = [0, 120]
fps = 25.0
friction = 0.4
pose = {{ translation = [0, -0.75, 0] }}
[output]
fps = 10.0
[expect]
intersections = 0
largest_strain = {{ below = 10.0 }}
"""


def cut_out(source, target, stitches):
    """The dress alone, of a file that has its vertices first, with the stitches of another."""
    lines = [line for line in source.read_text().splitlines() if line.startswith(("v ", "f "))]
    vertices = [line for line in lines if line[0] == "v"][:DRESS_VERTICES]
    faces = [line for line in lines if line[0] == "f" and max(int(c.split("/")[0]) for c in line.split()[1:]) <= DRESS_VERTICES]
    sewn = [line for line in stitches.read_text().splitlines() if line.startswith("stitch ")]
    target.write_text("\n".join(vertices + faces + sewn) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="where the files go, outside the repository or under build/")
    parser.add_argument("--source", default="https://github.com/{owner}/{name}")
    parser.add_argument("--seconds", type=float, default=4.8)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--detector", default="fcl")
    parser.add_argument("--strain-limit", type=float)
    options = parser.parse_args()
    folder = options.folder
    folder.mkdir(parents=True, exist_ok=True)
    fetch(options.source, folder, FILES)
    for source, target in (("drape.obj", "dress.obj"), ("stage.obj", "panels.obj")):
        cut_out(folder / source, folder / target, folder / "stage.obj")
    limit = f"strain_limit = {options.strain_limit}" if options.strain_limit else ""
    file = folder / "dance.toml"
    file.write_text(SCENE.format(seconds=options.seconds, threads=options.threads, detector=options.detector, limit=limit))
    run = subprocess.run([options.program, "run", str(file), "-o", str(folder / "dance"), "--certify-steps"], check=False)
    report = json.loads((folder / "dance" / "report.json").read_text())
    steps = report["steps"]
    print(f"{steps} steps: {report['cpu_s'] / steps:.3f} CPU s a step, {report['newton_iterations'] / steps:.1f} Newton iterations")
    for stage, seconds in report["stages"].items():
        print(f"  {stage:10} {seconds / steps:.4f} CPU s a step")
    return run.returncode


if __name__ == "__main__":
    sys.exit(main())
