#include "engine/substep/impacts.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::impacts_test {
namespace {

constexpr double dt = 0.01;

constexpr double mass = 0.1, push = 0.06;  // kg, N

/// Two vertices after a stage, the first in contact with an obstacle or with the second. Contact gave the first the speed dt
/// push/mass = 0.006 m/s, unless stated otherwise.
struct Hit {
    SolverScene scene =
        solver_scene(linked_masses({mass, 0.3}, {{0, 1, 1.0, 10.0, 0.0}}), {Vec3(0, 0, 0), Vec3(1, 0, 0)}, {.time_step = dt});
    StagePoint contacts;
    ClothState end;
    ImpactSpace space;
    ImpactEnergy flows;
    bool keeps_to_mean = false;
    double weight = 1.0;
    std::vector<ObstacleImpulse> impulses;

    explicit Hit(const Vec3& velocity, double force = push, bool between_cloths = false) {
        scene.script.obstacles.push_back({.name = "ground", .start = {}, .end = {}});
        end = scene.state;
        end.velocities.set(0, velocity);
        ContactConstraints& constraints = contacts.constraints;
        constraints.vertex = {{0, between_cloths ? 1 : -1, -1, -1}};
        constraints.weight = {{1.0, between_cloths ? -1.0 : 0.0, 0.0, 0.0}};
        constraints.direction = {Vec3(0, 1, 0)};
        constraints.obstacle_point = constraints.obstacle_displacement = {Vec3::Zero()};
        constraints.distance = {0.004};
        constraints.thickness = {0.005};
        constraints.friction = {0.0};
        constraints.mollifier = {1.0};
        constraints.obstacle = {between_cloths ? -1 : 0};
        constraints.feature = {0};
        contacts.constraint_forces = {{.normal = force}};
    }

    /// Sets the velocity and the impacts at the start of the stage.
    Hit& after(double speed, std::vector<Impact> impacts = {}) {
        scene.state.velocities.set(0, Vec3(0, speed, 0));
        scene.state.impacts = std::move(impacts);
        return *this;
    }
    Hit& on(double restitution) {
        scene.script.obstacles[0].restitution = restitution;
        return *this;
    }
    double settle(const Vec3Arrays* extrapolated = nullptr) {
        flows = settle_impacts(scene, {contacts, scene.state, dt, dt, keeps_to_mean, extrapolated, weight}, end, space, impulses);
        return end.velocities.y[0];
    }
};

}  // namespace

TEST_CASE("A point that leaves only by contact stops, and continues along the surface") {
    Hit hit(Vec3(0.5, 0.005, 0.0));
    CHECK(hit.after(-2.0).settle() == 0.0);
    CHECK(hit.end.velocities.x[0] == 0.5);
    REQUIRE(hit.end.impacts.size() == 1);
    CHECK(hit.end.impacts[0].stopped);
}

TEST_CASE("A stopped impact fades, and persistent contacts are left alone") {
    Hit hit(Vec3(0.0, 0.005, 0.0));
    std::vector<Impact> impacts = {{.vertex = 0, .obstacle = 0, .speed = 2.0, .stopped = true}};
    int stages = 0;
    for (; !impacts.empty(); ++stages) {
        REQUIRE(stages < 100);
        const bool fast = impacts[0].speed > 2.0 * 0.005 + 9.81 * dt;
        hit.end.velocities.set(0, Vec3(0.0, 0.005, 0.0));
        CHECK(hit.after(0.0, impacts).settle() == (fast ? 0.0 : 0.005));
        impacts = hit.end.impacts;
        CHECK(impacts.empty() != fast);
    }
    CHECK(stages > 10);
    hit.end.velocities.set(0, Vec3(0.0, 0.005, 0.0));
    CHECK(hit.after(0.0).settle() == 0.005);
}

TEST_CASE("A point that leaves by itself loses only what contact gave it") {
    CHECK(Hit(Vec3(0, 0.7, 0)).after(-2.0).settle() == Approx(0.7 - dt * push / mass).epsilon(1e-14));
    CHECK(Hit(Vec3(0, 0.7, 0), 0.0).after(-2.0).settle() == 0.7);
    CHECK(Hit(Vec3(0, -0.7, 0)).after(-2.0).settle() == -0.7);
}

TEST_CASE("The extrapolated change of a stop counts as contact's") {
    Hit hit(Vec3(0, 0.05, 0));
    Vec3Arrays ahead;
    ahead.resize(2);
    ahead.set(0, Vec3(0, 0.04 - 2.0, 0));
    CHECK(hit.after(-2.0).settle(&ahead) == Approx(0.05 - 0.04 - dt * push / mass).epsilon(1e-13));
}

TEST_CASE("In a stage of TR-BDF2 a pressed point leaves no faster than its mean velocity") {
    Hit hit(Vec3(0.0, 2.0, 0.0));
    hit.keeps_to_mean = true;
    hit.end.positions.add(0, Vec3(0, 0.7 * dt, 0));
    CHECK(hit.settle() == Approx(0.7).epsilon(1e-13));
    Hit nearer(Vec3(0.0, 2.0, 0.0));
    nearer.keeps_to_mean = true;
    nearer.end.positions.add(0, Vec3(0, -0.7 * dt, 0));
    CHECK(nearer.settle() == Approx(0.0).margin(1e-14));
}

