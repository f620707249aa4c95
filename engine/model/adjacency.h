#pragma once

#include <vector>

#include "spring_network.h"

namespace percale {

/// Which springs meet at each vertex, in slices of Vectors::lanes vertices padded to the slice's largest number of springs
/// (sliced ELL). Entry e of lane l of slice s stands at start[s] + e * lanes + l. The order of a vertex's entries is that of
/// the springs, so sums over them have the same bits however the work is split. Padding refers to spring number
/// `network.size()`, which does not exist and counts as zero, and to the vertex itself.
struct Adjacency {
    int vertex_count = 0;
    std::vector<int> start = {0};  // of each slice; one more at the end
    std::vector<int> other;        // the vertex at the other end
    std::vector<int> spring;       // which spring
    std::vector<double> sign;      // +1 where the vertex is the spring's first, -1 where its second, 0 for padding

    int slices() const { return static_cast<int>(start.size()) - 1; }
};

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count);

}  // namespace percale
