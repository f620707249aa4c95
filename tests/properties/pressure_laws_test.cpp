#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/plane_detector.h"

namespace percale::test::pressure_laws_test {
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

double volume_of(const TriangleMesh& mesh, std::span<const Vec3> x) {
    double volume = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) volume += x[a].dot(x[b].cross(x[c])) / 6.0;
    return volume;
}

/// The stretch at which a sphere with gas comes to rest.
double rest_stretch(const Fabric& fabric, int level, double start_stretch = 1.0) {
    Simulation simulation({.time_step = 1.0 / 60.0, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
    const TriangleMesh mesh = make_sphere(radius, level);
    const ClothId ball = simulation.add_cloth(mesh, fabric);
    std::vector<Vec3> start = mesh.vertices;
    for (Vec3& x : start) x *= start_stretch;
    simulation.set_positions(ball, start);
    double speed = 1.0;
    for (int n = 0; n < 600 && speed > 1e-5; ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        speed = report.largest_speed;
    }
    REQUIRE(speed <= 1e-5);
    return mean_radius(simulation.positions(ball)) / radius;
}

}  // namespace

TEST_CASE("Pressure stretches a sphere of known modulus by the law of its membrane, the better the finer its mesh", "[law]") {
    Fabric fabric = rubber();
    fabric.pressure = sphere_pressure();
    const double coarse = std::abs(rest_stretch(fabric, 2) - stretch), fine = std::abs(rest_stretch(fabric, 3) - stretch);
    check_law("stretch of a sphere under pressure, 642 vertices: error over stretch - 1", fine / (stretch - 1.0), 0.03);
    check_law_between("the same with 162 vertices, times as large (4: second order)", coarse / fine, 3.0, 5.0);
}

TEST_CASE("Gas with a known rest stretch of a sphere reaches it, from a ball that is too small and from one too large", "[law]") {
    // p_0 (V_0/V - 1) = p at the volume of that stretch.
    Fabric fabric = rubber();
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius * stretch, 3);
    fabric.gas_volume = volume * (1.0 + sphere_pressure() / 101325.0);
    const double from_below = rest_stretch(fabric, 3), from_above = rest_stretch(fabric, 3, 1.3);
    check_law("stretch of a sphere by an amount of gas, 642 vertices: error over stretch - 1",
              std::abs(from_below - stretch) / (stretch - 1.0), 0.03);
    check_law("the same from a ball that is too large, against that", std::abs(from_above - from_below) / (stretch - 1.0), 1e-3);
}

TEST_CASE("A ball of gas that falls on a plate keeps its volume, and the ledger closes in every scheme with contact", "[law]") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::tr_bdf2}) {
        Fabric fabric = rubber();
        const TriangleMesh mesh = make_sphere(radius, 2);
        fabric.gas_volume = volume_of(mesh, mesh.vertices);
        Simulation simulation({.time_step = 1.0 / 120.0, .scheme = scheme, .measure = StepMeasures::ledger},
                              std::make_unique<PlaneDetector>());
        const ClothId ball = simulation.add_cloth(mesh, fabric, {.translation = {0.0, 0.25, 0.0}});
        simulation.add_obstacle(make_plane(2.0), {});
        double closure = 0.0, least = 1.0, most = 0.0;
        int contacts = 0;
        for (int n = 0; n < 90; ++n) {
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            closure = std::max(closure, report.energy.closure());
            contacts += report.contacts;
            const double volume = volume_of(mesh, simulation.positions(ball));
            least = std::min(least, volume / *fabric.gas_volume);
            most = std::max(most, volume / *fabric.gas_volume);
        }
        CHECK(contacts > 0);
        const std::string name = scheme == Scheme::tr_bdf2 ? "tr_bdf2" : "backward_euler";
        check_law("ledger of a bouncing ball of gas, " + name, closure, 1e-9);
        // A few hundred pascals over the 101325 of the air.
        check_law("volume of a bouncing ball of gas, largest change, " + name, std::max(1.0 - least, most - 1.0), 0.01);
    }
}

TEST_CASE("Explicit schemes are stable up to the step of the plan, which gas makes shorter", "[law]") {
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

TEST_CASE("A ball that slides over a plate comes to roll as a hollow sphere does, however hard it is pumped up", "[law]") {
    // Friction takes v and gives spin until v = w r: m (v_0 - v) r = 2/3 m r^2 w, v = 3/5 v_0.
    for (const double pressure : {500.0, 5000.0}) {
        Fabric fabric = rubber();
        fabric.stretch_stiffness = {2e4, 2e4};
        fabric.pressure = pressure;
        fabric.damping_time = 1e-3;
        Simulation simulation({.time_step = 1.0 / 240.0}, std::make_unique<PlaneDetector>());
        const ClothId ball = simulation.add_cloth(make_sphere(radius, 3), fabric, {.translation = {0.0, radius + 0.006, 0.0}});
        simulation.add_obstacle(make_plane(20.0), {}, {.friction = 0.3});
        for (int n = 0; n < 120; ++n) REQUIRE(simulation.step().ok());
        std::vector<Vec3> velocities(simulation.positions(ball).size(), Vec3(1.0, 0.0, 0.0));
        simulation.set_velocities(ball, velocities);
        for (int n = 0; n < 120; ++n) REQUIRE(simulation.step().ok());
        Vec3 mean = Vec3::Zero(), centre = Vec3::Zero();
        const double share = 1.0 / static_cast<double>(velocities.size());
        for (const Vec3& v : simulation.velocities(ball)) mean += share * v;
        for (const Vec3& x : simulation.positions(ball)) centre += share * x;
        double spin = 0.0, size = 0.0;
        for (std::size_t i = 0; i < velocities.size(); ++i) {
            const Vec3 arm = simulation.positions(ball)[i] - centre;
            spin += arm.cross(simulation.velocities(ball)[i] - mean).z();
            size += arm.x() * arm.x() + arm.y() * arm.y();
        }
        const std::string name = "ball pumped to " + figure(pressure) + " Pa, ";
        check_law_between(name + "speed over that at which it slid (3/5)", mean.x(), 0.5, 0.65);
        check_law_between(name + "spin times radius over speed (1)", -spin / size * centre.y() / mean.x(), 0.9, 1.1);
    }
}

}  // namespace percale::test::pressure_laws_test
