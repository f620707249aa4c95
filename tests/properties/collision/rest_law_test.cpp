#include <algorithm>
#include <cmath>
#include <functional>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/collision/contact_laws.h"

// Rest in contact is a fixed point: contact has one potential, whatever step, damping and moment are.
namespace percale::test::rest_law_test {
namespace {

constexpr double h = 0.003;

Fabric terry(double damping_time = 0.01) {
    return {.area_density = 0.4,
            .thickness = h,
            .self_contact = true,
            .friction = 0.4,
            .damping_time = damping_time,
            .stretch_stiffness = {{500.0, 500.0}},
            .bend_stiffness = 5e-5};
}

/// Cloths above a table, and what moves their pins as time goes.
struct Scene {
    Simulation simulation;
    std::vector<ClothId> cloths = {};
    std::function<void(Simulation&)> drive = [](Simulation&) {};

    explicit Scene(const StepSettings& settings) : simulation(simulation_on_meshes(settings)) {
        simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.5, .name = "table"});
    }
    void add(const TriangleMesh& mesh, double height, double damping_time = 0.01) {
        cloths.push_back(simulation.add_cloth(mesh, terry(damping_time), {.translation = Vec3(0, height, 0)}));
    }
    std::vector<Vec3> positions() const {
        std::vector<Vec3> all;
        for (const ClothId cloth : cloths) {
            const auto x = simulation.positions(cloth);
            all.insert(all.end(), x.begin(), x.end());
        }
        return all;
    }
    void step() {
        drive(simulation);
        step_well(simulation);
    }
    /// Steps until all is slower than `speed`, m/s, from `first`, s, on; false: it never is.
    bool settle(double first, double speed) {
        while (simulation.time() < 8.0) {
            step();
            if (simulation.time() > first && simulation.largest_speed() < speed) return true;
        }
        return false;
    }
};

/// From 0 to 1 between two times.
double ramp(double time, double from, double to) { return std::clamp((time - from) / (to - from), 0.0, 1.0); }

/// A sheet on the table, one edge held 2 cm above it and pulled by 10 cm.
Scene pulled_sheet(const StepSettings& settings) {
    Scene scene(settings);
    scene.add(make_grid(0.2, 0.5, 7, 15), 0.0235);
    for (int k = 0; k < 7; ++k) scene.simulation.pin(scene.cloths[0], 7 * 14 + k);
    const std::vector<Vec3> start = scene.positions();
    scene.drive = [start, cloth = scene.cloths[0]](Simulation& simulation) {
        const Vec3 moved(0, 0, 0.1 * ramp(simulation.time() + 1.0 / 60.0, 0.1, 0.6));
        for (int k = 7 * 14; k < 7 * 15; ++k) simulation.move_pin(cloth, k, start[k] + moved);
    };
    return scene;
}

/// A strip whose end is folded over and let go.
Scene folded_strip(const StepSettings& settings) {
    Scene scene(settings);
    scene.add(make_grid(0.15, 0.4, 7, 17), 0.0035);
    const std::vector<Vec3> start = scene.positions();
    scene.drive = [start, cloth = scene.cloths[0], pinned = false](Simulation& simulation) mutable {
        const double time = simulation.time() + 1.0 / 60.0, up = ramp(time, 0.1, 0.6), down = ramp(time, 0.6, 1.1);
        const Vec3 moved = up * Vec3(0, 0.1, -0.2) + down * Vec3(0, -0.085, -0.18);
        const bool held = time < 1.2, changes = held != pinned;
        pinned = held;
        for (int k = 7 * 16; k < 7 * 17; ++k) {
            if (changes && held) simulation.pin(cloth, k);
            if (changes && !held) simulation.unpin(cloth, k);
            if (held) simulation.move_pin(cloth, k, start[k] + moved);
        }
    };
    return scene;
}

/// Sheets on each other, vertex over vertex.
Scene stack(const StepSettings& settings, int sheets, int side = 4, double damping_time = 0.01) {
    Scene scene(settings);
    for (int k = 1; k <= sheets; ++k) scene.add(make_grid(0.2, 0.2, side, side), h * k, damping_time);
    return scene;
}

}  // namespace

