#pragma once

#include <array>
#include <limits>
#include <span>

#include "geometry/cloth_surface.h"
#include "geometry/time_of_impact.h"

namespace percale {

constexpr double no_seam = std::numeric_limits<double>::infinity();
constexpr std::array away_from_seams{no_seam, no_seam, no_seam, no_seam};

/// Two features of cloth that share no vertex: a vertex and a face, or two edges.
struct SelfPair {
    PairShape shape = PairShape::point_triangle;
    std::array<int, 4> vertex{-1, -1, -1, -1};  // the vertex and the face's corners; the ends of both edges
    std::array<int, 2> feature{-1, -1};         // vertex and triangle; two edges
    int record = -1;                            // its number in SelfList::records; -1: it has none
    double thickness = 0.0;                     // m, the largest activation distance of the pair
    double reach = 0.0;  // distance + travel when last measured: reach - travel bounds the distance from below
};

/// Additional data of few pairs: those near a seam, and those that are or were in contact. Pairs take most of the memory of a
/// cloth that lies in folds.
struct SelfPairRecord {
    int pair = -1;  // its number in SelfList::pairs
    /// m, activation distances near a seam. Vertex and face: entry k is that where corner vertex[1 + k] is closest, the last is
    /// unused. Edges: those where the ends (0, 2), (0, 3), (1, 2), (1, 3) are closest.
    std::array<double, 4> seam_activation_distance = away_from_seams;
    double activation_distance = 0.0;  // m, of the contact of two edges; 0: it is none
};

/// The exact closest points of two edges.
struct EdgeContact {
    double distance = 0.0;           // m
    std::array<double, 4> weight{};  // of the pair's vertices: > 0 on the first side, < 0 on the second, sum 0
    Vec3 direction = Vec3::Zero();   // unit, second side towards first
    /// Fraction of the thickness below which the pair represents the contact: where the closest points are inside two edges, 1
    /// for ridges and boundaries, 3/4 in flat cloth, where vertices and faces meet first, in between according to the bend of the
    /// cloth, times `crossing`. Else 0. It is not computed for edges farther apart than the pair's thickness.
    double activation_ratio = 0.0;
    /// A factor that fades nearly parallel edges, contained in activation_ratio: 0 where their closest points jump from end to
    /// end, 1 from twice that angle on.
    double crossing = 1.0;
};

/// m, activation distance of a pair whose closest points have these weights (seam_activation_distance: SelfPairRecord): it is
/// interpolated between corners, so that it is continuous where closest points pass from one face to the next.
double activation_distance_at(const SelfPair& pair, const std::array<double, 4>& seam_activation_distance,
                              const std::array<double, 4>& weight);

/// Distance of the pair, m.
double self_distance(const SelfPair& pair, std::span<const Vec3> positions);

EdgeContact edge_contact(const SelfPair& pair, std::span<const Vec3> positions, const ClothSurface& surface);

MovingFour moving_pair(const SelfPair& pair, std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace percale
