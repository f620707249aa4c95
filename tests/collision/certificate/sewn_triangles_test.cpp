#include "collision/certificate/sewn_triangles.h"

#include "percale/certify.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::sewn_triangles_test {
using certificate::SewnTriangles;

namespace {

/// Three triangles far from each other, then one that shares an edge with the third.
TriangleMesh loose_triangles() {
    TriangleMesh mesh;
    for (int k = 0; k < 3; ++k) {
        for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) mesh.vertices.push_back(x + Vec3(5.0 * k, 0, 0));
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    mesh.vertices.push_back({11, 0, 1});
    mesh.triangles.push_back({7, 9, 8});
    return mesh;
}

}  // namespace

TEST_CASE("triangles are sewn together where both have a vertex of one stitch") {
    const TriangleMesh mesh = loose_triangles();
    const SewnTriangles none(mesh, {});
    CHECK_FALSE(none.together(0, 1));
    const SewnTriangles chain(mesh, std::vector<Stitch>{{0, 3, 3}, {3, 7, 6, 0.0}});
    CHECK(chain.together(0, 1));
    CHECK(chain.together(1, 2));
    CHECK(chain.together(2, 0));
    CHECK(chain.together(0, 3));
    const SewnTriangles point(mesh, std::vector<Stitch>{{0, 6, 7, 0.5}});
    CHECK(point.together(0, 2));
    CHECK(point.together(2, 0));
    CHECK(point.together(0, 3));
    CHECK_FALSE(point.together(0, 1));
    CHECK_FALSE(point.together(1, 2));
}

TEST_CASE("crossings of triangles that a stitch joins are distinguished from those of others") {
    TriangleMesh mesh = joined(make_grid(1, 1, 3, 3), placed(make_grid(1, 1, 3, 3), {.translation = {0.07, 0.1, 0.03}}));
    mesh.vertices[9 + 4].y() = -0.1;
    const ClothCertificate loose = certify_cloth(mesh);
    REQUIRE(loose.crossing.size() > 2);
    CHECK(loose.at_seams.empty());
    const ClothCertificate sewn = certify_cloth(mesh, std::vector<Stitch>{{9 + 4, 4, 4}});
    CHECK(sewn.crossing.size() + sewn.at_seams.size() == loose.crossing.size());
    CHECK(sewn.at_seams.size() > 0);
    const ClothCertificate elsewhere = certify_cloth(mesh, std::vector<Stitch>{{9, 8, 8}});
    CHECK(elsewhere.crossing.size() == loose.crossing.size());
    CHECK_THROWS_AS(certify_cloth(mesh, std::vector<Stitch>{{9, 0, 40}}), SceneError);
}

TEST_CASE("vertices sewn to each other, in chains too, count as the lowest of them") {
    const std::vector<Stitch> stitches = {{4, 2, 2, 0.0}, {5, 4, 1, 0.0}, {3, 0, 1, 0.5}};
    CHECK(certificate::closed_vertices(6, stitches) == std::vector<int>{0, 1, 2, 3, 2, 2});
}

}  // namespace percale::test::sewn_triangles_test
