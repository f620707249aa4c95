#pragma once

#include <span>

#include "geometry/surface_terms.h"
#include "self/self_list_maker.h"
#include "self/self_pair.h"

namespace percale {

/// The terms of the contact potential (geometry/surface_terms.h) of a vertex with cloth that this pair represents: those of its
/// face, and those of the edges and corners of which the face is the first that the vertex meets. A face that the vertex does not
/// meet (SelfCloth::meets) is no part of the surface. No terms are at the pair's thickness or beyond.
SurfaceTerms vertex_terms(const SelfPair& pair, std::span<const Vec3> positions, const SelfCloth& cloth);

}  // namespace percale
