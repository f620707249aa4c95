#pragma once

#include <vector>

#include "kernels/kernels.h"
#include "membrane.h"
#include "support/aligned.h"

namespace percale {

/// The triangles of membranes as kernels see them: each edge from both of its ends, at the entry of its spring (membrane
/// force), and each triangle from its three vertices, in slices of corners (products with its matrix).
struct MembraneEntries {
    AlignedVector<int> opposite[2];      // of each entry; that at the other end where there is no triangle
    AlignedVector<double> numbers[7];    // of each entry: MembraneEdges
    std::vector<int> corner_start;       // of each slice; one more at the end
    AlignedVector<int> corner_other[2];  // the other vertices of each corner's triangle; the vertex itself for padding
    AlignedVector<double> coupling;      // MembraneCorners::coupling

    bool empty() const { return corner_start.empty(); }
    std::size_t corner_count() const { return corner_other[0].size(); }
    MembraneEdges edges() const;
    MembraneCorners corners() const;
};

/// Where the entries of an adjacency in slices stand: start of each slice, the vertex at the other end, and whether an entry may
/// be an edge of a triangle.
struct EntryView {
    const std::vector<int>& start;
    const AlignedVector<int>& other;
    const std::vector<bool>& is_edge;
};

/// Every edge of the triangles must have one entry at each of its ends.
MembraneEntries make_membrane_entries(const std::vector<MembraneTriangle>& triangles, const EntryView& entries);

}  // namespace percale
