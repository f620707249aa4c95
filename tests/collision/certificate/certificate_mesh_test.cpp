#include "certificate/certificate_mesh.h"

#include <cmath>

#include "percale/certify.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::certificate_mesh_test {
namespace {

void check_same(const Certificate& found, const Certificate& expected) {
    REQUIRE(found.pairs.size() == expected.pairs.size());
    for (std::size_t i = 0; i < found.pairs.size(); ++i) {
        CHECK(found.pairs[i].first == expected.pairs[i].first);
        CHECK(found.pairs[i].second == expected.pairs[i].second);
    }
    CHECK(found.touching_pairs == expected.touching_pairs);
    CHECK(found.watertight == expected.watertight);
    CHECK(found.inside_vertices == expected.inside_vertices);
    CHECK(found.deepest_vertex == expected.deepest_vertex);
    CHECK(found.deepest_penetration == expected.deepest_penetration);
    CHECK(found.smallest_distance == expected.smallest_distance);
}

}  // namespace

TEST_CASE("a prepared mesh that moves gives the certificates of a new one") {
    Random random(GENERATE(11U, 12U));
    const TriangleMesh flat = make_grid(1, 1, 15, 15);
    TriangleMesh cloth = flat, body = spiky_ball(0.3, 1, 0.3, 7);
    CertificateMesh kept_cloth(cloth), kept_body(body);
    for (int round = 0; round < 30; ++round) {
        // The sheet is crumpled to a tenth of its size and spread again, the tree of the flat one stays.
        const double size = 0.1 + 0.9 * std::abs(std::cos(0.3 * round));
        for (std::size_t i = 0; i < cloth.vertices.size(); ++i)
            cloth.vertices[i] = size * flat.vertices[i] + random.point(0.5 - 0.45 * size);
        if (round % 3 == 0) body = placed(body, random.pose(0.1));
        if (round == 10) body.vertices[body.triangles[0][0]] += Vec3(0.01, 0.0, 0.0);
        CHECK(kept_cloth.move(cloth));
        CHECK(kept_body.move(body) == (round % 3 == 0 || round == 10));
        check_same(certify(kept_cloth, kept_body, 0.5), certify(cloth, body, 0.5));
        const ClothCertificate own = certify_cloth(kept_cloth), expected = certify_cloth(cloth);
        CHECK(own.crossing.size() == expected.crossing.size());
        CHECK(own.touching.size() == expected.touching.size());
    }
}

TEST_CASE("a prepared mesh may open and close") {
    const TriangleMesh closed = make_box({1, 1, 1});
    TriangleMesh apart;  // the same triangles, each with vertices of its own
    for (const Triangle& t : closed.triangles) {
        const int first = static_cast<int>(apart.vertices.size());
        for (const int v : t) apart.vertices.push_back(closed.vertices[v]);
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    CertificateMesh mesh(apart);
    CHECK(mesh.prepared().watertight());
    TriangleMesh open = apart;
    open.vertices[0].x() += 0.1;
    CHECK(mesh.move(open));
    CHECK_FALSE(mesh.prepared().watertight());
    CHECK(mesh.move(apart));
    CHECK(mesh.prepared().watertight());
    CHECK(mesh.move(closed));  // other triangles
    CHECK(mesh.prepared().watertight());
    CHECK_FALSE(mesh.move(closed));
}

TEST_CASE("a move to what cannot be certified is refused and changes nothing") {
    const TriangleMesh box = make_box({1, 1, 1});
    CertificateMesh mesh(box);
    TriangleMesh bad = box;
    bad.vertices[3].y() = 1e80;
    CHECK_THROWS_AS(mesh.move(bad), SceneError);
    CHECK_FALSE(mesh.move(box));
    CHECK_THROWS_AS(CertificateMesh(bad, "body"), SceneError);
}

}  // namespace percale::test::certificate_mesh_test
