#pragma once

#include <string>

#include "pattern/pattern.h"

namespace percale::scenes {

/// A pattern of GarmentCode (Korosteleva and Sorkine-Hornung 2023). Lengths are in units_in_meter-ths of a metre; control points
/// of curves are relative to their edge: (x, y) is x along it and y to its left; circles have a radius, a flag for the larger arc
/// and one for the arc to the right. The end of an edge is sewn to the beginning of the other, or, where the stitch says
/// "right_wrong", to its end. Throws SceneError with the file, and the panel or stitch.
Pattern read_pattern_json(const std::string& file);

}  // namespace percale::scenes
