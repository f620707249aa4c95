#pragma once

#include <string>
#include <vector>

#include "percale/report.h"
#include "step/world.h"

namespace percale {

/// The result of resolving initial penetration, or why there is none.
struct StartRepair {
    std::vector<StartMove> moves = {};
    std::string obstruction = {};  // empty where the start is clear now
};

/// Resolves initial penetration: moves cloth that starts inside obstacles, or through cloth, out of them. The detector finds a
/// clear state, then the springs relax the resulting stretch, in steps without gravity and motion. Time, velocities, pins and
/// obstacles stay. Where the detector finds no way, or a structural spring stays stretched by more than half (and more than it
/// was), the state is left as it was. `fault`: what was found.
StartRepair repair_start(World& world, StartFault fault);

}  // namespace percale
