#pragma once

#include "percale/mesh.h"

namespace percale {

// Signed distance to the shapes that make_plane, make_sphere, make_box, make_cylinder and make_capsule approximate by triangles,
// at the same place: m, > 0 outside, < 0 inside, where -distance is the depth. Closed forms, exact apart from rounding: the
// meshes differ from them by the error of their chords. Sizes in m, > 0 (a capsule's height may be 0).

/// Above the plane y = 0 is outside.
double plane_distance(const Vec3& point);
double sphere_distance(const Vec3& point, double radius);
/// `size`: edge lengths.
double box_distance(const Vec3& point, const Vec3& size);
double cylinder_distance(const Vec3& point, double radius, double height);
/// `height`: between the centres of the two half spheres.
double capsule_distance(const Vec3& point, double radius, double height);

}  // namespace percale
