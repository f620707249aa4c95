#include "scenes/shapes/primitives.h"

#include <numbers>

#include "percale/error.h"
#include "scenes/meshes/mesh_facts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::primitives_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Volume by the divergence theorem, m^3; positive if the triangles wind counter-clockwise seen from outside.
double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto at = [&](int vertex) { return mesh.vertices[static_cast<std::size_t>(vertex)]; };
        sum += at(a).dot(at(b).cross(at(c))) / 6.0;
    }
    return sum;
}

}  // namespace

TEST_CASE("closed primitives are watertight, centred, as large as they say and nearly of their exact volume") {
    struct Case {
        Shape shape;
        Vec3 half_extent;
        double volume;
    };
    const Case cases[] = {
        {SphereShape{0.3}, {0.3, 0.3, 0.3}, 4.0 / 3.0 * pi * 0.027},
        {BoxShape{{0.2, 0.4, 0.6}}, {0.1, 0.2, 0.3}, 0.048},
        {CylinderShape{0.3, 0.8}, {0.3, 0.4, 0.3}, pi * 0.09 * 0.8},
        {CapsuleShape{0.3, 0.8}, {0.3, 0.7, 0.3}, pi * 0.09 * 0.8 + 4.0 / 3.0 * pi * 0.027},
    };
    for (const Case& one : cases) {
        const TriangleMesh mesh = shape_mesh(one.shape);
        const MeshFacts facts = mesh_facts(mesh);
        CAPTURE(one.shape.index());
        CHECK(facts.watertight());
        CHECK(facts.parts == 1);
        CHECK((facts.highest - one.half_extent).norm() < 2e-3);
        CHECK((facts.lowest + one.half_extent).norm() < 2e-3);
        CHECK(volume(mesh) == Approx(one.volume).epsilon(0.01));
        CHECK(volume(mesh) <= one.volume * (1.0 + 1e-12));
    }
}

TEST_CASE("a sphere has the number of triangles that its key promises, every vertex on it") {
    const TriangleMesh mesh = shape_mesh(SphereShape{0.25});
    CHECK(mesh.triangles.size() == 5120);
    for (const Vec3& x : mesh.vertices) REQUIRE(x.norm() == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("a plane is a horizontal square at height 0") {
    const TriangleMesh mesh = shape_mesh(PlaneShape{2.0});
    CHECK(mesh.triangles.size() == 2);
    const MeshFacts facts = mesh_facts(mesh);
    CHECK((facts.lowest - Vec3(-2, 0, -2)).norm() == 0.0);
    CHECK((facts.highest - Vec3(2, 0, 2)).norm() == 0.0);
}

TEST_CASE("no shape has no mesh") { CHECK_THROWS_WITH(shape_mesh({}), Catch::Contains("needs a mesh or a shape")); }

}  // namespace percale::scenes::test::primitives_test
