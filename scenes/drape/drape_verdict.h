#pragma once

#include <string>
#include <vector>

#include "drape/drape_run.h"
#include "drape/drape_scene.h"

namespace percale::scenes {

/// Writes the garments as they are now, in m, with the axes of the files, and certifies them. `own_crossings`: pairs of triangles
/// of garments that cross; they count as intersections where garments meet.
struct DrapedFiles {
    FrameCheck check;
    int own_crossings = 0;
};
DrapedFiles write_draped(const BuiltScene& built, const DrapeOptions& options, bool z_up);

/// What a drape came to, for its user. `wrong` is empty where all garments lie sewn, at rest and clean on the body.
struct DrapeVerdict {
    std::vector<Finding> findings = {};
    std::string wrong = {};
};
DrapeVerdict verdict_of(const BuiltScene& built, const DrapeOptions& options, const Drape& drape, const DrapedFiles& files,
                        bool comes_apart = false);

}  // namespace percale::scenes
