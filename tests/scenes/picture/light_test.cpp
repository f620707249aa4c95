#include "picture/light.h"

#include <cmath>
#include <numbers>

#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"

namespace percale::scenes::test::light_test {
namespace {

Camera front_camera() {
    ViewFit fit({0.0, 0.0}, 100, 100);
    fit.add(std::vector<Vec3>{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
    return fit.camera();
}

/// Looks at a place from straight above.
LightShare share_at(const std::vector<ShownShape>& shapes, const Vec3& place, int part = Lights::all_parts) {
    const Surfaces surfaces(shapes, {});
    const SurfacePoint point = surfaces.look(place + Vec3(0, 0.01, 0), -Vec3::UnitY());
    REQUIRE(point.is_shape());
    return Lights(front_camera(), 100.0).measure(surfaces, point, part);
}

}  // namespace

TEST_CASE("all light reaches an open plane, none the inside of a closed box") {
    if (!draws()) return;
    const LightShare open = share_at({shown(make_grid(2, 2, 2, 2), true)}, Vec3(0.1, 0, 0.2));
    CHECK(open.sky == 1.0f);
    CHECK(open.key == 1.0f);
    const LightShare closed =
        share_at({shown(make_grid(2, 2, 2, 2), true), shown(make_box(Vec3(1, 1, 1)), false)}, Vec3(0.1, 0, 0.2));
    CHECK(closed.sky == 0.0f);
    CHECK(closed.key == 0.0f);
}

TEST_CASE("a wall hides the half of the sky that it stands before, a roof what its view factor says") {
    if (!draws()) return;
    // At the foot of a wall that is high and wide: half of the sky's light.
    const TriangleMesh wall = percale::scenes::test::upright(200.0, 2);
    const LightShare foot =
        share_at({shown(make_grid(2, 2, 2, 2), true), shown(moved(wall, Vec3(0, 0, -1e-3)), true)}, Vec3(0, 0, 0));
    CHECK(foot.sky == Approx(0.5).margin(0.03));
    // A point to a parallel square above its middle, a = half side over height:
    // F = 4/pi a/sqrt(1 + a^2) atan(a/sqrt(1 + a^2)) (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-4).
    const double slant = 1.0 / std::sqrt(2.0), factor = 4.0 / std::numbers::pi * slant * std::atan(slant);
    const LightShare roofed =
        share_at({shown(make_grid(2, 2, 2, 2), true), shown(moved(make_grid(2, 2, 2, 2), Vec3(0, 1, 0)), true)}, Vec3(0, 0, 0));
    CHECK(roofed.sky == Approx(1.0 - factor).margin(0.03));
}

TEST_CASE("sixteen parts together are all directions") {
    if (!draws()) return;
    const std::vector<ShownShape> shapes = {shown(make_grid(2, 2, 2, 2), true),
                                            shown(moved(make_sphere(0.4, 3), Vec3(0.1, 0.6, 0.2)), true)};
    const LightShare all = share_at(shapes, Vec3(0, 0, 0));
    LightShare sum{0.0f, 0.0f};
    for (int part = 0; part < Lights::parts; ++part) {
        const LightShare one = share_at(shapes, Vec3(0, 0, 0), part);
        sum.sky += one.sky / Lights::parts;
        sum.key += one.key / Lights::parts;
    }
    CHECK(sum.sky == Approx(all.sky));
    CHECK(sum.key == Approx(all.key));
    CHECK((all.sky > 0.3f && all.sky < 0.95f));
}

TEST_CASE("what is lit more is brighter, never beyond white, and shadows darken the ground") {
    const Lights lights(front_camera(), 1.0);
    SurfacePoint point;
    point.shape = 0;
    point.normal = point.facet = Eigen::Vector3f(-0.5f, 0.7f, 0.5f).normalized();
    const Colour white = Colour::Ones(), grey = Colour::Constant(0.4f);
    float last = -1.0f;
    for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        const Colour light = lights.shade(grey, point, Eigen::Vector3f::UnitZ(), {share, share});
        CHECK(light[0] > last);
        last = light[0];
        CHECK(lights.shade(white, point, Eigen::Vector3f::UnitZ(), {share, share}).maxCoeff() < 1.1f);
    }
    CHECK(lights.ground_shadow({1.0f, 1.0f}) == Approx(0.0).margin(1e-6));
    CHECK(lights.ground_shadow({1.0f, 0.0f}) > 0.2f);
    CHECK(lights.ground_shadow({0.0f, 0.0f}) > lights.ground_shadow({1.0f, 0.0f}));
    CHECK(lights.ground_shadow({0.0f, 0.0f}) <= 1.0f);
}

}  // namespace percale::scenes::test::light_test
