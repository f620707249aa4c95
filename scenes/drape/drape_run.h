#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drape/drape_scene.h"
#include "measures/measures.h"
#include "percale/report.h"
#include "run/scene_build.h"

namespace percale::scenes {

enum class DrapeEnd {
    settled,
    time_up,
    fell,
    failed,
    unsewn,  // given up: sewn through itself, or a seam is open
    stopped,
};

/// How a drape went.
struct Drape {
    DrapeEnd end = DrapeEnd::time_up;
    StepReport last = {};
    std::string failure = {};
    RestFigures rest = {};
    int unsolved_steps = 0;           // of RunTotals
    bool met = false;                 // whether a garment ever had contact with the body
    std::vector<double> height = {};  // m, mean of each garment when it was sewn and gravity set in
};

/// Steps until all garments are at rest, the time is up, or all have fallen below the body; gravity sets in when the seams have
/// closed. `stop` is asked after each step, with the simulated time in s. `again`: a garment that is not sewn when its seams
/// should have closed is given up, so that another sewing time can be tried.
Drape settle(BuiltScene& built, const DrapeOptions& options, const std::function<bool(double)>& stop, bool again = false);

/// The mean height of the vertices of a cloth, m.
double mean_height(const Simulation& simulation, ClothId cloth);

}  // namespace percale::scenes