TEST_CASE("A pinned point keeps its velocity") {
    Hit pinned(Vec3(0.0, 2.0, 0.0));
    pinned.scene.pin(0);
    CHECK(pinned.settle() == 2.0);
}

TEST_CASE("Between cloths momentum is kept") {
    Hit hit(Vec3(0.3, 0.005, 0.0), push, true);
    const Vec3 before = mass * hit.end.velocities.at(0) + 0.3 * hit.end.velocities.at(1);
    hit.after(-2.0).settle();
    const Vec3 after = mass * hit.end.velocities.at(0) + 0.3 * hit.end.velocities.at(1);
    CHECK((after - before).norm() < 1e-15);
    CHECK(hit.end.velocities.y[0] - hit.end.velocities.y[1] == Approx(0.0).margin(1e-15));
}

TEST_CASE("A point that hits an obstacle leaves at the restitution times its speed once it has been stopped") {
    Hit coming(Vec3(0, -1.0, 0));
    CHECK(coming.after(-2.0).on(0.5).settle() == -1.0);
    REQUIRE(coming.end.impacts.size() == 1);
    CHECK(coming.end.impacts[0].speed == 2.0);
    CHECK(coming.space.jumps.empty());

    Hit stopped(Vec3(0, -0.01, 0));
    CHECK(stopped.after(-1.0, coming.end.impacts).on(0.5).settle() == Approx(1.0).epsilon(1e-14));
    REQUIRE(stopped.end.impacts.size() == 1);
    CHECK(stopped.end.impacts[0].stopped);
    REQUIRE(stopped.space.jumps.size() == 1);
    CHECK(stopped.space.jumps[0].direction == Vec3(0, 1, 0));

    // Without restitution its velocity has jumped as well, in the step in which it was stopped.
    Hit without(Vec3(0, -0.01, 0));
    without.after(-1.0, coming.end.impacts).settle();
    CHECK(without.space.jumps.size() == 1);
    Hit later(Vec3(0, 0.0, 0));
    later.after(0.0, without.end.impacts).settle();
    CHECK(later.space.jumps.empty());

    Hit too_fast(Vec3(0, 3.0, 0));
    CHECK(too_fast.after(-2.0).on(0.5).settle() == Approx(1.0).epsilon(1e-14));
}

TEST_CASE("What is subtracted stops nothing and throws nothing back") {
    for (const double restitution : {0.0, 0.7}) {
        Hit hit(Vec3(0, 0.5, 0), -push);
        hit.contacts.constraints.mollifier = {-1.0};
        CHECK(hit.after(-2.0, {{0, 0, 2.0, true}}).on(restitution).settle() == 0.5);
        CHECK(hit.end.impacts.empty());
    }
}

TEST_CASE("Cloth that gravity alone presses is not thrown back") {
    Hit resting(Vec3(0, 0.0, 0));
    CHECK(resting.after(-0.05).on(1.0).settle() == 0.0);
}

TEST_CASE("Gravity accelerates a point on its way to the thickness") {
    Hit hit(Vec3(0, 0.0, 0));
    hit.end.positions.add(0, Vec3(0, -0.021, 0));  // its start was 0.02 m beyond the thickness
    CHECK(hit.after(-2.0).on(1.0).settle() == Approx(std::sqrt(4.0 + 2.0 * 9.81 * 0.02)).epsilon(1e-12));
}

TEST_CASE("The energy change by settling is returned, with the work of a moving obstacle apart") {
    Hit hit(Vec3(0, 3.0, 0));
    hit.scene.settings.gravity = Vec3::Zero();
    hit.contacts.constraints.obstacle_displacement = {Vec3(0, dt, 0)};  // it approaches at 1 m/s
    hit.after(-1.0).on(0.5);
    const double before = 0.5 * mass * 9.0, after = 0.5 * mass * std::pow(hit.settle(), 2);
    CHECK(hit.end.velocities.y[0] ==
          Approx(2.0).epsilon(1e-12));  // it approached at 2 m/s relative to the obstacle, and leaves at 1
    CHECK(before - after + hit.flows.work == Approx(hit.flows.loss).epsilon(1e-12));
    CHECK(hit.flows.work == Approx(mass * (2.0 - 3.0) * 1.0).epsilon(1e-12));
}

TEST_CASE("Settling gives an obstacle the impulse that it takes from the cloth, where requested and the substep is kept") {
    Hit hit(Vec3(0.5, 3.0, 0));
    hit.end.positions.set(0, Vec3(0.2, 0, 0));
    hit.impulses.resize(1);
    hit.weight = 1.5;
    CHECK(hit.after(-2.0).on(0.5).settle() == Approx(1.0).epsilon(1e-14));
    const double given = 1.5 * mass * 2.0;  // from 3 m/s to 1
    CHECK((hit.impulses[0].linear - Vec3(0, given, 0)).norm() < 1e-14);
    CHECK((hit.impulses[0].angular - Vec3(0, 0, 0.2 * given)).norm() < 1e-14);
    CHECK(hit.space.jumps[0].obstacle == 0);

    Hit between(Vec3(0, 1.0, 0), push, true);
    between.impulses.resize(1);
    between.after(-2.0).settle();
    CHECK(between.impulses[0].linear == Vec3::Zero());
}

}  // namespace percale::test::impacts_test
