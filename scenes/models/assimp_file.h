#pragma once

#include <string>

#include "models/model.h"

namespace percale::scenes {

/// Reads Collada, FBX, 3DS, STL and whatever else assimp reads, coordinates of 32 bits, in a process of its own, whose memory and
/// time are bounded by the file's size: assimp's importers crash on some broken files, and some fill the memory. Throws
/// SceneError naming the file.
Model read_by_assimp(const std::string& file);

}  // namespace percale::scenes
