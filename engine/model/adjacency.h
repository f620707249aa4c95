#pragma once

#include <vector>

#include "kernels/kernels.h"
#include "spring_network.h"
#include "support/aligned.h"

namespace percale {

/// Which springs meet at each vertex, in slices of slice_lanes vertices padded to the slice's largest number of springs (sliced
/// ELL). Entry e of lane l of slice s stands at start[s] + e * slice_lanes + l. The order of a vertex's entries is that of the
/// springs, so sums over them have the same bits however the work is split. Padding refers to the vertex itself and to spring
/// number `network.size()`, which does not exist and has no stiffness.
struct Adjacency {
    int vertex_count = 0;
    std::vector<int> start = {0};  // of each slice; one more at the end
    AlignedVector<int> other;      // the vertex at the other end
    std::vector<int> spring;       // which spring
    std::vector<int> entry;        // of each spring, the entry at its first vertex
    AlignedVector<double> stiffness, rest_length, damping;  // N/m, m, N s/m of each entry
    bool damped = false;                                    // any spring has damping

    int slices() const { return static_cast<int>(start.size()) - 1; }
    EntryPattern pattern() const { return {start.data(), other.data()}; }
    SpringEntries springs() const { return {pattern(), stiffness.data(), rest_length.data(), damping.data()}; }
};

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count);

}  // namespace percale
