#include "collision/untangle/merged_cloth.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::merged_cloth_test {
namespace {

/// Two squares of two triangles each, the second `above` the first; vertices 4 ... 7 are over 0 ... 3.
TriangleMesh two_squares(double above) { return joined(make_grid(1, 1, 2, 2), moved(make_grid(1, 1, 2, 2), {0, above, 0})); }

MergedCloth merge(const TriangleMesh& mesh, const std::vector<Stitch>& stitches, std::vector<double> free = {}) {
    free.resize(mesh.vertices.size(), 1.0);
    return merge_sewn({mesh.triangles, free, stitches}, mesh.vertices, 0.25);
}

}  // namespace

TEST_CASE("vertices that a closed stitch joins are one, in the middle, and those of an open one stay apart") {
    const TriangleMesh mesh = two_squares(0.1);
    const MergedCloth closed = merge(mesh, {{0, 4, 4, 0.0}});
    CHECK(closed.number == std::vector<int>{0, 1, 2, 3, 0, 5, 6, 7});
    CHECK((closed.mesh.vertices[0] - mesh.vertices[0] - Vec3(0, 0.05, 0)).norm() < 1e-15);
    CHECK(closed.stitches.empty());
    const TriangleMesh apart = two_squares(0.9);
    const MergedCloth open = merge(apart, {{0, 4, 4, 0.0}, {1, 4, 5, 0.5}});
    CHECK(open.number[4] == 4);
    CHECK(open.mesh.vertices == apart.vertices);
    CHECK(open.stitches == std::vector<Stitch>{{0, 4, 4, 0.0}, {1, 4, 5, 0.5}});
}

TEST_CASE("what is one is where the first vertex that stays is") {
    const TriangleMesh mesh = two_squares(0.1);
    const MergedCloth merged = merge(mesh, {{1, 5, 5, 0.0}}, {1, 1, 1, 1, 1, 0, 1, 1});
    CHECK(merged.mesh.vertices[1] == mesh.vertices[5]);
    CHECK(merged.free[1] == 0.0);
    const MergedCloth both = merge(mesh, {{1, 5, 5, 0.0}}, {1, 0, 1, 1, 1, 0, 1, 1});
    CHECK(both.mesh.vertices[1] == mesh.vertices[1]);
}

TEST_CASE("stitches of vertices that no triangle has join nothing") {
    TriangleMesh mesh = two_squares(0.1);
    mesh.triangles.resize(2);
    const MergedCloth merged = merge(mesh, {{0, 4, 4, 0.0}, {1, 5, 5, 0.0}});
    CHECK(merged.mesh.vertices == mesh.vertices);
}

TEST_CASE("of triangles that get the same corners one is left, and those that get two alike go") {
    const MergedCloth bag = merge(two_squares(0.1), {{0, 4, 4, 0.0}, {1, 5, 5, 0.0}, {2, 6, 6, 0.0}, {3, 7, 7, 0.0}});
    CHECK(bag.mesh.triangles.size() == 2);
    TriangleMesh narrow = make_grid(0.1, 1, 2, 3);
    narrow.vertices[1] = narrow.vertices[0] + Vec3(0.05, 0, 0);
    CHECK(merge(narrow, {{0, 1, 1, 0.0}}).mesh.triangles.size() < narrow.triangles.size());
}

TEST_CASE("vertices that did not move keep their gap where that is requested, others have none") {
    const TriangleMesh mesh = two_squares(0.1);
    MergedCloth merged = merge(mesh, {{0, 4, 4, 0.0}, {1, 5, 5, 0.0}});
    merged.mesh.vertices[1] += Vec3(0, 0.3, 0);
    const std::vector<Vec3> gaps = merged.places(mesh.vertices, true), none = merged.places(mesh.vertices, false);
    CHECK(gaps[0] == mesh.vertices[0]);
    CHECK(gaps[4] == mesh.vertices[4]);
    CHECK(gaps[1] == gaps[5]);
    CHECK(none[0] == none[4]);
    CHECK(none[1] == gaps[1]);
    CHECK(merged.mean_edge() > 0.5);
}

}  // namespace percale::test::merged_cloth_test
