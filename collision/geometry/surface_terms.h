#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/triangle_distance.h"

namespace percale {

/// One term of the contact of a point with a surface of triangles.
struct SurfaceTerm {
    double distance = 0.0;           // m
    std::array<double, 3> weight{};  // of the face's corners, barycentric
    Vec3 apart = Vec3::Zero();       // m, from the closest point to the point
    int factor = 0;                  // of its potential, not 0
    int place = 0;                   // 0: inside the face; 1 + k: on its edge k, from corner k on; 4 + k: its corner k
};

/// The terms of a point and one face.
struct SurfaceTerms {
    double distance = 0.0;  // m, of point and face
    int count = 0;
    std::array<SurfaceTerm, 7> terms;
};

/// The contact potential of a point p with a surface of faces f, edges e and vertices v,
///     sum_f P(|p - f|) - sum_e (n_e - 1) P(|p - e|) + sum_v (1 - E_v + 1/2 sum_e at v n_e) P(|p - v|),
/// n_e faces at an edge and E_v edges at a vertex, counts a surface once wherever p is, and is continuously differentiable (Li et
/// al., Convergent incremental potential contact, 2023; there n_e is 2, or 1 at the boundary). Terms with the same closest point
/// are put together by its feature: above the inside of a face, a ridge or a peak one term is left, with factor 1; above a valley
/// both faces count, less its edge. Here are the terms that one face represents: its own, and those of the edges and corners that
/// it owns.
///
/// `Surface` has:  Vec3 at(int vertex);  const Triangle& corners(int face);  int edge(int face, int k);
///     bool owns_edge(int face, int edge);  bool owns_vertex(int face, int vertex);
///     for_faces(int edge, work(int opposite));  for_edges(int vertex, work(int edge, int other)).
template <class Surface>
class SurfaceTermFinder {
public:
    SurfaceTermFinder(const Surface& surface, int face, const Vec3& p, double thickness)
        : surface_(surface), face_(face), corners_(surface.corners(face)), p_(p), thickness_(thickness) {
        for (int k = 0; k < 3; ++k) x_[k] = surface.at(corners_[k]);
    }

    SurfaceTerms find() {
        const PointTriangle closest = closest_on_triangle(p_, x_[0], x_[1], x_[2]);
        found_.distance = std::sqrt(closest.distance_squared);
        if (found_.distance >= thickness_) return found_;
        for (int k = 0; k < 3; ++k) feet_[k] = foot_on(corners_[k], corners_[next(k)]);
        if (!ends_on_edge_or_corner()) add(0, closest.weight, p_ - closest.point, 1);
        for (int k = 0; k < 3; ++k) add_edge(k);
        for (int k = 0; k < 3; ++k) add_corner(k);
        return found_;
    }

private:
    /// Square of a sine that is rounding. 0: triangles of deforming bodies that lose their area count twice.
    static constexpr double flat_square = 1e-24;

    /// The foot of the point on the line through an edge, the same to the last bit from all faces there: regions are told by it
    /// alone, so that over flat meshes the factors add up to 1 even where rounding decides the region.
    struct Foot {
        int low = 0, high = 0;  // vertices
        double along = 0.0, length_squared = 0.0;
        Vec3 apart = Vec3::Zero();

        bool inside() const { return along > 0.0 && along < length_squared; }
        /// An edge without length is at its lower end.
        bool at(int vertex) const { return vertex == low ? along <= 0.0 : along > 0.0 && along >= length_squared; }
        bool before(const Foot& other) const { return low < other.low || (low == other.low && high < other.high); }
    };
    Foot foot_on(int a, int b) const {
        Foot foot{.low = std::min(a, b), .high = std::max(a, b)};
        const Vec3 from = surface_.at(foot.low), edge = surface_.at(foot.high) - from, offset = p_ - from;
        foot.along = edge.dot(offset);
        foot.length_squared = edge.squaredNorm();
        if (foot.inside()) foot.apart = offset - foot.along / foot.length_squared * edge;
        return foot;
    }

