#include "scenes/format/expectations.h"

#include <cmath>
#include <limits>

#include "scenes/format/scene_file.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::expectations_test {
namespace {

const double infinity = std::numeric_limits<double>::infinity();

Expectation limit(const std::string& form, const std::string& measure = "largest_strain") {
    const Scene scene = parse_scene(small_scene() + "[expect]\n" + measure + " = " + form + "\n", "t");
    return scene.expectations.at(0);
}

ExpectationResult judged(const Expectation& expectation, double value) {
    return judge({&expectation, 1}, {{expectation.measure, value}}).at(0);
}

}  // namespace

TEST_CASE("a plain number must be met exactly") {
    const Expectation zero = limit("0", "intersections");
    CHECK(within(zero, 0.0));
    CHECK_FALSE(within(zero, 1.0));
    CHECK_FALSE(within(zero, 1e-300));
}

TEST_CASE("below and above exclude their number, between includes both") {
    CHECK(within(limit("{ below = 0.3 }"), std::nextafter(0.3, 0.0)));
    CHECK_FALSE(within(limit("{ below = 0.3 }"), 0.3));
    CHECK(within(limit("{ below = 0.3 }"), -infinity));
    CHECK(within(limit("{ above = 0.3 }"), std::nextafter(0.3, 1.0)));
    CHECK_FALSE(within(limit("{ above = 0.3 }"), 0.3));
    CHECK(within(limit("{ above = 0.3 }"), infinity));
    CHECK(within(limit("{ between = [0.1, 0.3] }"), 0.1));
    CHECK(within(limit("{ between = [0.1, 0.3] }"), 0.3));
    CHECK_FALSE(within(limit("{ between = [0.1, 0.3] }"), std::nextafter(0.1, 0.0)));
    CHECK_FALSE(within(limit("{ between = [0.1, 0.3] }"), std::nextafter(0.3, 1.0)));
}

TEST_CASE("no limit holds for a number that is none") {
    for (const char* form : {"0", "{ below = 1 }", "{ above = -1 }", "{ between = [-1, 1] }"})
        CHECK_FALSE(within(limit(form), std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("a result says measure, value, limit and verdict in one line") {
    CHECK(judged(limit("{ below = 0.3 }"), 0.12).text == "largest_strain 0.12, expected < 0.3: passed");
    CHECK(judged(limit("{ below = 0.3 }"), 0.5).text == "largest_strain 0.5, expected < 0.3: failed");
    CHECK(judged(limit("{ above = 1e-4 }"), 0.0).text == "largest_strain 0, expected > 1e-4: failed");
    CHECK(judged(limit("0", "intersections"), 2.0).text == "intersections 2, expected = 0: failed");
    CHECK(judged(limit("{ between = [0.2, 0.45] }", "lowest_vertex"), 0.25).text ==
          "lowest_vertex 0.25, expected 0.2 ... 0.45: passed");
    CHECK(judged(limit("{ file = \"a.obj\", within = 2e-3 }", "matches"), 0.002).text ==
          "matches a.obj 0.002, expected <= 0.002: passed");
}

TEST_CASE("a value is written with as many digits as the verdict needs") {
    CHECK(judged(limit("{ below = 0.3 }"), 0.123456789).text == "largest_strain 0.123457, expected < 0.3: passed");
    CHECK(judged(limit("{ below = 0.3 }"), 0.29999999999).text == "largest_strain 0.29999999999, expected < 0.3: passed");
}

TEST_CASE("what was not measured has failed") {
    const Expectation expectation = limit("{ below = 0.3 }");
    const ExpectationResult result = judge({&expectation, 1}, {}).at(0);
    CHECK_FALSE(result.passed);
    CHECK_FALSE(result.value.has_value());
    CHECK(result.text == "largest_strain not measured, expected < 0.3: failed");
}

TEST_CASE("results come in the order of the expectations with their values") {
    const Scene scene = parse_scene(small_scene() + "[expect]\nspeed_at_end = { below = 0.05 }\nintersections = 0\n", "t");
    const auto results = judge(scene.expectations, {{"intersections", 0.0}, {"speed_at_end", 1.0}});
    REQUIRE(results.size() == 2);
    CHECK(results[0].expectation.measure == "speed_at_end");
    CHECK_FALSE(results[0].passed);
    CHECK(results[0].value == 1.0);
    CHECK(results[1].passed);
}

TEST_CASE("strain and energy are what steps have to measure, the rest comes from elsewhere") {
    for (const MeasureDescription& measure : measure_descriptions()) {
        Expectation expectation;
        expectation.measure = measure.name;
        const bool by_step = measure.name == "largest_strain" || measure.name == "energy_gain";
        CHECK(read_step_measures({&expectation, 1}) == by_step);
    }
    CHECK_FALSE(read_step_measures({}));
}

TEST_CASE("of a run whose every step is certified no pair and no depth is expected, after what the scene says") {
    const std::vector<Expectation> expected = with_every_step({limit("{ below = 0.3 }")});
    const auto verdicts = [&](double pairs, double depth) {
        std::vector<bool> passed;
        for (const ExpectationResult& result : judge(
                 expected,
                 {{"largest_strain", 0.1}, {"intersections_at_every_step", pairs}, {"deepest_penetration_at_every_step", depth}}))
            passed.push_back(result.passed);
        return passed;
    };
    CHECK(verdicts(0.0, 0.0) == std::vector<bool>{true, true, true});
    CHECK(verdicts(1.0, 0.0) == std::vector<bool>{true, false, true});
    CHECK(verdicts(0.0, 1e-9) == std::vector<bool>{true, true, false});
    CHECK_FALSE(judge(expected, {}).at(1).passed);
}

}  // namespace percale::scenes::test::expectations_test
