#pragma once

#include <span>
#include <vector>

#include "geometry/cloth_surface.h"

namespace percale {

/// Cloth whose triangles have layers, by how far out they are worn.
struct LayeredCloth {
    const ClothSurface& surface;
    std::span<const int> cloth;        // of each triangle
    std::span<const int> layer;        // of each triangle
    std::span<const double> outwards;  // of each cloth: outward_signs
    std::span<const double> free;      // of each vertex; 0: stays
    double reach;                      // m, farther from a lower layer nothing is moved
    double gap;                        // m, between layers
};

/// For each cloth 1 where the normals of its winding point outside, else -1: where most of its area faces its middle. For a
/// nearly flat sheet the winding counts.
std::vector<double> outward_signs(std::span<const Triangle> triangles, std::span<const int> cloth,
                                  std::span<const Vec3> positions);

/// Moves cloth outside of the lower layers that it is near, once; returns false where nothing had to move. Cloth near the rim of
/// a lower layer stays: beyond it there is no outside.
///
/// A vertex x whose nearest place on a lower layer is p, with the angle-weighted normal n there (Baerentzen and Aanaes, Signed
/// distance computation using the angle weighted pseudonormal, 2005), goes to n . (x - p) = gap if it is much nearer; the
/// triangles above a vertex of a lower layer likewise.
bool push_outside(const LayeredCloth& cloth, std::vector<Vec3>& positions);

}  // namespace percale
