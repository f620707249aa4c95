#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

namespace percale::test::impulse_law_test {

// Impulses of cloth on obstacles in a step, against the momentum that it lost.

namespace {

constexpr double g = 9.81;

Simulation on_meshes(StepSettings settings) {
    settings.newton_tolerance = 1e-11;
    settings.newton_iterations = 200;
    settings.skip = false;
    return Simulation(settings, backends().back().make_detector());
}

const std::vector<StepSettings> ways_of_contact = {
    {}, {.contact_response = ContactResponse::projection}, {.scheme = Scheme::tr_bdf2}};

/// Velocities of a cloth before a step, m/s.
struct Momentum {
    std::vector<Vec3> velocities;
    Momentum(const Simulation& of, ClothId cloth) : velocities(of.velocities(cloth).begin(), of.velocities(cloth).end()) {}
};

/// A sheet that turns and falls on a ball above a plane.
struct Falling {
    Simulation simulation;
    ClothId cloth;
    ObstacleId ball, plane;

    Falling(const StepSettings& settings, double restitution) : simulation(on_meshes(settings)) {
        const Fabric fabric{.area_density = 0.2,
                            .thickness = 0.005,
                            .self_contact = true,
                            .springs = {.structural = 200.0, .shear = 100.0, .bend = 2.0},
                            .spring_damping = 0.5};
        cloth = simulation.add_cloth(make_grid(0.3, 0.3, 8, 8), fabric, {.translation = {0.05, 0.14, 0.02}});
        ball = simulation.add_obstacle(make_sphere(0.1, 3), {}, {.friction = 0.4, .restitution = restitution, .name = "ball"});
        plane = simulation.add_obstacle(make_plane(2.0), {.translation = {0, -0.12, 0}}, {.friction = 0.3, .name = "plane"});
        std::vector<Vec3> velocities;
        for (const Vec3& x : simulation.positions(cloth)) velocities.push_back(Vec3(0, -1, 0) + Vec3(0, 3, 0).cross(x));
        simulation.set_velocities(cloth, velocities);
        simulation.keep_impulses();
    }

    Vec3 impulse() const { return simulation.impulse_on(ball) + simulation.impulse_on(plane); }

    /// The momentum that a vertex gained in the step besides its weight, N s.
    Vec3 gain(const Momentum& before, std::size_t i) const {
        const Vec3 by_weight(0, -g / 60.0, 0);
        return simulation.masses(cloth)[i] * (simulation.velocities(cloth)[i] - before.velocities[i] - by_weight);
    }
    Vec3 gained(const Momentum& before) const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < before.velocities.size(); ++i) sum += gain(before, i);
        return sum;
    }
    Vec3 gained_about(const Vec3& about, const Momentum& before) const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < before.velocities.size(); ++i)
            sum += (simulation.positions(cloth)[i] - about).cross(gain(before, i));
        return sum;
    }
};

}  // namespace

TEST_CASE("The impulses on obstacles in a step are what the cloth gained besides its weight, impacts included", "[law]") {
    for (const StepSettings& settings : ways_of_contact) {
        for (const double restitution : {0.0, 0.6}) {
            Falling scene(settings, restitution);
            double given = 0.0, worst = 0.0, off = 0.0;
            for (int n = 0; n < 36; ++n) {
                const Momentum before(scene.simulation, scene.cloth);
                const StepReport report = scene.simulation.step();
                REQUIRE(report.ok());
                given += scene.impulse().norm();
                worst = std::max(worst, (scene.gained(before) + scene.impulse()).norm());
                // In backward Euler forces act at the end of the step, so that internal forces have no moment.
                if (settings.scheme != Scheme::backward_euler || report.halvings > 0) continue;
                const Vec3 p(0.3, -0.2, 0.1);
                const Vec3 turned =
                    scene.simulation.angular_impulse_on(scene.ball, p) + scene.simulation.angular_impulse_on(scene.plane, p);
                off = std::max(off, (scene.gained_about(p, before) + turned).norm());
            }
            CAPTURE(static_cast<int>(settings.scheme), static_cast<int>(settings.contact_response), restitution, given, worst,
                    off);
            CHECK(given > 0.01);
            CHECK(worst < 1e-9 * given);
            CHECK(off < 1e-9 * given);
        }
    }
}

