#pragma once

#include <span>

#include "certificate/box_tree.h"
#include "percale/mesh.h"

namespace percale::certificate {

enum class Side { outside, on_surface, inside };

/// Whether the mesh is closed: vertices at bit-identical places taken as one and triangles that thereby lose a corner dropped,
/// every edge has exactly two triangles, which pass it in opposite senses; with or without the triangles of zero area.
bool is_watertight(const TriangleMesh& mesh);

/// How often a closed surface winds around a point that does not lie on it: 1 inside an outward-oriented surface, 0 outside,
/// 2 in the overlap of two parts, -1 inside a surface that is inside out. Counts signed crossings of the ray towards +x
/// with exact predicates, the ray displaced by an infinitesimal (e, e^2) in y and z so that it meets no edge. `tree` holds the
/// triangles.
int winding_number(const Vec3& point, std::span<const Corners> triangles, const BoxTree& tree);

/// Inside where the winding number of a closed surface is not 0. Exact.
Side side_of(const Vec3& point, std::span<const Corners> triangles, const BoxTree& tree);

}  // namespace percale::certificate
