#include "percale/report.h"

#include <array>
#include <set>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::engine_report_test {
namespace {

constexpr StepStatus all_statuses[] = {StepStatus::ok,
                                       StepStatus::halved,
                                       StepStatus::not_converged,
                                       StepStatus::tolerance_missed,
                                       StepStatus::pin_blocked,
                                       StepStatus::obstacle_too_fast,
                                       StepStatus::wrong_derivative,
                                       StepStatus::not_finite,
                                       StepStatus::work_limit,
                                       StepStatus::cancelled};

StepReport report_of(StepStatus status) {
    StepReport report;
    report.status = status;
    report.time = 0.5;
    report.dt = 0.1;
    report.newton_iterations = 7;
    report.linear_iterations = 83;
    report.halvings = 2;
    report.dropped = {.not_converged = 1, .blocked = 1};
    report.residual = 0.03125;
    report.smallest_fraction = 0.0625;
    return report;
}

}  // namespace

TEST_CASE("Every status has a word of its own") {
    std::set<std::string> words;
    for (const StepStatus status : all_statuses) CHECK(words.insert(status_word(status)).second);
    CHECK(words.count("unknown") == 0);
}

TEST_CASE("A ledger's sum adds the flows and has the energies of the last step") {
    const StepEnergy first{.kinetic = 1.0, .work = 2.0, .dissipated_material = 0.5, .imbalance = 0.25};
    const StepEnergy second{.kinetic = 3.0, .work = 1.0, .dissipated_contact = -1.0, .imbalance = -0.75};
    StepEnergy sum;
    add_step_energy(first, sum);
    add_step_energy(second, sum);
    CHECK((sum.kinetic == 3.0 && sum.work == 3.0 && sum.imbalance == -0.5));
    CHECK(sum.dissipated() == -0.5);
    CHECK(sum.closure() == Approx(0.5 / 3.0));
    CHECK(StepEnergy{}.closure() == 0.0);
}

TEST_CASE("A step is good unless pins, obstacles or infinities stopped it") {
    for (const StepStatus status : all_statuses) {
        const bool good = status == StepStatus::ok || status == StepStatus::halved || status == StepStatus::not_converged ||
                          status == StepStatus::tolerance_missed;
        CHECK(report_of(status).ok() == good);
    }
}

TEST_CASE("An explanation has the status and the figures") {
    for (const StepStatus status : all_statuses) {
        const std::string text = report_of(status).explanation();
        CHECK(mentions(text, {status_word(status), "0.1 s", "7 Newton", "83 linear", "0.03125",
                              "2 halvings; dropped: 1 not converged, 1 blocked"}));
        // A failed step's time is that of its start.
        CHECK(mentions(text, {report_of(status).ok() ? "t = 0.4 s" : "t = 0.5 s"}));
    }
}

TEST_CASE("Failures state what failed and what to do") {
    StepReport pin = report_of(StepStatus::pin_blocked);
    pin.blocked_cloth = 2;
    pin.blocked_vertex = 45;
    CHECK(mentions(pin.explanation(), {"pinned vertex 45 of cloth 2", "the obstacles"}));
    pin.blocking_obstacle = 1;
    CHECK(mentions(pin.explanation(), {"obstacle 1"}));
    pin.blocked_name = "cape";
    pin.blocking_name = "table";
    CHECK(mentions(pin.explanation(), {"pinned vertex 45 of cloth 2 (cape)", "obstacle 1 (table)"}));
    StepReport by_cloth = report_of(StepStatus::pin_blocked);
    by_cloth.blocking_name = "cloth";
    CHECK(mentions(by_cloth.explanation(), {"taking the cloth through cloth"}));
    StepReport fast = report_of(StepStatus::obstacle_too_fast);
    fast.blocking_obstacle = 3;
    CHECK(mentions(fast.explanation(), {"obstacle 3", "0.0625", "shorter time step"}));
    fast.blocking_name = "press";
    fast.second_obstacle = 5;
    fast.second_name = "anvil";
    CHECK(mentions(fast.explanation(), {"obstacle 3 (press)", "obstacle 5 (anvil)", "close on the cloth", "0.0625"}));
    fast.jump = 1.5;
    CHECK(mentions(fast.explanation(), {"close on the cloth", "something moves 1.5 m beside the cloth", "teleport"}));
    StepReport slow = report_of(StepStatus::not_converged);
    CHECK_FALSE(mentions(slow.explanation(), {"stretched"}));
    slow.stretched_cloth = 1;
    slow.stretched_name = "cape";
    slow.stretched_pins = 3;
    slow.stretch = 4.0;
    CHECK(mentions(slow.explanation(), {"not_converged, an edge of cloth 1 (cape) is stretched to 5 times", "3 pinned"}));
    CHECK(mentions(report_of(StepStatus::not_finite).explanation(), {"infinite", "shorter time step"}));
}

TEST_CASE("Explaining prints the explanation as one line") {
    const StepReport report = report_of(StepStatus::not_finite);
    std::FILE* file = std::tmpfile();
    REQUIRE(file != nullptr);
    report.explain(file);
    std::rewind(file);
    std::array<char, 1000> text{};
    const std::size_t size = std::fread(text.data(), 1, text.size(), file);
    std::fclose(file);
    CHECK(std::string(text.data(), size) == report.explanation() + "\n");
}

TEST_CASE("Total energy excludes work") {
    const StepEnergy energy{.kinetic = 1.0, .gravity = 2.0, .elastic = 4.0, .contact = 8.0, .work = 16.0};
    CHECK(energy.total() == 15.0);
}

TEST_CASE("Dropped substeps are counted by their outcome and reported in words") {
    DroppedSubsteps dropped;
    CHECK(dropped.text().empty());
    for (const SubstepOutcome end : {SubstepOutcome::blocked, SubstepOutcome::solved, SubstepOutcome::inexact,
                                     SubstepOutcome::inexact, SubstepOutcome::not_finite})
        dropped.add(end);
    CHECK(dropped.total() == 4);
    CHECK(dropped.text() == "1 blocked, 1 not finite, 2 not exact enough");
    dropped += {.not_converged = 3};
    CHECK(dropped == DroppedSubsteps{.not_converged = 3, .blocked = 1, .not_finite = 1, .inexact = 2});
}

TEST_CASE("Solvers have the words of their option, and none where nothing was solved") {
    CHECK(solver_word(LinearSolver::automatic) == std::string("none"));
    CHECK(solver_word(LinearSolver::cg) == std::string("cg"));
    CHECK(solver_word(LinearSolver::multigrid) == std::string("multigrid"));
    CHECK(solver_word(LinearSolver::direct) == std::string("direct"));
}

}  // namespace percale::test::engine_report_test
