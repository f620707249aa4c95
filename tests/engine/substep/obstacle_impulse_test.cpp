#include "engine/substep/obstacle_impulse.h"

#include "engine/solve/implicit_stage.h"
#include "tests/support/catch.h"
#include "tests/support/contact_rows.h"

namespace percale::test::obstacle_impulse_test {
namespace {

/// Three vertices, two of them pressed by obstacles 0 and 1, the last by cloth.
StagePoint pressed() {
    StagePoint stage;
    stage.positions.resize(3);
    stage.positions.set(0, Vec3(1, 0, 0));
    stage.positions.set(1, Vec3(0, 0, 2));
    add_constraint({0, 1, -1, -1}, {0.25, 0.75, 0, 0}, 1, stage.constraints);
    add_constraint({0, -1, -1, -1}, {1, 0, 0, 0}, 0, stage.constraints);
    add_constraint({2, 0, -1, -1}, {1, -1, 0, 0}, -1, stage.constraints);
    stage.constraint_forces = {{.normal = 8.0, .friction = Vec3(4, 0, 0)}, {.normal = 1.0}, {.normal = 5.0}};
    return stage;
}

}  // namespace

TEST_CASE("Contacts of a stage give an obstacle their forces times the time, with the other sign, where the vertices are") {
    std::vector<ObstacleImpulse> impulses(2);
    add_contact_impulses(pressed(), 0.5, impulses);
    CHECK(impulses[0].linear == Vec3(0, -0.5, 0));
    CHECK(impulses[0].angular == Vec3(0, 0, -0.5));
    CHECK(impulses[1].linear == Vec3(-2, -4, 0));
    // 2 N at (1, 0, 0) and (3, 6, 0) N at (0, 0, 2), for half a second.
    CHECK(impulses[1].angular == Vec3(6, -3, -1));
    add_contact_impulses(pressed(), 0.5, impulses);
    CHECK(impulses[1].linear == Vec3(-4, -8, 0));
}

TEST_CASE("Without a request no impulses are added") {
    std::vector<ObstacleImpulse> none;
    add_contact_impulses(pressed(), 0.5, none);
    CHECK(none.empty());
}

}  // namespace percale::test::obstacle_impulse_test
