#pragma once

#include <array>
#include <limits>
#include <span>

#include "geometry/time_of_impact.h"
#include "obstacle/obstacle.h"
#include "percale/contact.h"

namespace percale {

/// A cloth feature and an obstacle feature that may come near each other.
struct ContactPair {
    PairKind kind = PairKind::vertex_face;
    std::array<int, 3> cloth{-1, -1, -1};   // vertices: 1, 2 or 3
    unsigned char edge_bits = 7;            // face_vertex: which edges of the cloth triangle it owns
    std::array<int, 3> across{-1, -1, -1};  // face_vertex: what lies across each edge in cloth, a vertex; -1: nothing
    int obstacle = 0;
    int feature = 0;  // obstacle triangle, edge or vertex

    int cloth_count() const { return static_cast<int>(kind) + 1; }
    std::span<const int> vertices() const { return {cloth.data(), static_cast<std::size_t>(cloth_count())}; }
    /// The same cloth feature with an obstacle feature of a pack.
    ContactPair with(const FeaturePack& pack, int lane) const {
        ContactPair full = *this;
        full.feature = pack.feature[lane];
        return full;
    }
};

/// The exact closest points of a cloth feature and an obstacle feature.
struct PairContact {
    double distance = 0.0;           // m
    std::array<double, 4> weight{};  // of the cloth vertices
    Vec3 cloth_point = Vec3::Zero();
    Vec3 obstacle_point = Vec3::Zero();
    Vec3 direction = Vec3::Zero();  // unit, obstacle towards cloth; zero if the distance is
    Vec3 obstacle_displacement = Vec3::Zero();
    double crossing = std::numeric_limits<double>::infinity();  // m, |u| sin of the angle between edges, u the shorter
    bool local_minimum = false;                                 // no neighbouring pair represents the same contact better
};

/// Distance only, m.
double pair_distance(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction);

/// From the obstacle's closest point to the cloth's, m: pair_distance is its length.
Vec3 pair_apart(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction);

/// Factor on the stiffness of an edge-edge contact, 0 ... 1. It is below 1 only for edges so nearly parallel that the closest
/// points lie anywhere along them: the point of action would jump from one end to the other, and both ends are contacts of their
/// own, hardly farther away. It grows smoothly from 0 to 1 at the angle at which the ends are 1e-3 of the thickness farther away
/// than the middle (a mollifier in the sense of Li et al. 2020, Incremental Potential Contact). Without it Newton did not end on
/// a strip over a cylinder of 64 facets whose cross threads are parallel to the edges: 330 iterations a step, with it 8.
double edge_mollifier(const PairContact& contact, double thickness);

/// Everything about the closest points of two edges, or of a face of cloth and an obstacle vertex. A contact belongs to exactly
/// one pair: closest points inside the face or inside both edges belong to that pair if the obstacle's feature faces the cloth,
/// those on a cloth edge to the triangle that owns it, unless the one across comes nearer: then its inside or another edge of it
/// is the contact. Vertices of cloth: obstacle_terms.h.
PairContact pair_contact(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction);

/// Prefetches what pair_contact reads of the obstacle. Each depth reads what the one before has prefetched.
constexpr int pair_fetches = 3;
void fetch_pair(const ContactPair& pair, const Obstacle& obstacle, int depth);

/// The pair as four points moving while the cloth goes from one state to another and obstacles over a fraction of the step.
struct ClothMove {
    std::span<const Vec3> from, to;
    StepFraction fraction;
};
MovingFour moving_pair(const ContactPair& pair, const ClothMove& move, const Obstacle& obstacle);

/// Which of its points belong to the cloth, a bit each.
inline unsigned cloth_slots(PairKind kind) {
    if (kind == PairKind::vertex_face) return 0b0001;
    return kind == PairKind::edge_edge ? 0b0011 : 0b1110;
}

inline PairShape shape_of(PairKind kind) {
    return kind == PairKind::edge_edge ? PairShape::edge_edge : PairShape::point_triangle;
}

}  // namespace percale
