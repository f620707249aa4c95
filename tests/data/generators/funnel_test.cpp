#include "data/generators/funnel.h"

#include <numbers>

#include "percale/certify.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::funnel_test {
namespace {

/// Area of a regular polygon whose corners lie on the unit circle.
double polygon_area(int corners) { return 0.5 * corners * std::sin(2.0 * std::numbers::pi / corners); }

}  // namespace

TEST_CASE("a funnel is a closed ring, outward, with the volume of its two walls") {
    Funnel wide, coarse;
    wide.mouth = 1.0, wide.wall = 0.05, wide.edge_length = 0.3;
    coarse.segments_around = 5, coarse.tube = coarse.mouth;
    for (const Funnel& funnel : {Funnel{}, wide, coarse}) {
        const TriangleMesh mesh = make_funnel(funnel);
        CHECK(is_watertight(mesh));
        CHECK(has_single_fans(mesh));
        CHECK(euler_number(mesh) == 0);
        CHECK(self_intersections(mesh).empty());
        CHECK_NOTHROW(check_mesh(mesh, "funnel", true));
        const double tube = (2.0 * funnel.tube + funnel.wall) * funnel.wall * funnel.tube_length;
        const double cone = (funnel.mouth + funnel.tube + funnel.wall) * funnel.wall * funnel.cone_height;
        CHECK(volume(mesh) == Approx(polygon_area(funnel.segments_around) * (tube + cone)).epsilon(1e-12));
    }
}

TEST_CASE("what falls down the axis of a funnel meets nothing, and what is wider than the tube meets the cone") {
    const Funnel funnel;
    double narrowest = 1e300;
    for (const Vec3& x : make_funnel(funnel).vertices) {
        const double radius = std::hypot(x[0], x[2]);
        narrowest = std::min(narrowest, radius);
        if (x[1] <= 0.0) continue;
        const double inner = funnel.tube + (funnel.mouth - funnel.tube) * x[1] / funnel.cone_height;
        CHECK(std::min(std::abs(radius - inner), std::abs(radius - inner - funnel.wall)) < 1e-12);
    }
    CHECK(narrowest == Approx(funnel.tube));
}

TEST_CASE("a funnel that cannot be made is refused with the field and its range") {
    const auto refusal = [](auto Funnel::*field, auto value) {
        Funnel funnel;
        funnel.*field = value;
        return message_of([&] { make_funnel(funnel); });
    };
    CHECK(refusal(&Funnel::mouth, 0.05) == "funnel: mouth is 0.050000, allowed are 0.100000 ... 100.000000");
    CHECK(refusal(&Funnel::tube, 0.0).find("funnel: tube is") == 0);
    CHECK(refusal(&Funnel::cone_height, -1.0).find("funnel: cone_height") == 0);
    CHECK(refusal(&Funnel::tube_length, 0.0).find("funnel: tube_length") == 0);
    CHECK(refusal(&Funnel::wall, 0.0).find("funnel: wall") == 0);
    CHECK(refusal(&Funnel::edge_length, std::nan("")).find("funnel: edge_length") == 0);
    CHECK(refusal(&Funnel::segments_around, 2).find("funnel: segments_around") == 0);
}

}  // namespace percale::scenes::test::funnel_test
