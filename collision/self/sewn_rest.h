#pragma once

#include <span>
#include <vector>

#include "geometry/cloth_surface.h"
#include "geometry/disjoint_sets.h"
#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale {

/// How far features of cloth lie apart at rest on the path through a seam, as if it were closed. A knot is what stitches join:
/// vertices that are one, and points of edges at which such a vertex lies. Each vertex knows its paths along edges to the knots
/// near it.
class SewnRest {
public:
    SewnRest() = default;
    /// `rest`: m, of all vertices. Paths longer than `reach`, m, are left out, except those from a point of an edge to its ends.
    SewnRest(const ClothSurface& surface, std::span<const Stitch> stitches, std::span<const Vec3> rest, double reach);

    /// m, between two features given by their vertices, at most three; 0 where both are at one knot, infinity where no knot is
    /// near both.
    double distance(std::span<const int> first, std::span<const int> second) const;

    /// Whether one feature is at a knot, and the other holds an end of an edge with a point of the knot, of several points the
    /// nearest to that end. Where the sides of a seam have different vertices, that end lies on the other side's edge, whatever
    /// `distance` is along the seam.
    bool overlap(std::span<const int> first, std::span<const int> second) const;

private:
    struct Knot {
        std::vector<int> vertices;
        std::vector<Stitch> points;
    };
    struct Path {
        int knot = -1;
        double length = 0.0;  // m
    };

    class NearKnots;

    void make_knots(std::span<const Stitch> stitches);
    void find_ends(DisjointSets& sewn);
    void find_paths(int knot, const ClothSurface& surface, std::span<const Vec3> rest, double reach);
    bool lies_at(std::span<const int> feature, int knot) const;
    bool is_at(std::span<const int> feature, int knot) const;
    bool ends_at(std::span<const int> feature, std::span<const int> other) const;

    std::vector<Knot> knots_;
    std::vector<int> knot_of_;              // of each vertex, or -1
    std::vector<std::vector<int>> ends_;    // of each vertex: knots with the nearest point on an edge that ends there
    std::vector<std::vector<Path>> paths_;  // of each vertex, ascending knots
};

}  // namespace percale
