#include "scenes/run/step_lengths.h"

#include <vector>

#include "tests/support/catch.h"

namespace percale::scenes::test::step_lengths_test {
namespace {

Scene lasting(double duration, double time_step) {
    Scene scene;
    scene.duration = duration;
    scene.step.time_step = time_step;
    return scene;
}

/// When the steps of a scene end.
std::vector<double> ends(const Scene& scene) {
    StepLengths lengths(scene, 0, scene.step.time_step);
    std::vector<double> times = {0.0};
    while (!lengths.over(times.back())) times.push_back(times.back() + lengths.next(times.back()));
    return times;
}

bool holds(const std::vector<double>& times, double wanted) {
    for (const double time : times)
        if (time == Approx(wanted).margin(1e-12)) return true;
    return false;
}

}  // namespace

TEST_CASE("a duration that is a multiple of the step up to rounding takes only full steps") {
    CHECK(count_steps(2.0, 1.0 / 60.0).steps == 120);
    CHECK(count_steps(2.0, 0.016666666666666666).last_dt == 0.016666666666666666);
    CHECK(count_steps(0.3, 0.1).steps == 3);
    CHECK(count_steps(0.3, 0.1).last_dt == 0.1);
    CHECK(count_steps(1e4, 1e-3).steps == 10000000);
}

TEST_CASE("a remainder that is no step of its own makes the last step longer") {
    CHECK(count_steps(1.0, 0.016666666).steps == 60);
    CHECK(count_steps(1.0, 0.016666666).last_dt == Approx(0.016666666 + 4e-8).epsilon(1e-12));
    CHECK(count_steps(3.0005, 1.0).steps == 4);
}

TEST_CASE("otherwise the last step is what is left") {
    CHECK(count_steps(1.0, 0.3).steps == 4);
    CHECK(count_steps(1.0, 0.3).last_dt == Approx(0.1));
    CHECK(count_steps(0.004, 0.01).steps == 1);
    CHECK(count_steps(0.004, 0.01).last_dt == Approx(0.004));
}

TEST_CASE("steps are as long as said, and the last one is shorter where they do not fill the duration") {
    const std::vector<double> times = ends(lasting(0.25, 0.1));
    REQUIRE(times.size() == 4);
    CHECK(times[2] == Approx(0.2));
    CHECK(times[3] == Approx(0.25));
}

TEST_CASE("adaptive steps end at frames, events and expectations, and none is longer than said") {
    Scene scene = lasting(0.5, 0.09);
    scene.step.adaptive = true;
    scene.output.fps = 4.0;
    scene.events.emplace_back().time = 0.3333;
    scene.expectations.emplace_back().at = 0.4321;
    const std::vector<double> times = ends(scene);
    for (const double stop : {0.25, 0.3333, 0.4321, 0.5}) CHECK(holds(times, stop));
    for (std::size_t i = 1; i < times.size(); ++i) CHECK(times[i] - times[i - 1] < 0.09 * (1.0 + 1e-9));
}

TEST_CASE("a run that is gone on with counts from where it was") {
    const Scene scene = lasting(1.0, 0.1);
    StepLengths lengths(scene, 7, 0.1);
    CHECK_FALSE(lengths.over(0.7));
    lengths.next(0.7);
    CHECK(lengths.made() == 8);
}

TEST_CASE("checkpoints are due once for each interval that is over, counted from 0, or never") {
    CheckpointTimes times(0.1, 0.05), none(0.0, 0.0);
    CHECK_FALSE(times.due(0.09));
    CHECK(times.due(0.1));
    CHECK_FALSE(times.due(0.19));
    CHECK(times.due(0.45));
    CHECK_FALSE(none.due(1e6));
}

}  // namespace percale::scenes::test::step_lengths_test