    static int next(int k) { return (k + 1) % 3; }

    /// How a face goes on from the foot on its edge, as seen from the point: below 0 it falls away, above 0 it rises, and within
    /// rounding of 0 the point is above the edge of the face's plane, or the face has no area.
    int rise(const Foot& foot, int opposite) const {
        const Vec3 across = surface_.at(opposite) - surface_.at(foot.low);
        const double height = foot.apart.dot(across);
        const bool flat = height * height <= flat_square * foot.apart.squaredNorm() * across.squaredNorm();
        return flat ? 0 : height > 0.0 ? 1 : -1;
    }

    /// Whether the closest point of the face between an edge and an opposite vertex is the foot. A face without area ends at one
    /// of its edges, the first.
    bool ends_at(const Foot& foot, int opposite) const {
        if (!foot.inside()) return false;
        const int own = rise(foot, opposite);
        if (own != 0) return own < 0;
        const auto ends_before = [&](int end, int other) {
            const Foot beside = foot_on(end, opposite);
            return beside.before(foot) && beside.inside() && rise(beside, other) == 0;
        };
        return !ends_before(foot.low, foot.high) && !ends_before(foot.high, foot.low);
    }

    bool ends_on_edge_or_corner() const {
        for (int k = 0; k < 3; ++k) {
            if (ends_at(feet_[k], corners_[next(next(k))])) return true;
            if (feet_[k].at(corners_[k]) && feet_[next(next(k))].at(corners_[k])) return true;
        }
        return false;
    }

    void add(int place, const std::array<double, 3>& weight, const Vec3& apart, int factor) {
        const double distance = apart.norm();
        if (distance >= thickness_ || factor == 0) return;
        found_.terms[found_.count++] = {.distance = distance, .weight = weight, .apart = apart, .factor = factor, .place = place};
    }

    void add_edge(int k) {
        const Foot& foot = feet_[k];
        if (!foot.inside() || foot.apart.squaredNorm() >= thickness_ * thickness_) return;
        const int edge = surface_.edge(face_, k);
        if (!surface_.owns_edge(face_, edge)) return;
        int factor = 1;
        surface_.for_faces(edge, [&](int opposite) { factor += ends_at(foot, opposite) ? 0 : -1; });
        const double part = foot.along / foot.length_squared;
        std::array<double, 3> weight{};
        weight[k] = corners_[k] == foot.low ? 1.0 - part : part;
        weight[next(k)] = 1.0 - weight[k];
        add(1 + k, weight, foot.apart, factor);
    }

    void add_corner(int k) {
        const int corner = corners_[k];
        const Vec3 apart = p_ - x_[k];
        if (apart.squaredNorm() >= thickness_ * thickness_ || !surface_.owns_vertex(face_, corner)) return;
        // An edge whose closest point is the corner counts 1 - n_e, a face between two such edges 1. Each face occurs at two
        // edges.
        int edges = 0, faces = 0, twice_own = 2;
        surface_.for_edges(corner, [&](int edge, int other) {
            const bool falls = foot_on(corner, other).at(corner);
            int around = 0;
            surface_.for_faces(edge, [&](int opposite) {
                ++around;
                faces += falls && foot_on(corner, opposite).at(corner);
            });
            if (around == 0) return;
            twice_own += around - 2;
            if (falls) edges += around - 1;
        });
        std::array<double, 3> weight{};
        weight[k] = 1.0;
        add(4 + k, weight, apart, (faces + twice_own) / 2 - edges);
    }

    const Surface& surface_;
    int face_;
    const Triangle& corners_;
    Vec3 p_;
    double thickness_;
    std::array<Vec3, 3> x_;
    std::array<Foot, 3> feet_;
    SurfaceTerms found_;
};

}  // namespace percale
