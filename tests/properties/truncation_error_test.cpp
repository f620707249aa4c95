#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

// Local truncation error: the error of one step from an exact state. A scheme of order p makes an error of h^(p + 1) a step
// (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, chapter II.3).

namespace percale::test::truncation_error_test {
namespace {

struct System {
    const char* name;
    ClothModel model;
    std::vector<Vec3> places, velocities;
    std::vector<int> held;
    double step;    // s, the longest of those tried
    double steady;  // s, the time from which its motion is general
};

/// Two masses on a damped spring, which they stretch along its line.
System damped_pair() {
    return {"damped pair",
            linked_masses({0.2, 0.3}, {{0, 1, 1.0, 40.0, 0.5}}),
            {Vec3::Zero(), Vec3(1.2, 0.0, 0.0)},
            {Vec3(0.3, 0.0, 0.0), Vec3(-0.4, 0.0, 0.0)},
            {},
            0.01,
            0.05};
}

/// Between two held ends, displaced sideways; damped.
System taut_string() {
    constexpr int count = 7;
    System system{"taut string", {}, {}, {}, {0, count - 1}, 0.01, 0.05};
    std::vector<Link> links;
    for (int i = 0; i < count; ++i) {
        const double s = static_cast<double>(i) / (count - 1);
        system.places.emplace_back(s, 0.1 * std::sin(std::numbers::pi * s), 0.05 * std::sin(2.0 * std::numbers::pi * s));
        if (i > 0) links.push_back({i - 1, i, 0.1, 10.0, 0.02});
    }
    system.model = linked_masses(std::vector<double>(count, 0.01), links);
    return system;
}

/// A mass on an elastic link to a held point, 60 degrees from the vertical.
System pendulum() {
    return {"elastic pendulum",
            linked_masses({1.0, 0.1}, {{0, 1, 1.0, 50.0, 0.0}}),
            {Vec3::Zero(), Vec3(std::sin(std::numbers::pi / 3.0), -0.5, 0.0)},
            {},
            {0},
            0.01,
            0.1};
}

World start_of(const System& system, StepSettings settings) {
    settings.newton_tolerance = 1e-13;
    settings.measure = StepMeasures::none;
    World world = linked_world(system.model, system.places, system.held, settings);
    for (std::size_t i = 0; i < system.velocities.size(); ++i) {
        world.state.cloth.velocities.set(static_cast<int>(i), system.velocities[i]);
    }
    return world;
}

/// The state after some time, by steps of RK4 so short that only rounding is left of their error.
ClothState exact_state(const System& system, double time) {
    constexpr int steps = 4000;
    World world = start_of(system, {.time_step = time / steps, .scheme = Scheme::rk4});
    bool ok = true;
    for (int n = 0; n < steps; ++n) ok = step(world).ok() && ok;
    REQUIRE(ok);
    return world.state.cloth;
}

/// The error of one step from the exact state in positions and velocities, the latter times 0.1 s, m.
double step_error(const System& system, Scheme scheme, double h) {
    World world = start_of(system, {.time_step = h, .scheme = scheme});
    world.state.cloth = exact_state(system, system.steady);
    if (scheme == Scheme::bdf2) {
        const ClothState earlier = exact_state(system, system.steady - h);
        world.state.past.earlier.positions = earlier.positions;
        world.state.past.earlier.velocities = earlier.velocities;
        world.state.past.earlier_length = h;
        world.state.past.acceleration.resize(world.scene.model.vertex_count());  // only for the stopping rule, which is off
    }
    REQUIRE(step(world).ok());
    const ClothState exact = exact_state(system, system.steady + h);
    const int count = world.scene.model.vertex_count();
    const auto off = [count](const Vec3Arrays& a, const Vec3Arrays& b) {
        return largest_difference(to_points(a, count), to_points(b, count));
    };
    return std::max(off(world.state.cloth.positions, exact.positions), 0.1 * off(world.state.cloth.velocities, exact.velocities));
}

}  // namespace

TEST_CASE("The error of one step from an exact state is a power of the step one higher than the scheme's order", "[law]") {
    for (const System& system : {damped_pair(), taut_string(), pendulum()}) {
        for (const SchemeFacts& facts : scheme_table()) {
            double coarser = step_error(system, facts.scheme, system.step), slope = 0.0;
            for (int halving = 1; halving <= 3; ++halving) {
                const double finer = step_error(system, facts.scheme, system.step / (1 << halving));
                slope = std::log2(coarser / finer);
                coarser = finer;
            }
            CAPTURE(system.name, facts.word, coarser);
            CHECK(coarser > 1e-13);  // more than rounding
            check_law_between(
                "local error of a step, " + std::string(system.name) + ", " + std::string(facts.word) + ": power of h", slope,
                facts.order + 0.9, facts.order + 1.1);
        }
    }
}

}  // namespace percale::test::truncation_error_test
