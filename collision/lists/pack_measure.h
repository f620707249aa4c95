#pragma once

#include <span>

#include "lists/contact_pair.h"

namespace percale {

/// The kernels of the widest instruction set that the processor has and PERCALE_INSTRUCTIONS in the environment allows.
const PackKernels& pack_kernels();

/// Distances in the query about a cloth feature and a pack, m.
struct PackLimits {
    double near = 0.0;
    double thickness = 0.0;
};

/// Bounds for the cloth feature of `pair` and all features of a pack that is placed where the obstacle is.
PackAnswer measure(const ContactPair& pair, std::span<const Vec3> cloth, const PlacedPack& placed, const PackLimits& limits);

/// Whether the cloth feature of `pair` is higher than that above a hull at both ends of a move, m.
inline bool stays_above(const PackHull& hull, const ContactPair& pair, const ClothMove& move, double height) {
    return height_above(hull, pair.vertices(), move.from) > height && height_above(hull, pair.vertices(), move.to) > height;
}

}  // namespace percale
