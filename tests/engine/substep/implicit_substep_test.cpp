#include "engine/substep/implicit_substep.h"

#include <cmath>

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::implicit_substep_test {
namespace {

constexpr std::array implicit_schemes = {Scheme::backward_euler, Scheme::implicit_midpoint, Scheme::trapezoid, Scheme::bdf2,
                                         Scheme::tr_bdf2};

World sheet(const StepSettings& settings, double height = 0.0) {
    TriangleMesh grid = make_grid(0.2, 0.2, 5, 5);
    for (Vec3& x : grid.vertices) x.y() += height;
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, settings);
}

/// A sheet above a plane at 0.
World sheet_over_plane(const StepSettings& settings, double height) {
    World world = sheet(settings, height);
    add_plane(world);
    return world;
}

double mean_height_rate(const World& world) {
    double sum = 0.0;
    for (int i = 0; i < world.scene.model.vertex_count(); ++i)
        sum += world.scene.model.mass[i] * world.state.cloth.velocities.y[i];
    return sum / world.scene.model.cloths[0].mass;
}

}  // namespace

TEST_CASE("A substep leads to its end only, its pins to where they are then, and its start stays as it is") {
    for (const Scheme scheme : implicit_schemes) {
        World world = sheet({.scheme = scheme});
        world.scene.script.free[0] = 0.0;
        world.scene.script.pin_targets.set(0, world.state.cloth.positions.at(0) + Vec3(0.01, 0, 0));
        plan_step(world);
        const StepState start = world.state;
        StepState end;
        const SubstepResult result = advance({world.scene, start.cloth.positions, {0.0, 0.5}}, world.state, world.work, end);
        REQUIRE(result.end == SubstepOutcome::solved);
        CAPTURE(static_cast<int>(scheme));
        CHECK((end.cloth.positions.at(0) - start.cloth.positions.at(0) - Vec3(0.005, 0, 0)).norm() < 1e-15);
        CHECK((end.cloth.velocities.at(0) - Vec3(0.6, 0, 0)).norm() < 1e-12);
        CHECK(end.cloth.velocities.y[24] == Approx(-9.81 / 120.0).epsilon(0.01));
        CHECK(same_bits(world.state.cloth.positions, start.cloth.positions));
        CHECK(same_bits(world.state.cloth.velocities, start.cloth.velocities));
        CHECK(world.state.cloth.points == start.cloth.points);
    }
}

TEST_CASE("A substep is a function of its values: solved twice it ends in the same bits") {
    for (const Scheme scheme : implicit_schemes) {
        World world = sheet_over_plane({.scheme = scheme == Scheme::tr_bdf2 ? scheme : Scheme::backward_euler}, 0.006);
        for (int n = 0; n < 5; ++n) REQUIRE(step(world).ok());
        plan_step(world);
        StepState first, second;
        const Substep substep{world.scene, world.state.cloth.positions, {0.0, 1.0}};
        REQUIRE(advance(substep, world.state, world.work, first).end == SubstepOutcome::solved);
        REQUIRE(advance(substep, world.state, world.work, second).end == SubstepOutcome::solved);
        CHECK(same_bits(first.cloth.positions, second.cloth.positions));
        CHECK(same_bits(first.cloth.velocities, second.cloth.velocities));
        CHECK(first.contact_energy == second.contact_energy);
    }
}

TEST_CASE("BDF2 is the same whether a substep is solved at once or its history is dropped, to its order") {
    World kept = sheet({.time_step = 1e-3, .scheme = Scheme::bdf2, .newton_tolerance = 1e-10});
    World forgetful = sheet({.time_step = 1e-3, .scheme = Scheme::bdf2, .newton_tolerance = 1e-10});
    for (World* world : {&kept, &forgetful}) {
        world->scene.script.free[0] = 0.0;
        for (int n = 0; n < 20; ++n) {
            if (world == &forgetful) world->state.past.earlier_length = 0.0;
            REQUIRE(step(*world).status == StepStatus::ok);
        }
    }
    CHECK(kept.state.past.earlier_length == 1e-3);
    const double apart = largest_difference(kept.state.cloth.points, forgetful.state.cloth.points);
    CHECK(apart > 0.0);
    CHECK(apart < 1e-5);
}

