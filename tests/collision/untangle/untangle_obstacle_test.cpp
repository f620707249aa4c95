#include "collision/untangle/untangle_obstacle.h"

#include "percale/signed_depth.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::untangle_obstacle_test {

TEST_CASE("inside is where a closed surface winds around a point, open ones hold nothing") {
    const SolidObstacle box(make_box({2, 2, 2})), turned(inside_out(make_box({2, 2, 2}))), plane(make_plane(1));
    CHECK(box.watertight());
    CHECK(box.inside({0.9, 0, 0}));
    CHECK_FALSE(box.inside({1.1, 0, 0}));
    CHECK(turned.inside({0.9, 0, 0}));
    CHECK_FALSE(plane.watertight());
    CHECK_FALSE(plane.inside({0, -0.1, 0}));
}

TEST_CASE("the exit is where the outside begins, not at inner walls") {
    const SolidObstacle box(make_box({2, 2, 2}));
    CHECK(*box.exit({0.25, 0, 0}, Vec3::UnitX()) == Approx(0.75));
    CHECK(*box.exit({0.25, 0, 0}, -Vec3::UnitX()) == Approx(1.25));
    CHECK_FALSE(box.exit({5, 0, 0}, Vec3::UnitX()));
    const SolidObstacle chain(joined(make_box({2, 2, 2}), moved(make_box({2, 1, 1}), {1.5, 0, 0})));
    CHECK(*chain.exit({0, 0, 0}, Vec3::UnitX()) == Approx(2.5));
    CHECK(*chain.exit({0, 0, 0}, Vec3::UnitY()) == Approx(1.0));
    const SolidObstacle plane(make_plane(1));
    CHECK(*plane.exit({0.3, -0.2, 0.1}, Vec3::UnitY()) == Approx(0.2));
    CHECK_FALSE(plane.exit({0.3, -0.2, 0.1}, -Vec3::UnitY()));
    CHECK_FALSE(plane.exit({3, -0.2, 0}, Vec3::UnitY()));
}

TEST_CASE("pushed out points lie at the clearance, by the shortest displacement, those farther away stay") {
    const Vec3 size(0.6, 0.8, 1.0);
    const SolidObstacle box(make_box(size));
    Random random(7);
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 x = random.point(0.7);
        const double before = box_distance(x, size);
        const Vec3 out = box.pushed_out(x, 0.05);
        inside += before < 0.0;
        if (before >= 0.05) CHECK(out == x);
        if (before >= 0.05) continue;
        CHECK(box_distance(out, size) == Approx(0.05).margin(1e-12));
        CHECK((out - x).norm() <= 0.05 - before + 1e-12);
    }
    CHECK(inside > 50);
}

TEST_CASE("a point on the surface is pushed along the normal") {
    const SolidObstacle box(make_box({2, 2, 2}));
    CHECK((box.pushed_out({1, 0.3, 0.1}, 0.05) - Vec3(1.05, 0.3, 0.1)).norm() < 1e-12);
}

}  // namespace percale::test::untangle_obstacle_test
