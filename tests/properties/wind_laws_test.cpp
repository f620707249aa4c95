#include "engine/schemes/schemes.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::wind_laws_test {
namespace {

constexpr double g = 9.81, air = 1.2, area_density = 0.2;

Fabric blown_fabric(double drag_normal, double drag_tangential = 0.0) {
    Fabric fabric = sheet_fabric();
    fabric.area_density = area_density;
    fabric.drag_normal = drag_normal;
    fabric.drag_tangential = drag_tangential;
    return fabric;
}

}  // namespace

TEST_CASE("A flat sheet that falls through still air follows v = w tanh(g t/w)") {
    const double limit = std::sqrt(2.0 * area_density * g / (air * 1.5));
    struct Case {
        Scheme scheme;
        double time_step, tolerance;
    };
    for (const auto& [scheme, time_step, tolerance] : {Case{Scheme::rk4, 1e-3, 1e-9}, Case{Scheme::backward_euler, 1e-3, 3e-3},
                                                       Case{Scheme::backward_euler, 1.0 / 60.0, 5e-2}}) {
        for (const bool grid : {true, false}) {
            Simulation simulation({.time_step = time_step, .scheme = scheme});
            Fabric fabric = blown_fabric(1.5);
            fabric.springs = {.structural = 20.0, .shear = 0.0, .bend = 0.0};
            fabric.spring_damping = 0.0;
            const ClothId cloth = simulation.add_cloth(grid ? make_grid(0.5, 0.5, 6, 6) : irregular_sheet(0.5, 300), fabric);
            simulation.set_wind(Vec3::Zero());
            while (simulation.time() < 0.3) REQUIRE(simulation.step().ok());
            const double expected = limit * std::tanh(g * simulation.time() / limit);
            for (const Vec3& v : simulation.velocities(cloth)) CHECK(-v.y() == Approx(expected).epsilon(tolerance));
        }
    }
}

TEST_CASE("The work of wind on a free sheet is its kinetic energy, exactly so under the trapezoid", "[law]") {
    for (const Scheme scheme : {Scheme::trapezoid, Scheme::tr_bdf2, Scheme::implicit_midpoint}) {
        Simulation simulation({.time_step = 0.01,
                               .scheme = scheme,
                               .newton_tolerance = 1e-12,
                               .measure = StepMeasures::ledger,
                               .gravity = Vec3::Zero()});
        simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), blown_fabric(1.5));
        simulation.set_wind({0.0, 8.0, 0.0});
        double missing = 0.0;
        for (int n = 0; n < 10; ++n) {
            const double before = simulation.energy().kinetic;
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            const double gained = report.energy.kinetic - before, lost = report.energy.work - gained;
            missing = std::max(missing, std::abs(lost) / gained);
            CHECK(report.energy.dissipated_integrator == Approx(lost).margin(1e-10 * gained));
        }
        check_law("sheet blown away, " + std::string(facts_of(scheme).word) + ": work of wind less what it gave, relative",
                  missing, scheme == Scheme::tr_bdf2 ? 0.06 : 1e-10);
    }
}

TEST_CASE("Without wind there is no air, and no cost for it") {
    const auto fall = [](bool with_wind, double density) {
        Simulation simulation({.air_density = density});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 6, 6), blown_fabric(1.5));
        simulation.pin(cloth, 0);
        if (with_wind) simulation.set_wind({3.0, 0.0, 0.0});
        for (int n = 0; n < 20; ++n) simulation.step();
        return simulation.state_hash();
    };
    CHECK(fall(false, 1.2) == fall(false, 5.0));
    CHECK(fall(true, 1.2) != fall(false, 1.2));
}

TEST_CASE("A strip that hangs in a level wind stands straight where weight and drag balance across it") {
    for (const double speed : {1.0, 2.0}) {
        Fabric fabric = blown_fabric(1.2);
        fabric.springs = {.structural = 1e5, .shear = 1e4, .bend = 0.0};
        Simulation simulation({.time_step = 0.1});
        // Hanging down in the plane z = 0, its surface towards the wind.
        const ClothId cloth =
            simulation.add_cloth(make_grid(0.2, 0.5, 3, 6), fabric, {.rotation = {std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0}});
        for (int column = 0; column < 3; ++column) simulation.pin(cloth, 15 + column);
        simulation.set_wind({0.0, 0.0, speed});
        for (int n = 0; n < 300; ++n) REQUIRE(simulation.step().ok());
        const std::span<const Vec3> x = simulation.positions(cloth);
        REQUIRE(x[15].y() > x[0].y());
        double low = 0.0, high = 1.57;  // rho_s g sin a = 1/2 rho C U^2 cos^2 a
        for (int k = 0; k < 60; ++k) {
            const double angle = 0.5 * (low + high), cosine = std::cos(angle);
            (area_density * g * std::sin(angle) < 0.5 * air * 1.2 * speed * speed * cosine * cosine ? low : high) = angle;
        }
        for (int row = 0; row < 5; ++row) {
            const Vec3 down = x[3 * row + 1] - x[3 * (row + 1) + 1];
            CHECK(std::atan2(down.z(), -down.y()) == Approx(low).epsilon(2e-3));
        }
        std::printf("strip in a wind of %g m/s: %.2f degrees (exact %.2f)\n", speed,
                    57.29578 * std::atan2((x[1] - x[16]).z(), (x[16] - x[1]).y()), 57.29578 * low);
    }
}

TEST_CASE("Energy never rises beyond the work of the wind") {
    Random random(3);
    for (const bool pinned : {true, false}) {
        Simulation simulation({.newton_tolerance = 1e-8, .measure = StepMeasures::all});
        const ClothId cloth = simulation.add_cloth(make_grid(1.0, 0.6, 13, 9), blown_fabric(1.5, 0.1));
        if (pinned) simulation.pin(cloth, 0);
        if (pinned) simulation.pin(cloth, 12);
        double before = simulation.energy().total();
        for (int n = 0; n < 60; ++n) {
            if (n % 10 == 0) simulation.set_wind(random.point(12.0));
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            CHECK(report.energy.total() <= before + report.energy.work + 1e-9);
            before = report.energy.total();
        }
    }
}

TEST_CASE("Wind that changes wakes cloth, and a wind out of range is refused") {
    Simulation simulation({});
    const ClothId cloth = simulation.add_cloth(make_grid(0.1, 0.1, 3, 3), sheet_fabric());
    for (int i = 0; i < 9; ++i) simulation.pin(cloth, i);
    for (int n = 0; n < 60; ++n) simulation.step();
    REQUIRE(simulation.step().slept);
    simulation.set_wind({1.0, 0.0, 0.0});
    CHECK_FALSE(simulation.step().slept);
    CHECK(scene_error([&] {
              simulation.set_wind({2000.0, 0.0, 0.0});
          }) == "set_wind: wind = 2000 m/s is outside the allowed range -1000 ... 1000");
}

}  // namespace percale::test::wind_laws_test
