#include "scenes/compare/compare_run.h"

#include <cmath>

#include "tests/scenes/compare_scenes.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::compare_run_test {
namespace {

using namespace test;

std::string with(std::string text, const std::string& what, const std::string& instead) {
    return text.replace(text.find(what), what.size(), instead);
}

/// The falling sheet with one line of its vertices held.
std::string held_sheet() { return with(falling_sheet(), "grid =", "pin = [0, 1, 2, 3]\ngrid ="); }

}  // namespace

TEST_CASE("A variant is named by its scheme and by the fraction of a second or the tolerance it takes") {
    CHECK(variant_text({"rk4", 1.0 / 3840.0, 0.0}) == "rk4 at 1/3840 s");
    CHECK(variant_text({"rk4", 0.003, 0.0}) == "rk4 at 0.003 s");
    CHECK(variant_text({"rk4", 0.5, 0.0}) == "rk4 at 0.5 s");
    CHECK(variant_text({"tr_bdf2", 0.0, 1e-3}) == "tr_bdf2 with tolerance 0.001 m/s");
}

TEST_CASE("A run of a free sheet ends where the scheme's fall ends, with the step asked for") {
    const double dt = GENERATE(0.01, 0.0025);
    const VariantRun run = run_variant(source_of(falling_sheet()), {"symplectic_euler", dt, 0.0}, never_stop);
    REQUIRE(run.end == VariantEnd::finished);
    const double n = std::round(0.1 / dt);
    const double fall = 9.81 * dt * dt * n * (n + 1.0) / 2.0;
    CHECK(run.steps == static_cast<int>(n));
    CHECK(std::abs(run.state.mass_centre.y() - (2.0 - fall)) < 1e-12);
    CHECK(std::abs(run.state.lowest - (2.0 - fall)) < 1e-12);
    CHECK(std::abs(run.state.stretch) < 1e-9);
    CHECK(run.state.positions.size() == 16);
    const double mass = 0.2 * 0.3 * 0.3, speed = 9.81 * 0.1;
    CHECK(std::abs(run.state.energy - mass * (0.5 * speed * speed + 9.81 * (2.0 - fall))) < 1e-9);
}

TEST_CASE("A disturbance moves every free vertex by its length and no held one, always in the same way") {
    const std::string scene = with(held_sheet(), "duration = 0.1", "duration = 1e-6");
    const Variant variant{"symplectic_euler", 1e-6, 0.0};
    const VariantRun calm = run_variant(source_of(scene), variant, never_stop);
    const VariantRun moved = run_variant(source_of(scene), variant, never_stop, 1e-4);
    const VariantRun again = run_variant(source_of(scene), variant, never_stop, 1e-4);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < calm.state.positions.size(); ++i) {
        const Vec3 apart = moved.state.positions[i] - calm.state.positions[i];
        CHECK(std::abs(apart.norm() - (i < 4 ? 0.0 : 1e-4)) < 1e-9);
        CHECK(again.state.positions[i] == moved.state.positions[i]);
        sum += apart;
    }
    CHECK(sum.norm() < 0.8 * 12.0 * 1e-4);  // not all the same way
}

TEST_CASE("A run that blows up, one that is refused and one that is stopped are distinguished") {
    const std::string stiff = with(held_sheet(), "structural = 1.0", "structural = 1e6");
    const VariantRun high =
        run_variant(source_of(with(stiff, "duration = 0.1", "duration = 5.0")), {"rk4", 0.05, 0.0}, never_stop, 1e-6);
    CHECK(high.end == VariantEnd::blew_up);
    CHECK_FALSE(high.reason.empty());
    const VariantRun refused = run_variant(source_of(sheet_on_box()), {"rk4", 1e-3, 0.0}, never_stop);
    CHECK(refused.end == VariantEnd::refused);
    CHECK(refused.reason.find("obstacles") != std::string::npos);
    CHECK_THROWS_AS(run_variant(source_of(falling_sheet()), {"rk4", 1e-3, 0.0}, [] { return true; }), StudyStopped);
    CHECK(message_of([] { run_variant(source_of("[fabric.a]"), {"rk4", 1e-3, 0.0}, never_stop); }) != "");
}

TEST_CASE("Distances between two ends are those of the definition, and 0 from an end to itself") {
    const EndState a{
        .positions = {{0, 0, 0}, {1, 0, 0}}, .mass_centre = {0.5, 0, 0}, .energy = 2.0, .lowest = 0.0, .stretch = 0.1};
    const EndState b{
        .positions = {{0, 3, 0}, {1, 0, 4}}, .mass_centre = {0.5, 0, 2}, .energy = 1.5, .lowest = -1.0, .stretch = 0.3};
    const Distances apart = distances_between(a, b);
    CHECK(std::abs(apart.rms - std::sqrt(12.5)) < 1e-15);
    CHECK(apart.largest == 4.0);
    CHECK(apart.mass_centre == 2.0);
    CHECK(apart.lowest == 1.0);
    CHECK(apart.energy == 0.5);
    CHECK(std::abs(apart.stretch - 0.2) < 1e-15);
    CHECK(distances_between(a, a).largest == 0.0);
    CHECK(scaled(apart, 2.0).largest == 8.0);
    const Distances both = larger(apart, scaled(distances_between(a, a), 1.0));
    CHECK(both.energy == 0.5);
    CHECK(both.rms == apart.rms);
}

}  // namespace percale::scenes::compare_run_test
