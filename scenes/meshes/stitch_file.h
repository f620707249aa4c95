#pragma once

#include <string>
#include <vector>

#include "percale/stitch.h"

namespace percale::scenes {

/// Stitches from a text file, one a line: "i j" joins two vertices, "i j k t" vertex i and the point (1 - t) x_j + t x_k;
/// vertices are counted from 0, "#" begins a comment. Throws SceneError with file:line.
std::vector<Stitch> read_stitch_file(const std::string& file);

/// The lines "stitch i j" and "stitch i j k t" of an OBJ file. Throws SceneError with file:line, and where there are none.
std::vector<Stitch> read_obj_stitches(const std::string& file);
/// The same; empty where there are none.
std::vector<Stitch> find_obj_stitches(const std::string& file);

}  // namespace percale::scenes
