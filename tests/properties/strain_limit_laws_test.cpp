#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::strain_limit_laws_test {
namespace {

constexpr double limit = 0.05;
constexpr int columns = 5, rows = 13;

Fabric hanging_fabric() {
    Fabric fabric{.area_density = 0.3, .springs = {.structural = 20.0, .shear = 0.0, .bend = 0.0}, .spring_damping = 0.05};
    fabric.strain_limit = limit;
    return fabric;
}

/// Upright, its first row on top.
Pose upright() { return {.rotation = {std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0}}; }

struct Hanging {
    Simulation simulation;
    ClothId cloth;

    explicit Hanging(const Fabric& fabric, StepSettings settings = {}) : simulation(settings) {
        cloth = simulation.add_cloth(make_grid(0.2, 0.6, columns, rows), fabric, upright(), "strip");
        for (int i = 0; i < columns; ++i) simulation.pin(cloth, i);
    }

    double strain(int column, int row) const {  // of the edge below this vertex
        const auto x = simulation.positions(cloth);
        const int i = row * columns + column;
        return (x[i + columns] - x[i]).norm() / 0.05 - 1.0;
    }
};

/// Makes steps that must succeed; returns the largest error of their ledgers.
double worst_closure(Simulation& simulation, int steps) {
    double worst = 0.0;
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step();
        CAPTURE(report.explanation());
        REQUIRE(report.ok());
        worst = std::max(worst, report.energy.closure());
    }
    return worst;
}

}  // namespace

TEST_CASE("A strip that hangs has the strain of its load, or of its limit") {
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        Hanging strip(hanging_fabric(), {.time_step = dt, .kinetic_damping = true});
        worst_closure(strip.simulation, static_cast<int>(std::lround(6.0 / dt)));
        const auto mass = strip.simulation.masses(strip.cloth);
        int limited = 0;
        for (int column = 0; column < columns; ++column) {
            double weight = 0.0;
            for (int row = rows - 2; row >= 0; --row) {
                weight += 9.81 * mass[(row + 1) * columns + column];
                const double free = weight / (20.0 * 0.05);  // T = ks (l - l0)
                limited += free > limit;
                CHECK(strip.strain(column, row) == Approx(std::min(free, limit)).margin(2e-4));
            }
        }
        CHECK(limited > 10);
        CHECK(limited < columns * (rows - 1) - 10);
    }
}

TEST_CASE("The largest strain of a cloth is its own") {
    Hanging strip(hanging_fabric());
    Fabric soft = hanging_fabric();
    soft.strain_limit.reset();
    const ClothId other = strip.simulation.add_cloth(make_grid(0.2, 0.6, columns, rows), soft, upright(), "soft");
    for (int i = 0; i < columns; ++i) strip.simulation.pin(other, i);
    worst_closure(strip.simulation, 60);
    const double limited = strip.simulation.largest_strain(strip.cloth), free = strip.simulation.largest_strain(other);
    CHECK(limited < 1.3 * limit);
    CHECK(free > 1.5 * limit);
    CHECK(strip.simulation.largest_strain() == Approx(free).epsilon(1e-12));
}

TEST_CASE("The ledger closes and every derivative fits while limits become active and inactive") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::tr_bdf2}) {
        for (const bool moduli : {false, true}) {
            Fabric fabric = hanging_fabric();
            if (moduli) {
                fabric.springs = {.structural = 0.0};
                fabric.stretch_stiffness = {20.0, 20.0};
            }
            Simulation simulation({.scheme = scheme, .measure = StepMeasures::ledger, .check_derivatives = true});
            const ClothId cloth = simulation.add_cloth(make_grid(0.6, 0.6, 9, 9), fabric);
            simulation.pin(cloth, 0);
            simulation.pin(cloth, 8);
            CHECK(worst_closure(simulation, 60) < 1e-10);
        }
    }
}

TEST_CASE("A simulation with limits resumes in every bit, and not with another limit") {
    const auto make = [](double strain) {
        Fabric fabric = hanging_fabric();
        fabric.strain_limit = strain;
        return Hanging(fabric);
    };
    Hanging first = make(limit), second = make(limit), other = make(2.0 * limit);
    worst_closure(first.simulation, 25);
    const std::vector<std::byte> saved = first.simulation.save();
    second.simulation.restore(saved);
    worst_closure(first.simulation, 25);
    worst_closure(second.simulation, 25);
    CHECK(first.simulation.state_hash() == second.simulation.state_hash());
    CHECK_FALSE(scene_error([&] { other.simulation.restore(saved); }).empty());
}

TEST_CASE("Schemes without contact take no limit") {
    Hanging strip(hanging_fabric(), {.time_step = 1e-4, .scheme = Scheme::rk4});
    CHECK(mentions(scene_error([&] { strip.simulation.step(); }), {"rk4", "strain limit", "backward_euler"}));
}

}  // namespace percale::test::strain_limit_laws_test
