#include <cmath>

#include "engine/schemes/schemes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::conservation_test {
namespace {

/// A free sheet, stretched and with random velocities.
struct ThrownSheet {
    Simulation simulation;
    ClothId cloth;

    ThrownSheet(const StepSettings& settings, double damping) : simulation(settings) {
        Fabric fabric = sheet_fabric();
        fabric.spring_damping = damping;
        cloth = simulation.add_cloth(make_grid(0.6, 0.6, 7, 7), fabric);
        Random random(31);
        std::vector<Vec3> velocities = random_points(random, 49, 2.0), positions = make_grid(0.6, 0.6, 7, 7).vertices;
        for (Vec3& v : velocities) v += Vec3(1.0, 0.5, -2.0);
        for (Vec3& x : positions) x += random.point(0.02);
        simulation.set_positions(cloth, positions);
        simulation.set_velocities(cloth, velocities);
    }

    Vec3 momentum() const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < 49; ++i) sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
        return sum;
    }
    Vec3 angular_momentum() const {
        Vec3 sum = Vec3::Zero();
        const auto positions = simulation.positions(cloth), velocities = simulation.velocities(cloth);
        for (std::size_t i = 0; i < 49; ++i) sum += simulation.masses(cloth)[i] * positions[i].cross(velocities[i]);
        return sum;
    }
};

}  // namespace

TEST_CASE("A free cloth keeps its momentum to 1e-12 a step in every scheme", "[law]") {
    for (const Scheme scheme : all_schemes) {
        const double dt = facts_of(scheme).implicit ? 1.0 / 480.0 : 2e-4;
        double worst = 0.0;
        ThrownSheet sheet({.time_step = dt, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()}, 0.1);
        const Vec3 start = sheet.momentum();
        for (int n = 0; n < 20; ++n) {
            const Vec3 before = sheet.momentum();
            REQUIRE(sheet.simulation.step().ok());
            worst = std::max(worst, (sheet.momentum() - before).norm() / start.norm());
        }
        check_law("free cloth, " + std::string(facts_of(scheme).word) + ": relative change of momentum in a step", worst, 1e-12);
    }
}

TEST_CASE("Symplectic Euler and implicit midpoint keep angular momentum, along-spring damping included", "[law]") {
    const auto change = [](Scheme scheme, double dt, int steps) {
        ThrownSheet sheet({.time_step = dt, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()}, 0.1);
        const Vec3 before = sheet.angular_momentum();
        for (int n = 0; n < steps; ++n) REQUIRE(sheet.simulation.step().ok());
        return (sheet.angular_momentum() - before).norm() / before.norm();
    };
    check_law("free cloth with damping, symplectic_euler, 500 steps: relative change of angular momentum",
              change(Scheme::symplectic_euler, 2e-4, 500), 1e-12);
    check_law("free cloth with damping, implicit_midpoint, 100 steps: relative change of angular momentum",
              change(Scheme::implicit_midpoint, 1.0 / 480.0, 100), 1e-9);
}

TEST_CASE("RK4 keeps the energy of an undamped free sheet, and damping only reduces it", "[law]") {
    ThrownSheet undamped({.time_step = 2e-5, .scheme = Scheme::rk4}, 0.0),
        damped({.time_step = 2e-5, .scheme = Scheme::rk4, .measure = StepMeasures::all}, 0.1);
    const double start = undamped.simulation.energy().total();
    double before = damped.simulation.energy().total();
    for (int n = 0; n < 2000; ++n) {
        REQUIRE(undamped.simulation.step().ok());
        const StepReport report = damped.simulation.step();
        REQUIRE(report.energy.total() <= before + 1e-9);
        before = report.energy.total();
    }
    check_law("undamped free sheet, rk4, 2000 steps: relative change of energy",
              std::abs(undamped.simulation.energy().total() / start - 1.0), 1e-6);
    CHECK(before < start - 0.01);
}

TEST_CASE("Springs far stiffer than the step do not amplify the solver's residual", "[law]") {
    for (const bool adaptive : {false, true}) {
        Fabric fabric = sheet_fabric();
        fabric.springs = {.structural = 1e8, .shear = 5e7, .bend = 1e6};
        Simulation simulation(
            {.time_step = 1.0 / 60.0, .adaptive = adaptive, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::all});
        const ClothId cloth = simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), fabric);
        for (const int corner : {0, 4}) simulation.pin(cloth, corner);
        double worst = 0.0, fallen = 0.0;
        for (int n = 0; n < 40; ++n) {
            const StepEnergy energy = simulation.step().energy;
            worst = std::max(worst, energy.total());
            fallen = std::max(fallen, -energy.gravity);
        }
        check_law(std::string("hanging sheet of 1e8 N/m, tr_bdf2") + (adaptive ? ", adaptive" : "") + ": gain of what it fell",
                  worst / fallen, 0.02);
    }
}

TEST_CASE("Backward Euler never gains energy, at small steps and large ones", "[law]") {
    double worst = 0.0;
    for (const double dt : {1.0 / 960.0, 1.0 / 60.0, 0.5}) {
        ThrownSheet sheet({.time_step = dt, .newton_tolerance = 1e-8, .measure = StepMeasures::all}, 0.1);
        double before = sheet.simulation.energy().total();
        for (int n = 0; n < 60; ++n) {
            const StepReport report = sheet.simulation.step();
            REQUIRE(report.ok());
            worst = std::max(worst, report.energy.total() - before);
            before = report.energy.total();
        }
    }
    check_law("thrown sheet, backward Euler at 1/960 to 0.5 s: largest gain of energy in a step, J", worst, 1e-7);
}

}  // namespace percale::test::conservation_test