TEST_CASE("TR-BDF2 on a plane: no energy is gained, impacts die out, cloth at rest stays at rest") {
    World world = sheet_over_plane({.time_step = 1.0 / 120.0, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::all}, 0.05);
    double energy = 0.2 * 0.04 * 9.81 * 0.05, rebound = 0.0;
    bool met = false;
    for (int n = 0; n < 120; ++n) {
        const StepReport report = step(world);
        REQUIRE(report.ok());
        CHECK(report.energy.total() <= energy + 1e-9);
        energy = report.energy.total();
        met = met || report.contacts > 0;
        if (met) rebound = std::max(rebound, mean_height_rate(world));
        CHECK(report.smallest_distance > 0.0);
    }
    CHECK(met);
    CHECK(rebound < 0.35);  // of 1 m/s
    CHECK(std::abs(mean_height_rate(world)) < 1e-4);
    CHECK(world.state.cloth.positions.y[12] > 0.74 * 0.005);
    CHECK(world.state.cloth.positions.y[12] < 0.005);
}

TEST_CASE("A moving plane lifts cloth by TR-BDF2 and does the work of the gain of energy") {
    World world =
        sheet_over_plane({.time_step = 1.0 / 240.0, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::ledger}, 0.00375);
    double work = 0.0, taken = 0.0, before = 0.0, after = 0.0;
    for (int n = 0; n < 60; ++n) {
        ObstacleState& plane = world.scene.script.obstacles[0];
        plane.end.translation = Vec3(0, 0.2 * (n + 1) / 240.0, 0);
        const StepReport report = step(world);
        REQUIRE(report.ok());
        if (n == 29) before = report.energy.total();
        if (n > 29) work += report.energy.work;
        if (n > 29) taken += report.energy.dissipated() - report.energy.residual_work;
        after = report.energy.total();
    }
    const double gained = after - before;
    CHECK(gained == Approx(0.2 * 0.04 * 9.81 * 0.2 * 30.0 / 240.0).epsilon(0.02));
    // Contacts that come and go dissipate 5 to 10 % of the work, depending on where the sheet starts.
    CHECK(taken > 0.0);
    CHECK(work - taken == Approx(gained).epsilon(1e-6));
}

TEST_CASE("A stage that fails is redone in halves by every scheme") {
    for (const Scheme scheme : implicit_schemes) {
        World world = sheet({.time_step = 1.0 / 60.0, .scheme = scheme, .newton_tolerance = 1e-6, .newton_iterations = 3});
        Random random(5);
        for (int i = 0; i < 25; ++i) world.state.cloth.velocities.set(i, random.point(2.0));
        const StepReport report = step(world);
        CAPTURE(static_cast<int>(scheme), report.residual);
        CHECK(report.status == StepStatus::halved);
        CHECK(report.smallest_dt < 1.0 / 60.0);
    }
}

TEST_CASE("The error estimate of adaptive steps is near the true error") {
    for (const Scheme scheme : implicit_schemes) {
        const auto pendulum = [&](const StepSettings& settings) {
            World world = linked_world(linked_masses({0.1, 0.2}, {{0, 1, 1.0, 50.0, 0.3}}), {Vec3(0, 0, 0), Vec3(1.0, 0, 0)}, {0},
                                       settings);
            world.state.cloth.velocities.set(1, Vec3(0.5, -0.3, 0.2));
            plan_step(world);
            return world;
        };
        World world = pendulum({.time_step = 0.02, .adaptive = true, .scheme = scheme, .newton_tolerance = 1e-10});
        World exact = pendulum({.time_step = 1e-4, .scheme = Scheme::rk4});
        double estimated = 0.0;
        if (scheme == Scheme::bdf2) {  // its first step is one of TR-BDF2
            for (World* one : {&world, &exact}) REQUIRE(one->scene.plan.implicit == (one == &world));
            advance_world(world, {0.0, 0.5}, true);
            for (int n = 0; n < 100; ++n) REQUIRE(step(exact).ok());
            const Vec3 off = world.state.cloth.positions.at(1) - exact.state.cloth.positions.at(1);
            estimated = advance_world(world, {0.5, 1.0}, true).error;
            for (int n = 0; n < 100; ++n) REQUIRE(step(exact).ok());
            CHECK(off.norm() < 1e-5);
        } else {
            estimated = advance_world(world, {0.0, 1.0}, true).error;
            for (int n = 0; n < 200; ++n) REQUIRE(step(exact).ok());
        }
        const double error =
            (world.state.cloth.positions.at(1) - exact.state.cloth.positions.at(1)).norm() * std::sqrt(0.2 / 0.3);
        CAPTURE(static_cast<int>(scheme), error, estimated);
        CHECK(estimated > 0.4 * error);
        CHECK(estimated < 4.0 * error);
    }
}

}  // namespace percale::test::implicit_substep_test
