#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Where the solid of a closed surface is (winding number not 0, Jacobson et al. 2013), seen from a triangle of it.
enum class FaceSides : unsigned char {
    unproven,  // other triangles cross or touch it, so that its sides may vary, or the search gave up
    outward,   // behind its normal, also where it is the wall of a cavity
    inward,    // before its normal: the surface is inside out there
    internal,  // on both sides, where parts of a mesh overlap: nothing can meet it without crossing others first
};

/// The sides of each triangle of a closed surface. All are unproven where more than 200 pairs a triangle and two million would
/// have to be tested.
std::vector<FaceSides> face_sides(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
