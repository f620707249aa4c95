#!/usr/bin/env python3
"""Other programs read what runs write: tests/validation/frame_readers.py PERCALE FOLDER [--scene FILE] [--duration S].

Runs a scene with all formats of frames into FOLDER and has Blender play the PC2, MDD and GLB files and VTK read the VTP files by their
collection. The vertices of the first, the middle and the last frame are held against those of the OBJ files: at most 1e-6 m apart, 0
for VTK. A program that is not installed (Debian: blender and python3-numpy, python3-vtk9) is told and passed over; exit code 1 if one
of the others differs, or if none is there.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import textwrap
import xml.etree.ElementTree
from pathlib import Path

SYSTEM_PYTHON = '/usr/bin/python3'  # which Debian's modules belong to
MOST_APART = 1e-6  # m

BLENDER = textwrap.dedent('''
    import bpy, json, numpy, sys
    numpy.bool = bool  # which glTF's importer in Debian 12 asks of a numpy that has left it out
    mesh, cache, glb, frames, fps = json.loads(sys.argv[-1])

    def places(thing, frame):
        bpy.context.scene.frame_set(0, subframe=0.0)
        bpy.context.scene.frame_set(frame)
        ready = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return [list(vertex.co) for vertex in ready.to_mesh().vertices]

    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.scene.render.fps = fps
    found = {}
    for file in cache:
        bpy.ops.wm.obj_import(filepath=mesh, forward_axis='Y', up_axis='Z')
        thing = bpy.context.selected_objects[0]
        player = thing.modifiers.new('cache', 'MESH_CACHE')
        player.cache_format = 'PC2' if file.endswith('.pc2') else 'MDD'
        player.filepath = file
        player.frame_start = 0
        found[file[-3:]] = [places(thing, frame) for frame in frames]
    bpy.ops.import_scene.gltf(filepath=glb[0], merge_vertices=False)
    thing = bpy.data.objects[glb[1]]
    # Blender's y and z are glTF's -z and y; its importer rounds times to frames of this scene.
    found['glb'] = [[[x, z, -y] for x, y, z in places(thing, frame)] for frame in frames]
    print('FOUND' + json.dumps(found))
''')

VTK = textwrap.dedent('''
    import json, sys
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    found = []
    for file in json.loads(sys.argv[-1]):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(file)
        reader.Update()
        data = reader.GetOutput()
        found.append([data.GetPoint(k) for k in range(data.GetNumberOfPoints())])
        assert data.GetNumberOfPolys() > 0
    print('FOUND' + json.dumps({'vtp': found}))
''')


def found_by(command):
    # Blender takes the modules of the first python on the path.
    system = {**os.environ, 'PATH': '/usr/bin:/bin'}
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, env=system)
    for line in done.stdout.splitlines():
        if line.startswith('FOUND'):
            return json.loads(line[len('FOUND'):])
    sys.exit(f'{command[0]} found nothing:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}')


def obj_places(file):
    return [[float(word) for word in line.split()[1:4]] for line in file.read_text().splitlines() if line.startswith('v ')]


def largest_difference(some, others):
    if len(some) != len(others):
        return float('inf')
    return max(abs(a - b) for x, y in zip(some, others) for a, b in zip(x, y))


def collected_files(folder, name, frames):
    """The VTP files of a cloth at some frames, as frames/scene.pvd lists them."""
    listed = [entry.get('file') for entry in xml.etree.ElementTree.parse(folder / 'frames/scene.pvd').iter('DataSet')
              if entry.get('name') == name]
    return [str(folder / 'frames' / listed[frame]) for frame in frames]


def read_all(folder, name, frames, fps):
    """What every program that is here found: format -> vertices at the frames."""
    found = {}
    frames_folder = folder / 'frames'
    if shutil.which('blender'):
        script = folder / 'blender.py'
        script.write_text(BLENDER)
        given = [str(frames_folder / f'{name}.mesh.obj'), [str(frames_folder / f'{name}.{e}') for e in ('pc2', 'mdd')],
                 [str(frames_folder / 'scene.glb'), name], frames, fps]
        found.update(found_by(['blender', '-b', '--factory-startup', '--python', str(script), '--', json.dumps(given)]))
    if subprocess.run([SYSTEM_PYTHON, '-c', 'import vtkmodules.vtkIOXML'], capture_output=True, check=False).returncode == 0:
        found.update(found_by([SYSTEM_PYTHON, '-c', VTK, json.dumps(collected_files(folder, name, frames))]))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('percale', type=Path)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--scene', type=Path, default=Path(__file__).resolve().parents[2] / 'data/scenes/t_shirt.toml')
    parser.add_argument('--duration', default='0.5')
    options = parser.parse_args()
    folder = options.folder.resolve()
    subprocess.run([options.percale, 'run', options.scene, '-o', folder, '--quiet', '--frames', 'obj,pc2,mdd,glb,vtp', '--set',
                    f'duration={options.duration}'], stderr=subprocess.DEVNULL, check=False)
    report = json.loads((folder / 'report.json').read_text())
    count = len(report['frames'])
    name = Path(report['frames'][0]['cloths'][0]).name.rsplit('_', 1)[0]
    frames = [0, count // 2, count - 1]
    wanted = [obj_places(folder / report['frames'][frame]['cloths'][0]) for frame in frames]
    found = read_all(folder, name, frames, round(report['settings']['output']['fps']))
    wrong = not found
    for word in ('pc2', 'mdd', 'glb', 'vtp'):
        if word not in found:
            print(f'{word}: no program here that reads it')
            continue
        apart = max(largest_difference(a, b) for a, b in zip(found[word], wanted))
        limit = 0.0 if word == 'vtp' else MOST_APART
        wrong = wrong or not apart <= limit
        print(f'{word}: {len(frames)} frames of {len(wanted[0])} vertices, at most {apart:.3g} m apart ({limit:g} allowed)')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
