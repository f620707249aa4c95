#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/plane_detector.h"

namespace percale::test {
namespace {

constexpr double radius = 0.2, stretch_stiffness = 500.0, poisson_ratio = 0.3, stretch = 1.2;

/// Pa. A sphere of a St. Venant-Kirchhoff membrane stores Y/(1 - nu) e^2 per area at rest, e = (stretch^2 - 1)/2. With
/// dU = p dV: p = Y (stretch^2 - 1)/((1 - nu) radius stretch).
double sphere_pressure() { return stretch_stiffness * (stretch * stretch - 1.0) / ((1.0 - poisson_ratio) * radius * stretch); }

Fabric rubber() {
    Fabric fabric;
    fabric.area_density = 0.3;
    fabric.stretch_stiffness = {stretch_stiffness, stretch_stiffness};
    fabric.poisson_ratio = poisson_ratio;
    fabric.damping_time = 0.02;
    return fabric;
}

double mean_radius(std::span<const Vec3> positions) {
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : positions) centre += x / static_cast<double>(positions.size());
    double sum = 0.0;
    for (const Vec3& x : positions) sum += (x - centre).norm();
    return sum / static_cast<double>(positions.size());
}

/// The stretch at which a filled sphere comes to rest.
double rest_stretch(const Fabric& fabric, int level) {
    Simulation simulation({.time_step = 1.0 / 60.0, .gravity = Vec3::Zero()});
    const ClothId ball = simulation.add_cloth(make_sphere(radius, level), fabric);
    for (int n = 0; n < 300; ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        if (n > 10 && report.largest_speed < 1e-6) break;
    }
    return mean_radius(simulation.positions(ball)) / radius;
}

}  // namespace

TEST_CASE("A sphere of known modulus is stretched by pressure as its membrane says, the better the finer its mesh", "[law]") {
    Fabric fabric = rubber();
    fabric.pressure = sphere_pressure();
    const double coarse = std::abs(rest_stretch(fabric, 2) - stretch), fine = std::abs(rest_stretch(fabric, 3) - stretch);
    check_law("stretch of a sphere under pressure, 642 vertices: error over stretch - 1", fine / (stretch - 1.0), 0.03);
    check_law_between("the same with 162 vertices, times as large (4: second order)", coarse / fine, 3.0, 5.0);
}

TEST_CASE("Gas that would press a sphere to a known stretch does, from a ball at rest and from one without a stretch", "[law]") {
    // p_0 (V_0/V - 1) = p at the volume of that stretch.
    Fabric fabric = rubber();
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius * stretch, 3);
    fabric.gas_volume = volume * (1.0 + sphere_pressure() / 101325.0);
    const double with_gas = rest_stretch(fabric, 3);
    check_law("stretch of a sphere by an amount of gas, 642 vertices: error over stretch - 1",
              std::abs(with_gas - stretch) / (stretch - 1.0), 0.03);
}

TEST_CASE("A ball of gas that falls on a plate keeps its volume, and the ledger closes in every scheme with contact", "[law]") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::tr_bdf2}) {
        Fabric fabric = rubber();
        fabric.gas_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
        Simulation simulation({.time_step = 1.0 / 120.0, .scheme = scheme, .measure = StepMeasures::ledger},
                              std::make_unique<PlaneDetector>());
        const ClothId ball = simulation.add_cloth(make_sphere(radius, 2), fabric, {.translation = {0.0, 0.25, 0.0}});
        simulation.add_obstacle(make_plane(2.0), {});
        double closure = 0.0, least = 1.0, most = 0.0;
        int contacts = 0;
        for (int n = 0; n < 90; ++n) {
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            closure = std::max(closure, report.energy.closure());
            contacts += report.contacts;
            double volume = 0.0;
            const std::span<const Vec3> x = simulation.positions(ball);
            for (const auto& [a, b, c] : make_sphere(radius, 2).triangles) volume += x[a].dot(x[b].cross(x[c])) / 6.0;
            least = std::min(least, volume / *fabric.gas_volume);
            most = std::max(most, volume / *fabric.gas_volume);
        }
        CHECK(contacts > 0);
        const std::string name = scheme == Scheme::tr_bdf2 ? "tr_bdf2" : "backward_euler";
        check_law("ledger of a bouncing ball of gas, " + name, closure, 1e-9);
        // A few hundred pascals over the 101325 of the air.
        check_law("volume of a bouncing ball of gas, largest change, " + name, std::max(1.0 - least, most - 1.0), 0.05);
    }
}

TEST_CASE("Explicit schemes are stable up to the step that the plan tells, which gas makes shorter", "[law]") {
    Fabric fabric = rubber();
    fabric.damping_time = 0.0;
    const auto plan_step = [&](double time_step) {
        Simulation simulation({.time_step = time_step, .scheme = Scheme::rk4, .gravity = Vec3::Zero()});
        simulation.add_cloth(make_sphere(radius, 2), fabric);
        return simulation.plan().stable_step;
    };
    const double without = plan_step(1e-5);
    fabric.gas_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    const double with_gas = plan_step(1e-5);
    check_law_between("longest stable step of a ball with gas over that without", with_gas / without, 0.5, 0.9);
    for (const double share : {0.9, 1.3}) {
        Simulation simulation({.time_step = share * with_gas, .scheme = Scheme::rk4, .gravity = Vec3::Zero()});
        simulation.add_cloth(make_sphere(radius, 2), fabric);
        bool stable = true;
        for (int n = 0; n < 3000 && stable; ++n) stable = simulation.step().ok() && simulation.energy().kinetic < 10.0;
        CHECK(stable == (share < 1.0));
    }
}

}  // namespace percale::test