TEST_CASE("From rest, a step of any length moves no vertex, and neither does the next", "[slow]") {
    const StepSettings exact{.time_step = 1.0 / 60.0, .newton_tolerance = 1e-10, .skip = false};
    const std::pair<double, std::function<Scene()>> scenes[] = {{0.7, [&] { return pulled_sheet(exact); }},
                                                                {1.3, [&] { return folded_strip(exact); }},
                                                                {0.1, [&] { return stack(exact, 4); }}};
    for (const auto& [first, make] : scenes) {
        Scene scene = make();
        REQUIRE(scene.settle(first, 1e-9));
        scene.drive = [](Simulation&) {};
        const std::vector<std::byte> rest = scene.simulation.save();
        const std::vector<Vec3> there = scene.positions();
        for (const double rate : {480.0, 120.0, 60.0, 30.0, 15.0}) {
            scene.simulation.restore(rest);
            scene.simulation.set_time_step(1.0 / rate);
            for (int n = 0; n < 2; ++n) {
                scene.step();
                CAPTURE(first, rate, n);
                CHECK(largest_difference(scene.positions(), there) < 1e-9);
            }
        }
    }
}

TEST_CASE("Sheets on each other rest at the same places, whatever step and damping are") {
    std::vector<Vec3> first;
    for (const double rate : {30.0, 60.0, 240.0}) {
        for (const double damping_time : {0.0, 0.1}) {
            Scene scene = stack({.time_step = 1.0 / rate}, 3, 4, damping_time);
            while (scene.simulation.time() < 0.7) scene.step();
            if (first.empty()) first = scene.positions();
            CAPTURE(rate, damping_time);
            CHECK(largest_difference(scene.positions(), first) < 0.01 * h);
        }
    }
}

TEST_CASE("Piles whose corners and edges lie on each other come to rest in a second") {
    for (const int side : {4, 5, 6}) {
        CAPTURE(side);
        Scene scene = stack({.time_step = 1.0 / 60.0, .skip = false}, 20, side);
        REQUIRE(scene.settle(0.1, 1e-6));
        CHECK(scene.simulation.time() < 1.0);
    }
}

TEST_CASE("Twenty sheets rest at three quarters of the thickness or more, and their table carries their weight") {
    Scene scene = stack({.time_step = 1.0 / 60.0, .skip = false}, 20, 5);
    REQUIRE(scene.settle(0.1, 1e-8));
    const StepReport report = step_well(scene.simulation);
    double weight = 0.0;
    for (const ClothId cloth : scene.cloths) {
        for (const double mass : scene.simulation.masses(cloth)) weight += 9.81 * mass;
    }
    CHECK(report.smallest_distance > 0.75 * h);
    CHECK(-scene.simulation.force_on({0}).y() == Approx(weight).epsilon(1e-6));
}

TEST_CASE("Springs' damping and contact together dissipate in every step", "[law]") {
    for (const double damping_time : {0.0, 0.01, 0.03, 0.1}) {
        for (const int sheets : {1, 2}) {
            const StepSettings exact{.time_step = 1.0 / 60.0, .newton_tolerance = 1e-8, .measure = StepMeasures::ledger};
            Scene scene(exact);
            scene.simulation.add_obstacle(make_box({0.1, 0.06, 0.1}), {.translation = Vec3(0, 0.03, 0)}, {.friction = 0.3});
            for (int k = 1; k <= sheets; ++k) scene.add(make_grid(0.3, 0.3, 9, 9), 0.07 + 0.02 * k, damping_time);
            double before = scene.simulation.energy().total();
            for (int n = 0; n < 90; ++n) {
                const double now = step_well(scene.simulation).energy.total();
                CAPTURE(damping_time, sheets, n);
                CHECK(now <= before + 1e-6 * std::abs(before));
                before = now;
            }
        }
    }
}

}  // namespace percale::test::rest_law_test
