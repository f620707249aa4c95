#pragma once

#include <string>

#include "measures/measures.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// What a run came to, whatever its scene expects.
struct RunVerdict {
    /// The status in report.json: stopped, crossed, failed, unsolved or finished; where several hold, the first of them.
    std::string word;
    /// All that is not well, in one line; empty where the run is.
    std::string reason;

    bool well() const { return reason.empty(); }
};

/// crossed: in a frame, or in a state of --certify-steps, triangles cross or a vertex lies inside a watertight obstacle.
/// unsolved: a step was accepted with what the solver had come to (not_converged or tolerance_missed).
RunVerdict verdict_of_run(const RunResult& result);

/// "2 steps were taken unsolved (not_converged or tolerance_missed)"; empty for 0.
std::string unsolved_text(int steps);

/// "12 pairs of triangles cross, summed over the frames, most in frame 7; deepest 0.002 m"; empty where nothing crosses.
std::string crossing_text(const Measures& measures);

}  // namespace percale::scenes
