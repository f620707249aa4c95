#!/usr/bin/env python3
"""Fetches bodies of other projects, drapes sheets and a poncho over each, and says whether anything crossed.

    tests/validation/real_bodies.py build/percale build/real_bodies

Needs the Python module in the folder of the program (-DPERCALE_PYTHON=ON). Nothing of what it fetches belongs to this project; --source as
in real_garments.py. Body scans that .ci/fetch_meshes.sh left in build/real_meshes (or PERCALE_REAL_MESHES) are taken, too. Each body is
made 1.7 m long. Every frame is certified. The poncho starts around the neck of a person, above other bodies.

Columns: triangles of the body; pairs of them that cross each other (1000: at least); for each cloth the pairs of crossing triangles in all
frames, the deepest penetration, mm, the smallest distance, mm, and CPU seconds. Exit code 1 if anything crossed or did not finish.
"""
import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from real_garments import fetch

LONGEST = 1.7  # m
FRAMES_A_SECOND = 30
FILES = {
    'maria-korosteleva/GarmentCode': [f'assets/bodies/{name}.obj' for name in (
        'f_smpl_average_A40', 'm_smpl_average_A40', 'mean_all', 'mean_all_tpose', 'mean_female', 'mean_male')],
    'makehumancommunity/makehuman': ['makehuman/data/3dobjs/base.obj'],
    'isantesteban/vto-garment-collisions': ['assets/meshes/body.obj'],
    'nemutas/app-mixamo-animation': ['public/assets/ybot.glb'],
    'ankitrana1256/Portfolio': ['models/Xbot.glb'],
    'alecjacobson/common-3d-test-models': [f'data/{name}.obj' for name in ('homer', 'ogre', 'woody', 'beast', 'spot', 'suzanne')],
}
PEOPLE = ('smpl', 'mean_', 'base', 'body', 'bot', 'man.off')
SCANS = ('man', 'armadillo', 'bunny00', 'refined_elephant', 'dino', 'hand')  # of .ci/fetch_meshes.sh
PONCHO = Path(__file__).resolve().parents[2] / 'data' / 'meshes' / 'poncho.obj'
PONCHO_HOLE, PONCHO_RADIUS = 0.13, 0.786  # m
CLOTHS = ('33', '65', 'poncho')


def box(mesh):
    return mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)


def neck_of(vertices):
    """(place, radius) of the narrowest slice between 78 and 92 % of a standing body's height; its arms are out of the way."""
    low, high = vertices[:, 1].min(), vertices[:, 1].max()
    best = None
    for tenth in range(780, 920, 5):
        y = low + (high - low) * tenth / 1000
        part = vertices[abs(vertices[:, 1] - y) < 0.015]
        if len(part) < 8:
            continue
        centre = 0.5 * (part.min(axis=0) + part.max(axis=0))
        radius = (((part - centre)[:, [0, 2]] ** 2).sum(axis=1) ** 0.5).max()
        if best is None or radius < best[1]:
            best = (centre, radius)
    return best


def place_of(cloth, vertices, person):
    """(geometry, pose) keys of the cloth, for a body that is placed already."""
    top = vertices.max(axis=0)[1]
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    if cloth != 'poncho':
        at = [middle[0], top + 0.05, middle[2]]
        return f'grid = {{ size = [1.6, 1.6], vertices = [{cloth}, {cloth}] }}', f'pose = {{ translation = {json.dumps(at)} }}'
    if person:
        centre, radius = neck_of(vertices)
        scale, at = max(1.0, (radius + 0.02) / PONCHO_HOLE), [centre[0], centre[1], centre[2]]
    else:
        scale, at = 1.0, [middle[0], top + 0.05, middle[2]]
    return f'mesh = {json.dumps(str(PONCHO))}', f'pose = {{ translation = {json.dumps(at)}, scale = {scale} }}'


def scene_text(body, scale, geometry, pose, seconds):
    return f'''title = "a cloth over {body.name}"
duration = {seconds}
[step]
time_step = 0.016666666666666666
[fabric.cotton]
preset = "cotton"
thickness = 0.003
self_contact = true
[[cloth]]
name = "cloth"
fabric = "cotton"
{geometry}
{pose}
[[obstacle]]
name = "body"
mesh = {json.dumps(str(body.resolve()))}
pose = {{ scale = {scale} }}
friction = 0.4
[expect]
intersections = 0
'''


