#include "run/run_verdict.h"

#include "common/text.h"

namespace percale::scenes {

namespace {

std::string amount_text(int intersections, double depth, const std::string& over, const std::string& worst) {
    std::string text;
    if (intersections > 0)
        text = counted(intersections, "pair") + " of triangles " + (intersections == 1 ? "crosses" : "cross") + ", summed over " +
               over + ", most " + worst;
    else
        text = "cloth is inside an obstacle, farthest " + worst;
    return depth > 0.0 ? text + ", " + short_number(depth) + " m deep" : text;
}

}  // namespace

std::string unsolved_text(int steps) {
    if (steps == 0) return {};
    return counted(steps, "step") + (steps == 1 ? " was" : " were") + " taken unsolved (not_converged or tolerance_missed)";
}

std::string crossing_text(const Measures& measures) {
    if (measures.intersections > 0 || measures.deepest_penetration > 0.0)
        return amount_text(measures.intersections, measures.deepest_penetration, "the frames",
                           "in frame " + std::to_string(measures.worst_frame));
    if (!measures.steps) return {};
    const StepChecks& steps = *measures.steps;
    if (steps.intersections == 0 && steps.deepest_penetration <= 0.0) return {};
    return amount_text(steps.intersections, steps.deepest_penetration, "the states",
                       "after step " + std::to_string(steps.worst_step) + " (" + short_number(steps.worst_time) + " s)");
}

RunVerdict verdict_of_run(const RunResult& result) {
    const std::string own = result.status == RunStatus::finished ? "" : result.reason;
    const std::string crossing = crossing_text(result.measures), unsolved = unsolved_text(result.totals.unsolved_steps);
    RunVerdict verdict{status_word(result.status), {}};
    if (result.status != RunStatus::stopped) {
        if (!crossing.empty())
            verdict.word = "crossed";
        else if (result.status == RunStatus::finished && !unsolved.empty())
            verdict.word = "unsolved";
    }
    for (const std::string& text : {own, crossing, unsolved})
        if (!text.empty()) verdict.reason += (verdict.reason.empty() ? "" : "; ") + text;
    return verdict;
}

}  // namespace percale::scenes
