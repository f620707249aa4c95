// Long runs: nothing drifts and nothing is lost.
#include <malloc.h>

#include <cmath>
#include <numbers>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::soak_test {
namespace {

/// Bytes that the program holds.
double held() {
    const auto info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

/// A small sheet whose two corners are led around circles, once a second.
struct Driven {
    static constexpr int steps_per_turn = 60;
    Simulation simulation;
    ClothId cloth;
    std::vector<Vec3> rest;

    explicit Driven(Scheme scheme)
        : simulation({.time_step = 1.0 / steps_per_turn, .scheme = scheme, .measure = StepMeasures::ledger}) {
        cloth = simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric());
        rest = copy(simulation.positions(cloth));
        for (const int corner : {0, 2}) simulation.pin(cloth, corner);
    }

    StepReport step(int number) {
        const double angle = 2.0 * std::numbers::pi * (number % steps_per_turn) / steps_per_turn;
        const Vec3 away(0.02 * std::sin(angle), 0.02 * (1.0 - std::cos(angle)), 0.0);
        for (const int corner : {0, 2}) simulation.move_pin(cloth, corner, rest[corner] + away);
        return simulation.step();
    }
};

constexpr double leak_limit = 4096.0;  // bytes; one byte a step would be twenty times that

}  // namespace

TEST_CASE("A million steps of a driven sheet: turns stay alike, time is exact and no memory is lost", "[.soak]") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::tr_bdf2}) {
        constexpr int steps = 1000000 / Driven::steps_per_turn * Driven::steps_per_turn;
        Driven driven(scheme);
        std::vector<Vec3> early;
        double bytes = 0.0, worst_closure = 0.0;
        for (int n = 1; n <= steps; ++n) {
            const StepReport report = driven.step(n);
            if (!report.ok() || report.slept) FAIL(report.explanation());
            worst_closure = std::max(worst_closure, report.energy.closure());
            if (n != 10000 / Driven::steps_per_turn * Driven::steps_per_turn) continue;
            early = copy(driven.simulation.positions(driven.cloth));
            bytes = held();
        }
        const double lost = held() - bytes;
        const double drift = largest_difference(early, copy(driven.simulation.positions(driven.cloth)));
        const double time_error = std::abs(driven.simulation.time() / (steps * (1.0 / Driven::steps_per_turn)) - 1.0);
        std::printf("%d steps: drift %.2g m, time %.2g, worst closure %.2g, memory %+.0f bytes\n", steps, drift, time_error,
                    worst_closure, lost);
        // TR-BDF2 hardly damps the swing that the sheet began with: it goes on among the turns.
        CHECK(drift < (scheme == Scheme::backward_euler ? 1e-9 : 0.04));
        CHECK(time_error < 1e-15);
        CHECK(worst_closure < 1e-9);
        CHECK(lost < leak_limit);
    }
}

TEST_CASE("A hundred thousand steps of a sheet that friction holds on a slope: it does not creep", "[.soak]") {
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        const double angle = 0.17;
        const Pose slope{.translation = Vec3::Zero(), .rotation = {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)}};
        // Without skipping it never sleeps.
        Simulation simulation({.contact_response = response, .skip = false}, make_brute_force_detector());
        Pose above = slope;
        above.translation = transform(slope, Vec3(0.0, 0.006, 0.0));
        const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), above);
        simulation.add_obstacle(make_plane(1.0), slope, {.friction = 0.5});
        std::vector<Vec3> early;
        double bytes = 0.0;
        for (int n = 1; n <= 100000; ++n) {
            const StepReport report = simulation.step();
            if (!report.ok() || report.slept) FAIL(report.explanation());
            if (n != 5000) continue;
            early = copy(simulation.positions(cloth));
            bytes = held();
        }
        const double lost = held() - bytes;
        const double creep = largest_difference(early, copy(simulation.positions(cloth)));
        std::printf("creep %.2g m in 1583 s, memory %+.0f bytes\n", creep, lost);
        CHECK(creep < 1e-6);
        CHECK(lost < leak_limit);
    }
}

}  // namespace percale::test::soak_test
