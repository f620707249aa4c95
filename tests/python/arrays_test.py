"""NumPy arrays into the module and out of it."""
import numpy as np
import pytest

import percale

TRIANGLE = [[0, 1, 2]]
CORNERS = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]


@pytest.mark.parametrize('corners', [
    CORNERS, np.array(CORNERS), np.array(CORNERS, np.float32), np.array(CORNERS, np.int64), np.array(CORNERS, order='F'),
    np.array(CORNERS, '>f8'), np.repeat(np.array(CORNERS), 2, axis=0)[::2], tuple(map(tuple, CORNERS))])
def test_numbers_of_every_kind_and_layout_are_the_same_points(corners):
    mesh = percale.Mesh(corners, TRIANGLE)
    assert mesh.vertices.dtype == np.float64
    assert np.array_equal(mesh.vertices, CORNERS)


@pytest.mark.parametrize('dtype', [np.int8, np.uint8, np.int32, np.int64, np.uint64, '>i4'])
def test_integers_of_every_kind_are_indices(dtype):
    mesh = percale.Mesh(CORNERS, np.array(TRIANGLE, dtype))
    assert mesh.triangles.dtype == np.int32
    assert mesh.triangles.tolist() == TRIANGLE


@pytest.mark.parametrize('corners, triangles, words', [
    (np.zeros((3, 2)), TRIANGLE, ['vertices', '(3, 2)', '(n, 3)']),
    (np.zeros(9), TRIANGLE, ['vertices', '(9,)']),
    (np.array(CORNERS, complex), TRIANGLE, ['vertices', 'complex128']),
    (np.array(CORNERS, np.longdouble), TRIANGLE, ['vertices', 'numbers']),
    ([['a', 'b', 'c']], TRIANGLE, ['vertices', 'numbers']),
    ([[True, False, True]], TRIANGLE, ['vertices', 'bool']),
    ([[0.0], [1.0, 2.0]], TRIANGLE, ['vertices']),
    (CORNERS, [[0.0, 1.0, 2.0]], ['triangles', 'integers', 'float64']),
    (CORNERS, [[0, 1, 2, 0]], ['triangles', '(1, 4)', '(n, 3)']),
    (CORNERS, [[0, 1, 2 ** 40]], ['triangles', str(2 ** 40), '32 bits']),
    (CORNERS, np.array([[0, 1, 2 ** 63 + 5]], np.uint64), ['triangles', str(2 ** 63 + 5)]),
    (CORNERS, [[0, 1, 3]], ['3']),
    ([[0, 0, np.nan], [0, 0, 1], [1, 0, 0]], TRIANGLE, ['finite'])])
def test_arrays_that_do_not_fit_are_refused_with_what_they_are(corners, triangles, words):
    with pytest.raises(percale.SceneError) as caught:
        percale.Mesh(corners, triangles)
    for word in words:
        assert word in str(caught.value)


def test_arrays_of_a_mesh_are_read_only_and_outlive_it():
    mesh = percale.make_grid(1.0, 1.0, 3, 3)
    vertices = mesh.vertices
    with pytest.raises(ValueError):
        vertices[0, 0] = 7.0
    with pytest.raises(ValueError):
        vertices.flags.writeable = True
    assert np.shares_memory(vertices, mesh.vertices)
    kept = vertices.copy()
    del mesh
    assert np.array_equal(vertices, kept)
