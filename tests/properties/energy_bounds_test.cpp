// Upper bounds of the energy that a step of backward Euler can gain.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::energy_bounds_test {
namespace {

constexpr int side = 6;
constexpr double width = 0.5;  // m

Simulation sheet(double dt, double stiffness, const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) {
    Fabric fabric = sheet_fabric();
    fabric.springs = {.structural = stiffness, .shear = 0.5 * stiffness, .bend = 0.01 * stiffness};
    Simulation simulation({.time_step = dt, .newton_tolerance = 1e-9, .newton_iterations = 200, .measure = StepMeasures::ledger});
    const ClothId cloth = simulation.add_cloth(make_grid(width, width, side, side), fabric);
    simulation.set_positions(cloth, positions);
    simulation.set_velocities(cloth, velocities);
    return simulation;
}

void pin_boundary(Simulation& simulation) {
    for (int c = 0; c < side; ++c)
        for (const int vertex : {c, side * (side - 1) + c, side * c, side * c + side - 1}) simulation.pin({0}, vertex);
}

/// m <a, b>, J.
double product(const Simulation& simulation, std::span<const Vec3> a, std::span<const Vec3> b) {
    const std::span<const double> masses = simulation.masses({0});
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += masses[i] * a[i].dot(b[i]);
    return sum;
}

bool all_taut(std::span<const Vec3> positions) {
    const std::vector<Vec3> rest = make_grid(width, width, side, side).vertices;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double length = (rest[i] - rest[j]).norm();
            const bool spring = length < 2.01 * width / (side - 1);
            if (spring && (positions[i] - positions[j]).norm() < length) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("Backward Euler gains nothing while all springs are stretched, at every step and stiffness", "[law]") {
    double worst = -1.0;
    for (const double dt : {1e-4, 1e-2, 1.0}) {
        for (const double stiffness : {1.0, 1e4, 1e8}) {
            Random random(7);
            std::vector<Vec3> velocities = random_points(random, side * side, 0.3);
            Simulation simulation = sheet(dt, stiffness, make_grid(1.3 * width, 1.3 * width, side, side).vertices, velocities);
            pin_boundary(simulation);
            for (int n = 0; n < 5; ++n) {
                const StepEnergy before = simulation.energy();
                const StepReport report = simulation.step();
                REQUIRE(report.ok());
                REQUIRE(all_taut(simulation.positions({0})));
                const double gain =
                    report.energy.total() - before.total() - report.energy.work - std::abs(report.energy.residual_work);
                worst = std::max(worst, gain / (before.kinetic + before.elastic));
            }
        }
    }
    check_law("stretched sheet, backward Euler: largest gain in a step, of its energy", worst, 1e-12);
}

TEST_CASE("In any state a step of backward Euler gains at most <v, v_n> - T_n", "[law]") {
    double worst = 0.0;
    int steps = 0;
    for (const double dt : {1e-4, 1e-3, 1e-2, 1e-1}) {
        for (const double stiffness : {1.0, 1e2, 1e4}) {
            Random random(11);
            const std::vector<Vec3> places = random_points(random, side * side, 0.05);
            Simulation simulation = sheet(dt, stiffness, places, random_points(random, side * side, 1.0));
            for (int n = 0; n < 6; ++n) {
                const std::vector<Vec3> velocities = copy(simulation.velocities({0}));
                const double before = simulation.energy().total();
                const StepReport report = simulation.step();
                if (report.status != StepStatus::ok) break;
                const double bound = product(simulation, velocities, simulation.velocities({0})) -
                                     0.5 * product(simulation, velocities, velocities) + std::abs(report.energy.residual_work);
                const double size = report.energy.kinetic + report.energy.elastic;
                worst = std::max(worst, (report.energy.total() - before - bound) / size);
                ++steps;
            }
        }
    }
    CHECK(steps > 30);
    check_law("crumpled sheet, backward Euler: gain in a step beyond <v, v_n> - T_n, of its energy", worst, 1e-9);
}

}  // namespace percale::test::energy_bounds_test
