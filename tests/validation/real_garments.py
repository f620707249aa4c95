#!/usr/bin/env python3
"""Fetches seven garments of other projects, dresses their bodies in them, and says how each ended.

    tests/validation/real_garments.py build/percale build/real_garments

Nothing of what it fetches belongs to this project, and some of it may be used for tests only. --source says where repositories
are: an address, or the folder of a copy, with {owner} and {name} in it. What is there already is not fetched again.

Columns: vertices; how it ended; simulated and CPU seconds; Newton iterations a step; frames that cross (the body or itself);
gap of 95 % of the stitches and of all, mm, of the widest seam; largest strain of an edge. Exit code 1 if one is not at rest
or crosses, but for what may tremble on.
"""

import argparse
import json
import math
import pathlib
import re
import subprocess
import sys

FILES = {
    "isantesteban/snug": ["assets/meshes/tshirt.obj", "assets/meshes/pants.obj"],
    "isantesteban/vto-garment-collisions": ["assets/meshes/body.obj"],
    "omegaiota/DiffCloth": ["src/assets/meshes/remeshed/skirt7271.obj"],
    "maria-korosteleva/GarmentCode": ["assets/bodies/mean_all.obj"] + [
        f"assets/Patterns/{name}_specification.json" for name in ("dress_pencil", "shirt_mean", "hoody_mean")],
    "ipc-sim/Codim-IPC": ["Projects/FEMShell/input/dress_knife/stage.obj", "Projects/FEMShell/input/Rumba_Dancing/shell0.obj"],
}

SEWN = "duration = 2.0\nstiffness = 3000.0\ncontact_while_closing = false\nweld = true\n"
SEWN_IN_CONTACT = "duration = 1.0\nstiffness = 200.0\nweld = true\n"  # what crosses in pleats would not be untangled
# name: (garment, body, further keys of the cloth, of the body, of its seams, of steps)
GARMENTS = {
    "t-shirt (SNUG)": ("tshirt.obj", "body.obj", "", "", None, ""),
    "pants (SNUG)": ("pants.obj", "body.obj", "", "", None, ""),
    "skirt (DiffCloth), 1.4 times as large": (
        "skirt7271.obj", "mean_all.obj", "pose = { translation = [0, -0.42, 0], scale = 1.4 }\n", "", None, ""),
    "dress_pencil (GarmentCode)": ("dress_pencil_specification.json", "mean_all.obj", "", "", SEWN, ""),
    "shirt_mean (GarmentCode)": ("shirt_mean_specification.json", "mean_all.obj", "", "", SEWN, ""),
    "hoody_mean (GarmentCode)": ("hoody_mean_specification.json", "mean_all.obj", "", "", SEWN, ""),
    "dress (Codim-IPC): may tremble on": (
        "dress_start.obj", "shell0.obj", 'rest = "stage.obj"\n', "pose = { translation = [0, -0.75, 0] }\n", SEWN_IN_CONTACT,
        "newton_error_ratio = 2.0\n"),
}


def fetch(source, folder, wanted=FILES):
    for repository, files in wanted.items():
        missing = [file for file in files if not (folder / pathlib.Path(file).name).exists()]
        if not missing:
            continue
        owner, name = repository.split("/")
        place = source.format(owner=owner, name=name)
        if "://" in place:
            copy = folder / f"{owner}+{name}"
            command = ["git", "clone", "--depth", "1", "--filter=blob:none", "--no-checkout", place, str(copy)]
            if not copy.exists() and subprocess.run(command, check=False).returncode != 0:
                sys.exit(f"{place}: cannot be fetched")
            place = str(copy)
        for file in missing:
            show = subprocess.run(["git", "-C", place, "show", f"HEAD:{file}"], capture_output=True, check=False)
            if show.returncode != 0:
                sys.exit(f"{place}: no {file}: {show.stderr.decode().strip()}")
            (folder / pathlib.Path(file).name).write_bytes(show.stdout)


def read_obj(file):
    vertices, faces, stitches = [], [], []
    for line in file.open():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(x) for x in words[1:4]])
        elif words[0] == "f":
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
        elif words[0] == "stitch":
            stitches.append(line)
    return vertices, faces, stitches


def panels_of(count, faces):
    """The vertices of each connected piece."""
    root = list(range(count))

    def find(i):
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        return i

    for face in faces:
        for corner in face[1:]:
            root[find(corner)] = find(face[0])
    pieces = {}
    for i in range(count):
        pieces.setdefault(find(i), []).append(i)
    return list(pieces.values())


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def minus(a, b, factor=1.0):
    return [x - factor * y for x, y in zip(a, b)]


def bend_around(points, normal, axis, centre, turn):
    """Flat points around a cylinder: without strain, all of their breadth over an angle of `turn`."""
    if normal[1] < 0.0:
        normal = minus([0.0, 0.0, 0.0], normal)
    axis = unit(minus(axis, normal, dot(axis, normal)))
    side = cross(normal, axis)
    across = [dot(x, side) for x in points]
    middle, radius = 0.5 * (min(across) + max(across)), (max(across) - min(across)) / turn
    bent = []
    for x, w in zip(points, across):
        along, angle = dot(minus(x, centre), axis), (w - middle) / radius
        bent.append([c + along * a + radius * (math.cos(angle) * n + math.sin(angle) * s)
                     for c, a, n, s in zip(centre, axis, normal, side)])
    return bent


def middle_of(points):
    """Of their box."""
    return [0.5 * (min(x) + max(x)) for x in zip(*points)]


