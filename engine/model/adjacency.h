#pragma once

#include <array>
#include <vector>

#include "kernels/compute.h"
#include "membrane_entries.h"
#include "spring_network.h"
#include "support/aligned.h"
#include "vec3_arrays.h"

namespace percale {

/// Which springs meet at each vertex, in slices of slice_lanes vertices padded to the slice's largest number of springs (sliced
/// ELL). Entry e of lane l of slice s stands at start[s] + e * slice_lanes + l. The order of a vertex's entries is that of the
/// springs, so sums over them have the same bits however the work is divided. Padding refers to the vertex itself and to spring
/// number `network.size()`, which does not exist and has no stiffness.
struct Adjacency {
    int vertex_count = 0;
    std::vector<int> start = {0};  // of each slice; one more at the end
    AlignedVector<int> other;      // the vertex at the other end
    std::vector<int> spring;       // which spring
    BandPattern bands;             // count = 0 unless the springs lie in few bands, as on a single grid
    std::vector<int> place;        // of each spring, in the lists below: its place in the bands, or the entry at its first vertex
    AlignedVector<double> stiffness, rest_length, damping;  // N/m, m, N s/m of each place
    AlignedVector<double> bending;                          // N/m of each place; empty without hinges
    bool damped = false;                                    // any spring has damping
    std::vector<int> sewn;     // springs, ascending: a vertex sewn to a point, with each of its two ends
    MembraneEntries membrane;  // empty without triangles

    /// How many numbers the blocks a, w of all places take, and where those of a spring stand, `apart` from each other.
    std::size_t value_count() const;
    struct ValuePlace {
        std::size_t first, apart;
    };
    ValuePlace value_place(int k) const;
    /// The entries of a spring at both of its ends, in slices.
    std::array<int, 2> entries_of(const SpringNetwork& network, int k) const;
    /// The stiffness of a spring that alone becomes longer, its triangles included, but hinges left out, N/m.
    double strength(int k) const;
    /// The size of a vector as kernels want it (pack_points).
    std::size_t point_count() const;

    int slices() const { return static_cast<int>(start.size()) - 1; }
    EntryPattern pattern() const { return {start.data(), other.data(), bands.count > 0 ? &bands : nullptr}; }
    SpringEntries springs() const {
        return {pattern(), stiffness.data(), rest_length.data(), damping.data(), bending.empty() ? nullptr : bending.data()};
    }
};

/// A copy of Vec3 arrays as the kernels need it for these springs: x y z 0 of every vertex, or with bands three guarded arrays.
void pack_points(const Compute& compute, const Adjacency& adjacency, const Vec3Arrays& from, AlignedVector<double>& points);
/// The same in parts: once for the size and the guards, then range by range.
void prepare_points(const Adjacency& adjacency, AlignedVector<double>& points);
void place_points(const Compute& compute, const Adjacency& adjacency, const Vec3Arrays& from, AlignedVector<double>& points,
                  Slices range);

/// The layout of the numbers of all springs.
enum class SpringLayout { best, slices };

/// Copies network.bending again, from the network that the adjacency was made for.
void copy_bending(const SpringNetwork& network, Adjacency& adjacency);

/// Puts the rest length of one spring, m, into a list that is laid out as adjacency.rest_length.
void put_rest_length(const Adjacency& adjacency, const SpringNetwork& network, int spring, double length,
                     AlignedVector<double>& list);

/// Membranes are laid out beside the springs of their edges, which must be there, in slices.
void add_membrane(Adjacency& adjacency, const SpringNetwork& network, const std::vector<MembraneTriangle>& triangles);

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count, SpringLayout layout = SpringLayout::best);

}  // namespace percale
