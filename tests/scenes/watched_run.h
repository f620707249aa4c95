#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "scenes/export/run_report.h"
#include "scenes/run/run_scene.h"

// Runs of scenes that are left on their way and resumed with the scene built anew.
namespace percale::scenes::test {

/// A run with its hashes and the states it was left in.
struct WatchedRun {
    RunResult result;
    std::vector<std::uint64_t> hashes;  // of contacts and state after each step
    std::vector<RunState> states;
    std::vector<std::size_t> hashes_before;  // each of the states
    std::vector<int> frames;
    nlohmann::json report;  // without costs
};

inline WatchedRun watch(const Scene& scene, const RunSettings& settings) {
    WatchedRun run;
    BuiltScene built = build_scene(scene);
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) { run.frames.push_back(frame.index); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        run.hashes.push_back(report.contact_hash);
        run.hashes.push_back(simulation.state_hash());
    };
    hooks.checkpoint = [&](const RunState& state) {
        run.states.push_back(state);
        run.hashes_before.push_back(run.hashes.size());
    };
    run.result = run_scene(built, hooks, settings);
    run.report = nlohmann::json::parse(run_report_text(built, run.result, {}, {}));
    for (const char* cost : {"cpu_s", "wall_s", "certificate_s", "peak_memory_bytes", "stages"}) run.report.erase(cost);
    return run;
}

template <class Value>
bool ends_with(const std::vector<Value>& all, const std::vector<Value>& end) {
    return end.size() <= all.size() && std::equal(end.rbegin(), end.rend(), all.rbegin());
}

/// Whether the run that goes on from a state of another has the same steps, frames and figures as one never left.
inline bool resumes_as(const WatchedRun& plain, const WatchedRun& left, std::size_t state, WatchedRun resumed) {
    const RunState& from = left.states[state];
    const bool reported = resumed.report["resumed_at_s"] == nlohmann::json{from.totals.simulated_s};
    resumed.report.erase("resumed_at_s");
    return reported && resumed.hashes.size() + left.hashes_before[state] == plain.hashes.size() &&
           ends_with(plain.hashes, resumed.hashes) && ends_with(plain.frames, resumed.frames) &&
           resumed.frames.size() + static_cast<std::size_t>(from.next_frame) == plain.frames.size() &&
           resumed.report == plain.report;
}

}  // namespace percale::scenes::test
