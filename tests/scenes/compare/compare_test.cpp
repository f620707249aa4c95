#include "scenes/compare/compare.h"

#include <cmath>
#include <vector>

#include "tests/scenes/compare_scenes.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::compare_test {

using namespace test;

TEST_CASE("The errors of a free fall are those of the schemes: g t dt/2 for Euler's, none for Runge and Kutta's") {
    const CompareSettings settings{
        .schemes = {"symplectic_euler", "backward_euler", "rk4"}, .steps = {0.01, 0.005}, .repeats = 2};
    const Comparison comparison = compare_scene(source_of(falling_sheet()), settings);
    REQUIRE(comparison.runs.size() == 6);
    for (const ComparedRun& compared : comparison.runs) {
        CAPTURE(variant_text(compared.variant));
        REQUIRE(compared.run.end == VariantEnd::finished);
        const double expected = compared.variant.scheme == "rk4" ? 0.0 : 0.5 * 9.81 * 0.1 * compared.variant.time_step;
        CHECK(std::abs(compared.error.rms - expected) < 1e-6);
        CHECK(std::abs(compared.error.largest - expected) < 1e-6);
        CHECK(std::abs(compared.error.mass_centre - expected) < 1e-6);
        CHECK(compared.run.totals.cpu_s > 0.0);
        const bool resolved = comparison.rank_of(compared.error) > comparison.rank_of(comparison.reference.uncertainty);
        CHECK(resolved == (compared.variant.scheme != "rk4"));
    }
}

TEST_CASE("A scene that ends at rest gives no time to compare at, and is refused where it says so") {
    std::string text = falling_sheet();
    text.replace(text.find("0.1"), 3, "\"rest\"");
    CHECK(message_of([&] { compare_scene(source_of(text), {}); }).starts_with("scene.toml:2:12: duration = \"rest\": runs are"));
}

TEST_CASE("What blows up or is refused is a row that says so, and the others are compared all the same") {
    const CompareSettings fast{.schemes = {"rk4", "backward_euler"}, .steps = {1.0 / 60.0}, .repeats = 1};
    const Comparison strip = compare_scene(source_of(standing_strip()), fast);
    REQUIRE(strip.runs.size() == 2);
    CHECK(strip.runs[0].run.end == VariantEnd::blew_up);
    CHECK(std::isnan(strip.runs[0].error.rms));
    CHECK(strip.runs[1].run.end == VariantEnd::finished);
    const Distances& error = strip.runs[1].error;
    CHECK(strip.rank_of(error) >= error.mass_centre);  // chaotic
    CHECK(strip.rank_of({.mass_centre = 1.0, .lowest = 2.0, .stretch = 0.0}) == 2.0);
    CHECK(strip.rank_of({.mass_centre = 1.0, .lowest = 2.0, .stretch = 100.0}) == 100.0 * strip.extent);
    const Comparison box = compare_scene(source_of(sheet_on_box()),
                                         {.schemes = fast.schemes, .steps = fast.steps, .repeats = 1, .reference_error = 0.1});
    CHECK(box.runs[0].run.end == VariantEnd::refused);
    CHECK(box.runs[1].run.end == VariantEnd::finished);
    CHECK(box.rank_of(box.runs[1].error) == box.runs[1].error.rms);
}

TEST_CASE(
    "Without schemes and steps every scheme that takes the scene runs at four steps from the largest it survives, tr_bdf2 "
    "adaptively, too") {
    const Comparison comparison =
        compare_scene(source_of(sheet_on_box()), {.schemes = {}, .steps = {}, .repeats = 1, .reference_error = 0.1});
    std::vector<double> implicit, adaptive;
    for (const ComparedRun& compared : comparison.runs) {
        CAPTURE(variant_text(compared.variant), compared.run.reason);
        CHECK(compared.variant.scheme != "rk4");
        CHECK((compared.run.end == VariantEnd::finished || compared.variant.time_step == 0.0));
        if (compared.variant.time_step == 0.0)
            adaptive.push_back(compared.variant.tolerance);
        else if (compared.variant.scheme == "backward_euler")
            implicit.push_back(compared.variant.time_step);
    }
    CHECK(implicit == std::vector<double>{1.0 / 60.0, 1.0 / 120.0, 1.0 / 240.0, 1.0 / 480.0});
    CHECK(adaptive.size() == 3);
}

TEST_CASE("A comparison ends when a stop is asked for") {
    CompareHooks hooks;
    hooks.stop_asked = [] { return true; };
    CHECK_THROWS_AS(compare_scene(source_of(falling_sheet()), {}, hooks), StudyStopped);
}

TEST_CASE("The reference is reported when it is made, before any run") {
    CompareHooks hooks;
    int reported = 0;
    hooks.reference_made = [&](const Reference& reference) {
        ++reported;
        CHECK(reference.state.positions.size() == 16);
    };
    compare_scene(source_of(falling_sheet()), {.schemes = {"rk4"}, .steps = {0.01}, .repeats = 1}, hooks);
    CHECK(reported == 1);
}

}  // namespace percale::scenes::compare_test
