#pragma once

#include "percale/mesh.h"

namespace percale::scenes {

/// Height of the mannequin, m.
inline constexpr double mannequin_height = 1.78;

/// About the distance to the mannequin's surface, m, negative inside: tapered capsules joined by smooth minima, standing on y =
/// 0, facing +z, arms 40 degrees from the vertical, the same at x and -x to the last bit. The surface is where it vanishes. It
/// never changes faster than the point moves, so a ball of that radius around a point outside is empty; near joints, which the
/// smooth minimum fills, and below the soles, which are cut flat, the true distance may be larger. Any finite point.
double mannequin_distance(const Vec3& point);

/// The surface as a watertight, left-right symmetric mesh, normals outward, vertices within 1e-9 m of the surface.
/// spacing: edge length aimed at, 0.008 ... 0.02 m (coarser would lose the hands). Throws SceneError.
TriangleMesh make_mannequin(double spacing);

}  // namespace percale::scenes
