#include "engine/span/impacts.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {
namespace {

constexpr double dt = 0.01;

/// Two vertices after a stage, the first in contact with a plane or with the second.
struct Impact {
    SolverScene scene =
        solver_scene(linked_masses({0.1, 0.3}, {{0, 1, 1.0, 10.0, 0.0}}), {Vec3(0, 0, 0), Vec3(1, 0, 0)}, {.time_step = dt});
    StagePoint contacts;
    ClothState end;
    std::vector<std::size_t> order;

    Impact(bool between_cloths, double distance, const Vec3& mean, const Vec3& velocity) {
        end = scene.state;
        end.positions.add(0, dt * mean);
        end.velocities.set(0, velocity);
        ContactRows& rows = contacts.rows;
        rows.vertex = {{0, between_cloths ? 1 : -1, -1, -1}};
        rows.weight = {{1.0, between_cloths ? -1.0 : 0.0, 0.0, 0.0}};
        rows.direction = {Vec3(0, 1, 0)};
        rows.obstacle_point = rows.obstacle_displacement = {Vec3::Zero()};
        rows.distance = {distance};
        rows.thickness = {0.005};
        rows.friction = {0.0};
        rows.share = {1.0};
        rows.obstacle = {between_cloths ? -1 : 0};
        rows.feature = {0};
    }
    void settle() { settle_impacts(scene, {contacts, scene.state.positions, dt}, end, order); }
};

}  // namespace

TEST_CASE("A pressed point that came nearer does not leave, along the surface it goes on") {
    Impact impact(false, 0.004, Vec3(0.5, -1.0, 0.0), Vec3(0.5, 2.0, 0.0));
    impact.settle();
    CHECK((impact.end.velocities.at(0) - Vec3(0.5, 0.0, 0.0)).norm() < 1e-14);
}

TEST_CASE("A pressed point that went off leaves no faster than it went in the mean") {
    Impact impact(false, 0.004, Vec3(0.0, 0.7, 0.0), Vec3(0.0, 2.0, 0.0));
    impact.settle();
    CHECK(impact.end.velocities.y[0] == Approx(0.7));
    Impact slow(false, 0.004, Vec3(0.0, 0.7, 0.0), Vec3(0.0, 0.4, 0.0));
    slow.settle();
    CHECK(slow.end.velocities.y[0] == 0.4);
}

TEST_CASE("What is not pressed, and what is pinned, keeps its velocity") {
    Impact far(false, 0.006, Vec3(0.0, -1.0, 0.0), Vec3(0.0, 2.0, 0.0));
    far.settle();
    CHECK(far.end.velocities.y[0] == 2.0);
    Impact pinned(false, 0.004, Vec3(0.0, -1.0, 0.0), Vec3(0.0, 2.0, 0.0));
    pinned.scene.pin(0);
    pinned.settle();
    CHECK(pinned.end.velocities.y[0] == 2.0);
}

TEST_CASE("Between cloths momentum is kept") {
    Impact impact(true, 0.004, Vec3(0.0, -1.0, 0.0), Vec3(0.3, 2.0, 0.0));
    const Vec3 before = 0.1 * impact.end.velocities.at(0) + 0.3 * impact.end.velocities.at(1);
    impact.settle();
    const Vec3 after = 0.1 * impact.end.velocities.at(0) + 0.3 * impact.end.velocities.at(1);
    CHECK((after - before).norm() < 1e-15);
    CHECK(impact.end.velocities.y[0] - impact.end.velocities.y[1] == Approx(0.0).margin(1e-14));
}

}  // namespace percale::test
