#pragma once

#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "frames/cloth_fit.h"
#include "run/scene_build.h"

namespace percale::scenes {

/// Cloths and obstacles as they are now: their vertices in world coordinates, m. The meshes are those of the scene.
void place_shapes(const BuiltScene& built, std::span<TriangleMesh> cloths, std::span<TriangleMesh> obstacles);

/// What output.fields asks for of each cloth; nothing where it asks for nothing. `cloths` and `obstacles`: as they are now.
/// `cancel`: as of certify.
std::vector<MeshFields> fields_of(const BuiltScene& built, std::span<const TriangleMesh> cloths,
                                  std::span<const TriangleMesh> obstacles, const std::atomic<bool>* cancel = nullptr);

/// Those fields of each cloth as it is now, summed up, by their names: of triangles where they have the field, else of vertices.
std::vector<std::vector<std::pair<std::string, Spread>>> fit_now(const BuiltScene& built);

}  // namespace percale::scenes
