#include "scenes/compare/compare_reference.h"

#include <cmath>
#include <limits>

#include "scenes/tolerances.h"
#include "tests/scenes/compare_scenes.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::compare_reference_test {

using namespace test;

TEST_CASE("Richardson's estimate is the error of a sequence that converges geometrically, and never less for others") {
    for (const double ratio : {2.0, 4.0, 16.0}) {
        // x_k = r^-k: what three levels change, and the error of the last.
        const double before = 1.0 - 1.0 / ratio, now = (1.0 - 1.0 / ratio) / ratio, error = 1.0 / (ratio * ratio);
        CAPTURE(ratio);
        CHECK(std::abs(richardson({.rms = now, .energy = 3.0 * now}, before).rms - error) < 1e-15);
        CHECK(std::abs(richardson({.rms = now, .energy = 3.0 * now}, before).energy - 3.0 * error) < 1e-15);
    }
    CHECK(richardson({.rms = 1.0}, 100.0).rms == 1.0 / 15.0);  // no scheme here is of more than fourth order
    CHECK(richardson({.rms = 1.0}, 1.5).rms == 1.0);
    CHECK(richardson({.rms = 1.0}, std::numeric_limits<double>::infinity()).rms == 1.0);
    CHECK(richardson({.rms = 0.0}, 1.0).rms == 0.0);
}

TEST_CASE("The reference of a free fall is the parabola, knows it, and is not chaotic") {
    const Reference reference = make_reference(source_of(falling_sheet()), 1e-9, never_stop);
    CHECK(reference.variant.scheme == "rk4");
    CHECK(std::abs(reference.state.mass_centre.y() - (2.0 - 0.5 * 9.81 * 0.01)) < 1e-12);
    CHECK(reference.uncertainty.rms < 1e-9);
    CHECK(reference.growth > 0.1);
    CHECK(reference.growth < 10.0);
    CHECK_FALSE(reference.chaotic);
}

TEST_CASE("A strip that falls over from its unstable rest is chaotic, and the uncertainty says what the disturbance does") {
    const Reference reference = make_reference(source_of(standing_strip()), 1e-9, never_stop);
    CHECK(reference.chaotic);
    // A rod on a hinge moves away as exp(t sqrt(3 g/(2 l))), here a point mass at the end of one as exp(t sqrt(g/l)).
    CHECK(reference.growth > chaos_growth);
    CHECK(reference.growth < 1e6);
    CHECK(reference.uncertainty.rms >= 0.9 * reference.growth * disturbance_at_start);
}

TEST_CASE("A scheme survives at the step below its stability limit, and an implicit one at the largest") {
    // The bench: one spring of structural 50 N/m a pair of vertices of 0.5 g or less needs steps far below 1/60 s.
    const std::string strip = standing_strip();
    const auto rk4 = largest_surviving_step(source_of(strip), "rk4", never_stop);
    const auto implicit = largest_surviving_step(source_of(strip), "backward_euler", never_stop);
    REQUIRE(rk4.has_value());
    REQUIRE(implicit.has_value());
    CHECK(rk4->step < 1.0 / 60.0);
    CHECK(implicit->step == 1.0 / 60.0);
    CHECK(rk4->run.end == VariantEnd::finished);
    const std::string message = message_of([] { largest_surviving_step(source_of(sheet_on_box()), "rk4", never_stop); });
    CHECK(message.find("obstacles") != std::string::npos);
}

TEST_CASE("With an obstacle the reference is implicit and says how well it is known") {
    const Reference reference = make_reference(source_of(sheet_on_box()), 1e-4, never_stop);
    CHECK(reference.variant.scheme != "rk4");
    CHECK(reference.uncertainty.rms > 0.0);
    CHECK(reference.uncertainty.rms < 1e-2);
}

}  // namespace percale::scenes::compare_reference_test