TEST_CASE("Impulses are of the whole step, however it is divided, and those of a failed step are zero", "[law]") {
    std::vector<StepSettings> ways = ways_of_contact;
    for (const StepSettings& way : ways_of_contact) {
        ways.push_back(way);
        ways.back().adaptive = true;
        ways.back().tolerance = 1e-2;
    }
    for (const StepSettings& settings : ways) {
        Falling scene(settings, 0.3);
        double given = 0.0, worst = 0.0;
        int pieces = 0;
        const auto step = [&] {
            const Momentum before(scene.simulation, scene.cloth);
            const StepReport report = scene.simulation.step();
            REQUIRE(report.ok());
            given += scene.impulse().norm();
            worst = std::max(worst, (scene.gained(before) + scene.impulse()).norm());
            pieces += report.parts + report.halvings;
        };
        for (int n = 0; n < 15; ++n) step();
        // The ball jumps up and aside, by 30 thicknesses a step.
        for (int n = 1; n <= 4; ++n) {
            scene.simulation.move_obstacle(scene.ball, {.translation = {0.03 * n, 0.15 * n, 0}});
            step();
        }
        CAPTURE(static_cast<int>(settings.scheme), static_cast<int>(settings.contact_response), settings.adaptive, given, worst,
                pieces);
        CHECK(pieces > 19);
        CHECK(worst < 1e-9 * given);

        scene.simulation.set_work_limit(1);
        scene.simulation.move_obstacle(scene.ball, {.translation = {0.12, 0.65, 0}});
        CHECK_FALSE(scene.simulation.step().ok());
        CHECK(scene.impulse() == Vec3::Zero());
    }
}

TEST_CASE("Cloth that sleeps still gives its weight, by obstacles that are added and removed, and a request changes nothing",
          "[law]") {
    const auto rest = [](bool keep) {
        Simulation simulation({}, backends().back().make_detector());
        const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 5, 5), {}, {.translation = {0, 0.0045, 0}});
        simulation.add_obstacle(make_sphere(0.1, 1), {.translation = {3, 0, 0}}, {.name = "far"});
        const ObstacleId plane = simulation.add_obstacle(make_plane(1.0), {}, {.name = "plane"});
        simulation.keep_impulses(keep);
        double mass = 0.0;
        for (const double m : simulation.masses(cloth)) mass += m;
        StepReport report;
        for (int n = 0; n < 400; ++n) report = simulation.step();
        CHECK(report.slept);
        if (!keep) return simulation.state_hash();
        const Vec3 weight(0, -mass * g / 60.0, 0), given = simulation.impulse_on(plane);
        CHECK((given - weight).norm() < 1e-3 * weight.norm());
        CHECK((given - simulation.force_on(plane) / 60.0).norm() < 1e-12);
        const Vec3 p(1, 2, 3);
        CHECK((simulation.angular_impulse_on(plane, p) - simulation.torque_on(plane, p) / 60.0).norm() < 1e-12);
        const auto hash = simulation.state_hash();
        simulation.remove_obstacle({0});
        CHECK(simulation.impulse_on(plane) == given);
        const ObstacleId late = simulation.add_obstacle(make_sphere(0.1, 1), {.translation = {3, 0, 0}}, {.name = "late"});
        CHECK(simulation.impulse_on(late) == Vec3::Zero());
        simulation.remove_obstacle(late);
        simulation.restore(simulation.save());
        CHECK(simulation.impulse_on(plane) == Vec3::Zero());
        simulation.keep_impulses(false);
        CHECK_THROWS_AS(simulation.impulse_on(plane), SceneError);
        CHECK_THROWS_AS(simulation.angular_impulse_on(plane, p), SceneError);
        return hash;
    };
    CHECK(rest(true) == rest(false));
}

}  // namespace percale::test::impulse_law_test
