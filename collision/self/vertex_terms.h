#pragma once

#include <array>
#include <span>

#include "self/self_list_maker.h"
#include "self/self_pair.h"

namespace percale {

/// One term of the contact of a vertex with a surface of triangles.
struct VertexTerm {
    double distance = 0.0;           // m
    std::array<double, 4> weight{};  // of the pair's vertices: 1 for the vertex, < 0 on the surface, sum 0
    Vec3 direction = Vec3::Zero();   // unit, surface towards vertex
    int factor = 0;                  // of its potential, not 0
};

/// The terms of one pair of vertex and face.
struct VertexTerms {
    double distance = 0.0;  // m, of vertex and face
    int count = 0;
    std::array<VertexTerm, 7> terms;  // of the face, its edges and corners
};

/// The contact potential of a vertex p with a surface of faces f, inner edges e and inner vertices v,
///     sum_f P(|p - f|) - sum_e P(|p - e|) + sum_v P(|p - v|),
/// counts a surface once wherever p is, and is continuously differentiable (Li et al., Convergent incremental potential contact,
/// 2023). Terms with the same closest point are put together by its feature: above the inside of a face, a ridge or a peak one
/// term is left, with factor 1; above a valley both faces count, less its edge. Here are the terms that this pair represents:
/// that of its face, and those of the edges and corners of which the face is the first that the vertex meets. A face that the
/// vertex does not meet (SelfCloth::meets) is no part of the surface. No terms are at the pair's thickness or beyond.
VertexTerms vertex_terms(const SelfPair& pair, std::span<const Vec3> positions, const SelfCloth& cloth);

}  // namespace percale