def drape(program, body, cloth, scale, vertices, options):
    """(text of the cell, whether all is well)."""
    geometry, pose = place_of(cloth, vertices, any(word in body.name.lower() for word in PEOPLE))
    out = options.folder / f'{body.stem}_{cloth}'
    scene = out.with_suffix('.toml')
    scene.write_text(scene_text(body, scale, geometry, pose, options.seconds))
    run = subprocess.run([program, 'run', str(scene), '-o', str(out), '--fps', str(FRAMES_A_SECOND), '--quiet'], capture_output=True, text=True, check=False)
    report_file = out / 'report.json'
    if run.returncode not in (0, 1) or not report_file.exists():
        return f'**{run.stderr.strip().splitlines()[-1] if run.stderr.strip() else run.returncode}**', False
    report = json.loads(report_file.read_text())
    pairs, well = report['intersections'], run.returncode == 0 and report['status'] == 'finished'
    depth, distance = report['deepest_penetration'], report['smallest_distance']
    depth_text = '-' if depth is None else f'{1e3 * depth:.2g}'
    text = f'{pairs}, {depth_text}, {1e3 * distance:.2g}, {report["cpu_s"]:.1f}'
    return text if well else f'**{text} ({report["status"]})**', well


def crossing_pairs(program, body):
    told = json.loads(subprocess.run([program, 'doctor', '--as', 'obstacle', '--json', str(body)], capture_output=True, text=True, check=False).stdout)
    return sum(finding['count'] for finding in told['files'][0]['findings'] if finding['kind'] == 'self_crossing')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program', type=Path)
    parser.add_argument('folder', type=Path, help='where the files go, outside the repository or under build/')
    parser.add_argument('--source', default='https://github.com/{owner}/{name}')
    parser.add_argument('--seconds', type=float, default=2.0, help='simulated')
    parser.add_argument('--only', help='bodies whose name contains this')
    parser.add_argument('-o', type=Path, dest='table', help='writes the table as a file, too')
    options = parser.parse_args()
    sys.path.insert(0, str(options.program.resolve().parent / 'python'))
    import percale
    options.folder.mkdir(parents=True, exist_ok=True)
    fetch(options.source, options.folder, FILES)
    meshes = Path(os.environ.get('PERCALE_REAL_MESHES', PONCHO.parents[2] / 'build' / 'real_meshes'))
    bodies = [options.folder / Path(file).name for files in FILES.values() for file in files]
    bodies += [file for file in (meshes / f'{name}.off' for name in SCANS) if file.exists()]
    lines = ['| body | triangles | cross each other | ' + ' | '.join(
        f'{cloth}: pairs, depth mm, distance mm, CPU s' if cloth == 'poncho' else f'{cloth} x {cloth}' for cloth in CLOTHS) + ' |',
             '|' + '---|' * (3 + len(CLOTHS))]
    print('\n'.join(lines), flush=True)
    program, bad = str(options.program.resolve()), 0
    for body in bodies:
        if options.only and options.only not in body.name:
            continue
        mesh = percale.read_mesh(str(body))
        low, high = box(mesh)
        scale = LONGEST / float((high - low).max())
        cells = []
        for cloth in CLOTHS:
            cell, well = drape(program, body, cloth, scale, mesh.vertices * scale, options)
            bad += not well
            cells.append(cell)
        lines.append(f'| {body.name} | {len(mesh.triangles)} | {crossing_pairs(program, body)} | {" | ".join(cells)} |')
        print(lines[-1], flush=True)
    lines.append(f'\n{len(lines) - 2} bodies, {bad} of their cloths crossed or did not finish.')
    print(lines[-1])
    if options.table:
        options.table.write_text('Written by `tests/validation/real_bodies.py build/percale build/real_bodies '
                                 f'-o {options.table}`; {options.seconds:g} s each.\n\n' + '\n'.join(lines) + '\n')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
