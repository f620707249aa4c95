#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "percale/simulation.h"
#include "tests/support/saved_bytes.h"

// Runs that are saved in the middle and resumed in a new simulation.
namespace percale::test {

struct Resumable {
    std::string name;
    std::function<Simulation()> make;
    std::function<void(Simulation&, int)> script = [](Simulation&, int) {};  // before the step of this number
    int steps = 30;
};

/// Everything of a step that does not depend on a clock, with the state after it.
struct StepTrace {
    std::uint64_t state = 0, contacts = 0;
    std::vector<double> figures;

    StepTrace(const StepReport& r, const Simulation& simulation)
        : state(simulation.state_hash()),
          contacts(r.contact_hash),
          figures{static_cast<double>(r.status),
                  r.time,
                  r.smallest_dt,
                  r.largest_dt,
                  static_cast<double>(r.parts),
                  static_cast<double>(r.rejected),
                  static_cast<double>(r.contacts),
                  static_cast<double>(r.newton_iterations),
                  static_cast<double>(r.halvings),
                  static_cast<double>(r.linear_iterations),
                  static_cast<double>(r.slept),
                  static_cast<double>(r.linear_solver),
                  r.residual,
                  r.smallest_distance,
                  r.contact_stiffness,
                  r.largest_strain,
                  r.energy.total(),
                  r.energy.work} {
        for (const auto entry : ledger_entries) figures.push_back(r.energy.*entry);
        for (const int count : {r.dropped.not_converged, r.dropped.blocked, r.dropped.not_finite, r.dropped.inexact})
            figures.push_back(count);
        // NaN, which is not equal to itself, stands for unmeasured figures.
        for (double& figure : figures) figure = figure == figure ? figure : -1e300;
    }
    bool operator==(const StepTrace&) const = default;
};

/// The steps from `first` on. `saved`: filled with the states after the steps of these numbers.
inline std::vector<StepTrace> trace(const Resumable& run, Simulation& simulation, int first, std::vector<int> at = {},
                                    std::vector<Saved>* saved = nullptr) {
    std::vector<StepTrace> steps;
    for (int n = first; n < run.steps; ++n) {
        for (const int number : at) {
            if (number == n) saved->push_back(simulation.save());
        }
        run.script(simulation, n);
        const StepReport report = simulation.step();
        steps.emplace_back(report, simulation);
    }
    return steps;
}

/// The number of the first step that differs after resuming before step `at`; -1: none. -2: the run with saving differs from one
/// without.
inline int first_difference(const Resumable& run, const std::array<int, 3>& places) {
    Simulation plain = run.make(), watched = run.make();
    std::vector<Saved> saved;
    const std::vector<StepTrace> steps = trace(run, plain, 0);
    if (trace(run, watched, 0, {places.begin(), places.end()}, &saved) != steps) return -2;
    for (std::size_t k = 0; k < places.size(); ++k) {
        Simulation resumed = run.make();
        resumed.restore(saved[k]);
        if (resumed.save() != saved[k]) return places[k];
        const std::vector<StepTrace> later = trace(run, resumed, places[k]);
        for (std::size_t n = 0; n < later.size(); ++n) {
            if (!(later[n] == steps[n + static_cast<std::size_t>(places[k])])) return places[k] + static_cast<int>(n);
        }
    }
    return -1;
}

}  // namespace percale::test
