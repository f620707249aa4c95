#include "engine/schemes/stage_base.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::stage_base_test {
namespace {

const Vec3 p0(0.1, -0.2, 0.3), p1(1.0, 2.0, -1.0), p2(-0.5, 4.0, 2.0);

/// A motion with constant acceleration: q = p0 + t p1 + t^2 p2.
ClothState state_at(double t) {
    ClothState state;
    state.positions = to_vec3_arrays({p0 + t * p1 + t * t * p2});
    state.velocities = to_vec3_arrays({p1 + 2.0 * t * p2});
    return state;
}

const Vec3Arrays acceleration = to_vec3_arrays({2.0 * p2});

/// The residual of a stage for the motion at its end: in q = q* + h v and in v = v* + h a.
double stage_error(const StageBase& base, double t) {
    const ClothState end = state_at(t);
    const Vec3 q = base.positions.at(0) + base.h * end.velocities.at(0);
    const Vec3 v = base.velocities.at(0) + base.h * acceleration.at(0);
    return (q - end.positions.at(0)).norm() + (v - end.velocities.at(0)).norm();
}

}  // namespace

TEST_CASE("Stages of second order are exact at constant acceleration, and extrapolate the velocity") {
    StageBase base;
    set_trapezoid_base(state_at(0.3), acceleration, 0.1, base);
    CHECK(base.h == 0.05);
    CHECK(stage_error(base, 0.4) < 1e-14);
    CHECK((base.extrapolated.at(0) - state_at(0.4).velocities.at(0)).norm() < 1e-14);
    for (const double before : {0.02, 0.1, 0.25}) {
        set_bdf2_base(state_at(0.3), acceleration, state_at(0.3 - before), 0.1, before, base);
        CAPTURE(before, base.h);
        CHECK(stage_error(base, 0.4) < 1e-14);
        CHECK((base.extrapolated.at(0) - state_at(0.4).velocities.at(0)).norm() < 1e-14);
    }
}

TEST_CASE("Twice the implicit midpoint's stage less its start is exact at constant acceleration") {
    StageBase base;
    const ClothState start = state_at(0.3), end = state_at(0.4);
    set_midpoint_base(start, acceleration, 0.1, base);
    CHECK(base.h == 0.05);
    const Vec3 middle_v = base.velocities.at(0) + base.h * acceleration.at(0);
    const Vec3 middle_q = base.positions.at(0) + base.h * middle_v;
    CHECK((2.0 * middle_v - start.velocities.at(0) - end.velocities.at(0)).norm() < 1e-14);
    CHECK((2.0 * middle_q - start.positions.at(0) - end.positions.at(0)).norm() < 1e-14);
}

TEST_CASE("The two stages of TR-BDF2 have the same h") {
    StageBase first, second;
    const double weight = 2.0 - std::sqrt(2.0);
    set_trapezoid_base(state_at(0.0), acceleration, weight, first);
    set_bdf2_base(state_at(weight), acceleration, state_at(0.0), 1.0 - weight, weight, second);
    CHECK(first.h == Approx(second.h).epsilon(1e-14));
}

TEST_CASE("Prescribed vertices reach their targets at a steady speed in any stage") {
    StageBase base;
    const Vec3Arrays targets = to_vec3_arrays({Vec3(1.0, 2.0, 3.0)});
    const ClothState start = state_at(0.3);
    set_trapezoid_base(start, acceleration, 0.1, base);
    set_prescribed_base(AlignedVector<double>(targets.padded_size(), 0.0), start.positions, targets, 0.1, base);
    const Vec3 steady = (targets.at(0) - start.positions.at(0)) / 0.1;
    CHECK((base.velocities.at(0) - steady).norm() < 1e-13);
    CHECK((base.positions.at(0) + base.h * steady - targets.at(0)).norm() < 1e-14);
}

}  // namespace percale::test::stage_base_test
