#include "scenes/stress/stress_watch.h"

#include <limits>

#include "tests/support/catch.h"

namespace percale::scenes::test::stress_watch_test {

namespace {

/// A cell's simulation watched over some steps.
StressFigures watched(const StressCell& cell, int steps) {
    StressCase made = make_case(cell);
    StressWatch watch(made.simulation, made.cloths, made.held);
    for (int n = 0; n < steps; ++n) watch.look(made.simulation.step(), made.simulation);
    return watch.figures;
}

}  // namespace

TEST_CASE("A run of backward Euler gains nothing and keeps its pins") {
    const StressFigures figures = watched({.stiffness = 1e4}, 10);
    CHECK(figures.finite);
    CHECK(figures.pins_kept);
    CHECK(figures.gain < 1e-9);
    CHECK(figures.step_excess < 1e-9);
    CHECK(figures.steps == 10);
    CHECK(figures.newton_iterations >= 10);
    CHECK(figures.status == "ok");
    CHECK(figures.strain > 0.0);
}

TEST_CASE("A pin that moves in its last bit is seen, and so is energy that came from nowhere") {
    StressCase made = make_case({});
    made.held[0].place.x() *= 1.0 + 1e-15;
    StressWatch watch(made.simulation, made.cloths, made.held);
    StepReport report = made.simulation.step();
    report.energy.kinetic += 1e3;
    watch.look(report, made.simulation);
    CHECK_FALSE(watch.figures.pins_kept);
    CHECK(watch.figures.gain > 1.0);
    CHECK(watch.figures.step_excess > 1.0);
}

TEST_CASE("Where a pin is moved backward Euler has the bound of the other schemes") {
    StressCase made = make_case({.start = StressStart::hang});
    StressWatch watch(made.simulation, made.cloths, {});
    watch.figures.bound = gain_bound(Scheme::backward_euler, 1e-2, 1.0);
    watch.look(made.simulation.step(), made.simulation);
    CHECK(watch.figures.bound == gain_bound(Scheme::backward_euler, 1e-2, 1.0));
    made.simulation.move_pin(made.cloths[0], 0, made.held[0].place + Vec3(0.0, 0.01, 0.0));
    watch.look(made.simulation.step(), made.simulation);
    CHECK(watch.figures.bound == 1.0);
}

TEST_CASE("An explicit scheme beyond its step gains energy or ends with a status, and the plan has said so") {
    const StressFigures figures = watched({.scheme = Scheme::rk4, .time_step = 0.1, .stiffness = 1e6}, 16);
    CHECK(figures.said.find("longer than the longest stable one") != std::string::npos);
    CHECK((figures.gain > 1.0 || figures.status == "not_finite"));
}

TEST_CASE("Verdicts go by what happened and by whether it was said") {
    const StressFigures good{.gain = 0.5, .bound = 1.0};
    CHECK(verdict_of(good) == StressVerdict::stable);
    StressFigures gained = good;
    gained.gain = 2.0;
    CHECK(verdict_of(gained) == StressVerdict::silent);
    gained.said = "time_step is too long";
    CHECK(verdict_of(gained) == StressVerdict::gained);
    StressFigures jumped = good;
    jumped.step_excess = 0.1;
    CHECK(verdict_of(jumped) == StressVerdict::silent);
    StressFigures failed = good;
    failed.status = "not_finite";
    CHECK(verdict_of(failed) == StressVerdict::not_finite);
    failed.gain = 1e9;
    CHECK(verdict_of(failed) == StressVerdict::not_finite);
    failed.gain = 0.5;
    failed.status = "pin_blocked";
    CHECK(verdict_of(failed) == StressVerdict::refused);
    StressFigures lost = good;
    lost.pins_kept = false;
    lost.said = "anything";
    CHECK(verdict_of(lost) == StressVerdict::silent);
    StressFigures infinite = good;
    infinite.finite = false;
    CHECK(verdict_of(infinite) == StressVerdict::silent);
}

TEST_CASE("Backward Euler and TR-BDF2 must not gain even where it is said, others must not be silent") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::tr_bdf2}) {
        CHECK(is_failure(scheme, StressVerdict::gained));
        CHECK(is_failure(scheme, StressVerdict::not_finite));
        CHECK_FALSE(is_failure(scheme, StressVerdict::refused));
    }
    CHECK(is_failure(Scheme::rk4, StressVerdict::silent));
    CHECK_FALSE(is_failure(Scheme::rk4, StressVerdict::gained));
    CHECK_FALSE(is_failure(Scheme::rk4, StressVerdict::not_finite));
}

TEST_CASE("The bound is nothing for backward Euler, and the oscillator's for symplectic Euler") {
    constexpr double always = std::numeric_limits<double>::infinity();
    CHECK(gain_bound(Scheme::backward_euler, 1.0, always) <= 1e-6);
    CHECK(gain_bound(Scheme::tr_bdf2, 1.0, always) == 1.0);
    CHECK(gain_bound(Scheme::symplectic_euler, 0.9, 1.0) == Approx(18.0));
    CHECK(gain_bound(Scheme::symplectic_euler, 2.0, 1.0) == 1.0);
}

}  // namespace percale::scenes::test::stress_watch_test
