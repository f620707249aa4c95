"""The exact check of meshes."""
import numpy as np
import pytest

import percale


def test_a_sheet_through_a_ball_is_found():
    ball = percale.make_sphere(0.3, 4)
    certificate = percale.certify(percale.make_grid(1.0, 1.0, 21, 21), ball)
    assert not certificate.clean and certificate.watertight
    assert certificate.pairs.shape == (len(certificate.pairs), 2) and certificate.pairs.dtype == np.int32
    assert len(certificate.pairs) > 0
    inside = np.linalg.norm(percale.make_grid(1.0, 1.0, 21, 21).vertices, axis=1) < 0.29
    assert set(np.flatnonzero(inside)) <= set(certificate.inside_vertices)
    assert certificate.vertices_inside == len(certificate.inside_vertices)
    assert certificate.deepest_vertex == 220
    assert certificate.deepest_penetration == pytest.approx(0.3, rel=0.01)
    assert certificate.smallest_distance == 0.0


def test_a_sheet_above_a_box_is_clean_at_its_distance():
    sheet = percale.make_grid(1.0, 1.0, 5, 5)
    above = (sheet.vertices + [0, 0.75, 0], sheet.triangles)
    certificate = percale.certify(above, percale.make_box((1, 1, 1)))
    assert certificate.clean
    assert certificate.smallest_distance == pytest.approx(0.25, abs=1e-15)
    assert percale.certify(above, percale.make_box((1, 1, 1)), distance_limit=0.1).smallest_distance == np.inf


def test_a_sheet_folded_through_itself_crosses():
    mesh = percale.make_grid(1.0, 1.0, 9, 9)
    assert percale.certify_cloth(mesh).clean
    folded = mesh.vertices.copy()
    folded[:, 1] = np.where(folded[:, 0] > 0, 0.2 - folded[:, 0], 0.0)
    folded[:, 0] = -np.abs(folded[:, 0])
    certificate = percale.certify_cloth((folded, mesh.triangles))
    assert not certificate.clean
    assert np.all(certificate.crossing[:, 0] < certificate.crossing[:, 1])


def test_distances_have_a_minus_inside():
    assert np.allclose(percale.surface_distances(percale.make_box((2, 2, 2)), [[0, 0, 0], [3, 0, 0], [0, 1, 0]]), [-1, 2, 0])


@pytest.mark.parametrize('call, words', [
    (lambda box: percale.certify(box, 'box'), 'obstacle'),
    (lambda box: percale.certify(box, box, -1.0), 'distance_limit'),
    (lambda box: percale.certify(box, box, np.nan), 'distance_limit'),
    (lambda box: percale.certify((np.full((3, 3), np.nan), [[0, 1, 2]]), box), 'finite'),
    (lambda box: percale.surface_distances(box, [[np.inf, 0, 0]]), 'finite')])
def test_what_cannot_be_checked_is_an_error(call, words):
    with pytest.raises(percale.SceneError, match=words):
        call(percale.make_box((1, 1, 1)))