def make_dress_start(folder):
    """The panels of stage.obj, turned to y up, with sleeves bent around the arms: flat above them they would close there."""
    vertices, faces, stitches = read_obj(folder / "stage.obj")
    body = [[x, y - 0.75, z] for x, y, z in read_obj(folder / "shell0.obj")[0]]
    vertices = [[x, z, -y] for x, y, z in vertices]
    for panel in panels_of(len(vertices), faces):
        points = [vertices[i] for i in panel]
        if min(abs(x[0]) for x in points) < 0.1:
            continue
        side = math.copysign(1.0, points[0][0])
        slices = [middle_of([x for x in body if abs(x[0] - side * at) < 0.012 and x[1] > 0.3]) for at in (0.16, 0.3)]
        first = set(panel)
        corner = [vertices[i] for i in next(face for face in faces if face[0] in first)]
        normal = unit(cross(minus(corner[1], corner[0]), minus(corner[2], corner[0])))
        bent = bend_around(points, normal, unit(minus(slices[1], slices[0])), middle_of(slices), math.radians(300.0))
        for i, x in zip(panel, bent):
            vertices[i] = x
    with (folder / "dress_start.obj").open("w") as out:
        out.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices)
        out.writelines("f " + " ".join(str(corner + 1) for corner in face) + "\n" for face in faces)
        out.writelines(stitches)


def scene(garment, body, cloth_keys, body_keys, seam_keys, step_keys, options):
    is_pattern = garment.endswith(".json")
    text = f'''title = "{garment} on {body}"
duration = "rest"
gravity = [0.0, {0.0 if seam_keys is not None else -9.81}, 0.0]

[step]
time_step = 0.016666666666666666
kinetic_damping = true
rest_speed = 0.0002
{step_keys}
[fabric.cloth]
preset = "{options.fabric}"
thickness = {options.thickness}
self_contact = true
damping_time = 0.02

[[cloth]]
name = "garment"
fabric = "cloth"
{"pattern" if is_pattern else "mesh"} = "{garment}"
{cloth_keys}
[[obstacle]]
name = "body"
mesh = "{body}"
friction = 0.4
{body_keys}'''
    if seam_keys is not None:
        text += f'''
[[seam]]
file = "mesh"
{seam_keys}
[[event]]
time = {re.search("duration = ([0-9.]+)", seam_keys)[1]}
gravity = [0.0, -9.81, 0.0]
'''
    return text + "\n[expect]\nintersections = 0\nlargest_strain = { below = 10.0 }\n"  # so that strain is measured


def gap_mm(report, key):
    gaps = [seam[key] for seam in report.get("seams", []) if seam.get(key) is not None]
    return f"{1e3 * max(gaps):.3g}" if gaps else "-"


def dress(program, folder, name, options):
    number = list(GARMENTS).index(name) + 1
    file = folder / f"garment_{number}.toml"
    file.write_text(scene(*GARMENTS[name], options))
    out = folder / f"garment_{number}"
    try:
        run = subprocess.run([program, "run", str(file), "-o", str(out), "--threads", str(options.threads)], capture_output=True,
                             text=True, timeout=options.limit, check=False)
    except subprocess.TimeoutExpired:
        print(f"{name:38} took longer than {options.limit:g} s", flush=True)
        return "bad"
    report_file = out / "report.json"
    error = run.stderr.strip().splitlines()[-1] if run.stderr.strip() else ""
    if not report_file.exists():
        print(f"{name:38} {error}", flush=True)
        return "bad"
    report = json.loads(report_file.read_text())
    crossing = sum(1 for frame in report["frames"] if frame["intersections"] > 0)
    at_rest = run.returncode == 0 and report["rest"]["at_rest"]
    last = sorted((out / "frames").glob("garment_*.obj"))[-1]
    vertices = sum(1 for line in last.open() if line.startswith("v "))
    print(f"{name:38} {vertices:6} vertices  {'at rest' if at_rest else 'NOT at rest':11} {report['simulated_s']:6.2f} s simulated"
          f" {report['cpu_s']:7.1f} CPU s  {report['newton_iterations'] / max(1, report['steps']):5.1f} Newton a step"
          f"  {crossing} of {len(report['frames'])} frames cross  gap {gap_mm(report, 'gap_of_95_percent')} /"
          f" {gap_mm(report, 'largest_gap')} mm  strain {100 * report['largest_strain']:.3g} %", flush=True)
    if not at_rest:
        print(f"    {error}", flush=True)
    if crossing > 0 or not (at_rest or "not at rest" in error):
        return "bad"
    return "at rest" if at_rest else "moves"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="where the files go, outside the repository or under build/")
    parser.add_argument("--source", default="https://github.com/{owner}/{name}")
    parser.add_argument("--fabric", default="cotton")
    parser.add_argument("--thickness", type=float, default=0.003, help="m")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--only", help="those whose name contains this")
    parser.add_argument("--limit", type=float, default=900.0, help="wall seconds for one garment")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    fetch(options.source, options.folder)
    make_dress_start(options.folder)
    names = [name for name in GARMENTS if not options.only or options.only in name]
    ends = [dress(str(pathlib.Path(options.program).resolve()), options.folder, name, options) for name in names]
    print(f"{ends.count('at rest')} of {len(ends)} at rest without a crossing")
    allowed = [{"at rest", "moves"} if "may tremble" in name else {"at rest"} for name in names]
    return 0 if all(end in ok for end, ok in zip(ends, allowed)) else 1


if __name__ == "__main__":
    sys.exit(main())
