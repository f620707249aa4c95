#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// The order of a cloth's vertices in memory: `place` of each of the user's vertices, and the user's `vertex` at each place.
/// Both are empty where the user's order is kept.
struct VertexOrder {
    std::vector<int> place;
    std::vector<int> vertex;

    bool kept() const { return place.empty(); }
    int place_of(int user_vertex) const { return kept() ? user_vertex : place[user_vertex]; }
    int vertex_at(int at) const { return kept() ? at : vertex[at]; }
};

/// The numbers of the points in the order of a Hilbert curve through their bounding cube, with a resolution of a millionth of
/// its edge; nearer ones stay in order. At least one point.
std::vector<int> along_curve(std::span<const Vec3> points);

/// An order with neighbours near each other in memory, and about as many springs at each vertex of a slice, so that slices have
/// little padding: along a Hilbert curve of the rest positions (m), sorted by `springs`, their number at each vertex, within
/// short windows.
VertexOrder memory_order(std::span<const Vec3> rest, std::span<const int> springs);

}  // namespace percale
