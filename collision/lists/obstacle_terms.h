#pragma once

#include <span>

#include "geometry/surface_terms.h"
#include "lists/contact_pair.h"

namespace percale {

/// The terms of the contact potential (geometry/surface_terms.h) of a cloth vertex with an obstacle that this pair of vertex and
/// face represents. Edges and corners belong to the first triangle that has them. No terms are at the thickness or beyond.
SurfaceTerms obstacle_terms(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction,
                            double thickness);

}  // namespace percale
