#pragma once

#include <functional>
#include <optional>

#include "compare/compare_run.h"

namespace percale::scenes {

/// What the error of other runs is measured against, and how well it is known.
struct Reference {
    Variant variant = {};        // the finest run
    EndState state = {};         // its end
    Distances uncertainty = {};  // what the last halving of the step changed, over how fast such changes fall (Richardson)
    double growth = 0.0;         // of a disturbance from the start to the end; infinity where the disturbed run did not finish
    bool chaotic = false;        // growth above chaos_growth: positions cannot be compared, only invariants
};

/// A run that came to an end, with its step.
struct Survivor {
    double step = 0.0;  // s
    VariantRun run = {};
};

/// The run with the largest of the steps 1/60 s / 2^k, k = 0 ... 14, at which a scheme brings the scene to its end and no edge
/// reaches eleven times its length; nothing if there is none. Throws SceneError with the reason where the scheme is refused.
std::optional<Survivor> largest_surviving_step(const SceneSource& source, const std::string& scheme,
                                               const std::function<bool()>& stop_asked);

/// Halves the step of rk4, or of tr_bdf2 or backward_euler where there is contact or rk4 needs too many steps, until the
/// uncertainty is at most `wanted` (m rms), does not fall any more, or the next run would take too many steps (a count, no
/// clock). In a chaotic scene the uncertainty includes what the disturbance changed. Throws SceneError if no scheme brings the
/// scene to an end.
Reference make_reference(const SceneSource& source, double wanted, const std::function<bool()>& stop_asked);

/// The error of the finer of two runs, one with half of the other's step: c/(r - 1), where c is the change by this halving and r
/// <= 16 the ratio of the change by the previous halving to c; c itself where r < 2 or r is unknown. `before`: the change by the
/// previous halving, m rms; infinity if there was none.
Distances richardson(const Distances& change, double before);

}  // namespace percale::scenes
