"""Meshes, their makers and files."""
import numpy as np
import pytest

import percale


@pytest.mark.parametrize('mesh, vertices, triangles, volume', [
    (percale.make_sphere(0.5, 3), 642, 1280, 4 / 3 * np.pi * 0.5 ** 3),
    (percale.make_box((1.0, 2.0, 3.0)), 8, 12, 6.0),
    (percale.make_cylinder(0.5, 2.0, 96), None, None, np.pi * 0.25 * 2.0),
    (percale.make_capsule(0.5, 2.0, 96), None, None, np.pi * 0.25 * 2.0 + 4 / 3 * np.pi * 0.125)])
def test_closed_shapes_have_their_volume(mesh, vertices, triangles, volume):
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    assert np.einsum('ij,ij->i', a, np.cross(b, c)).sum() / 6 == pytest.approx(volume, rel=0.02)
    if vertices:
        assert (len(mesh.vertices), len(mesh.triangles)) == (vertices, triangles)


def test_a_grid_is_laid_out_as_documented():
    mesh = percale.make_grid(2.0, 1.0, 5, 3)
    assert (mesh.grid_columns, mesh.grid_rows, mesh.is_grid) == (5, 3, True)
    column, row = 3, 1
    assert mesh.vertices[row * 5 + column].tolist() == [0.5, 0.0, 0.0]
    assert np.all(mesh.vertices[:, 1] == 0)
    assert repr(mesh) == '<percale.Mesh: 15 vertices, 16 triangles>'


def test_a_mesh_comes_apart_and_together_as_a_free_mesh():
    vertices, triangles = percale.make_grid(1.0, 1.0, 3, 3)
    mesh = percale.Mesh(vertices, triangles)
    assert np.array_equal(mesh.vertices, vertices) and np.array_equal(mesh.triangles, triangles)
    assert not mesh.is_grid


def test_a_plane_looks_up():
    a, b, c = percale.make_plane(3.0).vertices[percale.make_plane(3.0).triangles[0]]
    assert np.cross(b - a, c - a)[1] > 0


@pytest.mark.parametrize('write', [percale.write_obj, percale.write_ply])
def test_written_meshes_read_back_in_every_bit(tmp_path, write):
    mesh = percale.make_sphere(1 / 3, 2)
    file = tmp_path / ('mesh.obj' if write is percale.write_obj else 'mesh.ply')
    write(file, mesh)
    back = percale.read_mesh(str(file))
    assert back.vertices.tobytes() == mesh.vertices.tobytes()
    assert back.triangles.tobytes() == mesh.triangles.tobytes()
    write(file, (mesh.vertices * 2, mesh.triangles))
    assert np.array_equal(percale.read_mesh(file, unit=0.5).vertices, mesh.vertices)


def test_near_vertices_of_a_file_are_welded(tmp_path):
    ball = percale.make_sphere(1.0, 2)
    corners = ball.vertices[ball.triangles].reshape(-1, 3)
    apart = corners + 1e-6 * np.random.default_rng(1).uniform(-1, 1, corners.shape)
    percale.write_ply(tmp_path / 'apart.ply', (apart, np.arange(len(corners)).reshape(-1, 3)))
    assert len(percale.read_mesh(tmp_path / 'apart.ply').vertices) == len(corners)
    assert len(percale.read_mesh(tmp_path / 'apart.ply', weld=1e-5).vertices) == len(ball.vertices)
    with pytest.raises(percale.SceneError, match='weld'):
        percale.read_mesh(tmp_path / 'apart.ply', weld=-1.0)


def test_files_that_cannot_be_are_errors(tmp_path):
    with pytest.raises(percale.SceneError, match='none.obj'):
        percale.read_mesh(tmp_path / 'none.obj')
    (tmp_path / 'bad.obj').write_text('v 0 0 0\nv 1 0 zero\n')
    with pytest.raises(percale.SceneError, match='bad.obj:2'):
        percale.read_mesh(tmp_path / 'bad.obj')
    with pytest.raises(percale.SceneError, match='unit'):
        percale.read_mesh(tmp_path / 'bad.obj', unit=-1.0)
    with pytest.raises(percale.SceneError, match='no/such'):
        percale.write_obj('no/such/folder.obj', percale.make_plane())
    with pytest.raises(percale.SceneError, match='percale.Mesh'):
        percale.write_obj(tmp_path / 'out.obj', 'mesh')


@pytest.mark.parametrize('make, words', [
    (lambda: percale.make_grid(1.0, 1.0, 1, 3), '1 x 3'),
    (lambda: percale.make_sphere(-1.0), 'radius'),
    (lambda: percale.make_sphere(1.0, 9), '8'),
    (lambda: percale.make_box((1.0, 0.0, 1.0)), '0'),
    (lambda: percale.make_capsule(1.0, 1.0, 5), 'segments')])
def test_shapes_out_of_range_are_errors(make, words):
    with pytest.raises(percale.SceneError, match=words):
        make()


def test_strains_of_a_stretched_grid_are_those_of_its_stretch():
    mesh = percale.make_grid(1.0, 1.0, 4, 4)
    strains = percale.triangle_strains(mesh, mesh.vertices * [1.1, 1.0, 1.2])
    assert np.allclose(strains, [0.1, 0.2, 0.0], atol=1e-12)
    sheared = mesh.vertices + 0.1 * mesh.vertices[:, [2, 1, 0]] * [1, 0, 0]
    assert np.allclose(np.abs(percale.triangle_strains(mesh, sheared)[:, 2]), np.arctan(0.1), atol=1e-12)


def test_rest_shapes_may_be_vertices_or_corners():
    free = percale.Mesh(*percale.make_grid(1.0, 1.0, 4, 4))
    rest = free.vertices * 0.5
    by_vertices = percale.triangle_strains(free, free.vertices, rest=rest, warp=(1, 0, 0))
    by_corners = percale.triangle_strains(free, free.vertices, rest=rest[free.triangles], warp=(1, 0, 0))
    assert np.allclose(by_vertices, [1.0, 1.0, 0.0], atol=1e-12)
    assert np.array_equal(by_vertices, by_corners)
