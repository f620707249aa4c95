#include "picture/surfaces.h"

#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"

namespace percale::scenes::test::surfaces_test {

TEST_CASE("normals are smooth on a sphere and keep the edges of a box") {
    const TriangleMesh sphere = make_sphere(2.0, 3), box = make_box(Vec3(1, 2, 3));
    const auto round = corner_normals(sphere), sharp = corner_normals(box);
    for (std::size_t i = 0; i < sphere.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(round[i][k].dot((sphere.vertices[static_cast<std::size_t>(sphere.triangles[i][k])] / 2.0).cast<float>()) >
                  0.9999f);
    for (const auto& corners : sharp)
        for (const Eigen::Vector3f& normal : corners) CHECK(normal.cwiseAbs().maxCoeff() == Approx(1.0));
}

TEST_CASE("a triangle without area has no normal and spoils none") {
    TriangleMesh mesh = make_grid(1, 1, 2, 2);
    mesh.triangles.push_back({0, 1, 1});
    const auto normals = corner_normals(mesh);
    CHECK(normals[2][0].norm() == 0.0f);
    CHECK(normals[0][0].y() == Approx(1.0));
}

TEST_CASE("both sides of cloth face the viewer, and the back one says so") {
    if (!draws()) return;
    const std::vector<ShownShape> shapes = {shown(make_grid(1, 1, 3, 3), true)};
    const Surfaces surfaces(shapes, {});
    const SurfacePoint above = surfaces.look(Vec3(0.1, 2, 0.2), -Vec3::UnitY()),
                       below = surfaces.look(Vec3(0.1, -2, 0.2), Vec3::UnitY());
    CHECK((above.shape == 0 && !above.back && below.back));
    CHECK(above.normal.y() == Approx(1.0));
    CHECK(below.normal.y() == Approx(-1.0));
    CHECK(above.depth == Approx(2.0));
    CHECK(above.place.x() == Approx(0.1f));
    CHECK_FALSE(alike(above, below, 1.0f));
    CHECK(alike(above, above, 1e-3f));
    CHECK(surfaces.look(Vec3(2, 2, 2), -Vec3::UnitY()).shape == SurfacePoint::nothing);
}

TEST_CASE("the ground is where nothing else is, as far as it reaches, and from above alone") {
    if (!draws()) return;
    const std::vector<ShownShape> shapes = {shown(make_grid(1, 1, 3, 3), true)};
    const Surfaces surfaces(shapes, Ground{-1.0, Vec3(0, -1, 0), 3.0});
    CHECK(surfaces.look(Vec3(0, 2, 0), -Vec3::UnitY()).shape == 0);
    const SurfacePoint ground = surfaces.look(Vec3(2, 2, 0), -Vec3::UnitY());
    CHECK(ground.shape == SurfacePoint::on_ground);
    CHECK(ground.depth == Approx(3.0));
    CHECK(surfaces.look(Vec3(3.5, 2, 0), -Vec3::UnitY()).shape == SurfacePoint::nothing);
    CHECK(surfaces.look(Vec3(2, -2, 0), Vec3::UnitY()).shape == SurfacePoint::nothing);
}

TEST_CASE("rays to lights start outside of a sphere of flat triangles, not under it") {
    if (!draws()) return;
    const std::vector<ShownShape> shapes = {shown(make_sphere(1.0, 2), false)};
    const Surfaces surfaces(shapes, {});
    int inside = 0;
    for (int k = 0; k < 300; ++k) {
        const Vec3 from(3.0, 0.003 * (k - 150), 0.0017 * (150 - k));
        const SurfacePoint point = surfaces.look(from, Vec3(-1, 0, 0));
        REQUIRE(point.is_shape());
        const double radius = surfaces.lifted(point).norm();
        CHECK(radius > 0.9995);
        CHECK(radius < 1.002);
        inside += point.place.norm() < 0.99f ? 1 : 0;
    }
    CHECK(inside > 0);  // triangles do lie under it
}

}  // namespace percale::scenes::test::surfaces_test
