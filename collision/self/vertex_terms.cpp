#include "self/vertex_terms.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_distance.h"

namespace percale {
namespace {

class TermFinder {
public:
    TermFinder(const SelfPair& pair, std::span<const Vec3> x, const SelfCloth& cloth)
        : pair_(pair),
          x_(x),
          cloth_(cloth),
          surface_(cloth.surface),
          vertex_(pair.vertex[0]),
          face_(pair.feature[1]),
          p_(x[vertex_]) {}

    VertexTerms find() {
        closest_ = closest_of(face_);
        found_.distance = std::sqrt(closest_.distance_squared);
        if (found_.distance >= pair_.thickness) return found_;
        if (closest_.region == TriangleRegion::face)
            add({1.0, -closest_.weight[0], -closest_.weight[1], -closest_.weight[2]}, p_ - closest_.point, 1);
        for (int k = 0; k < 3; ++k) add_edge(k);
        for (int k = 0; k < 3; ++k) add_corner(k);
        return found_;
    }

private:
    PointTriangle closest_of(int triangle) const {
        const Triangle& corners = surface_.triangles[triangle];
        return closest_on_triangle(p_, x_[corners[0]], x_[corners[1]], x_[corners[2]]);
    }

    bool meets(int triangle) const { return triangle >= 0 && (triangle == face_ || cloth_.meets(vertex_, triangle)); }

    void add(const std::array<double, 4>& weight, const Vec3& apart, int factor) {
        const double distance = apart.norm();
        if (distance >= pair_.thickness || factor == 0) return;
        VertexTerm& term = found_.terms[found_.count++];
        term = {.distance = distance, .weight = weight, .factor = factor};
        if (distance > 0.0) term.direction = apart / distance;
    }

    /// Whether the closest point of a face lies on one of its edges; not of one that the vertex does not meet.
    bool ends_at(int triangle, int edge) const {
        const PointTriangle closest = triangle == face_ ? closest_ : closest_of(triangle);
        return closest.region == TriangleRegion::edge && surface_.triangle_edges[triangle][closest.corner] == edge;
    }

    void add_edge(int k) {
        const int from = pair_.vertex[1 + k], to = pair_.vertex[1 + (k + 1) % 3], number = surface_.triangle_edges[face_][k];
        const Vec3 along = x_[to] - x_[from];
        const double s = along.dot(p_ - x_[from]) / along.squaredNorm();
        if (!(s > 0.0 && s < 1.0)) return;
        const Vec3 apart = p_ - x_[from] - s * along;
        if (apart.squaredNorm() >= pair_.thickness * pair_.thickness) return;
        const std::array<int, 2>& beside = surface_.edges[number].triangle;
        const std::array met{meets(beside[0]), meets(beside[1])};
        if ((met[0] ? beside[0] : beside[1]) != face_) return;
        int factor = met[0] && met[1] ? -1 : 0;
        for (int side = 0; side < 2; ++side) factor += met[side] && ends_at(beside[side], number);
        std::array<double, 4> weight{1.0, 0.0, 0.0, 0.0};
        weight[1 + k] = s - 1.0;
        weight[1 + (k + 1) % 3] = -s;
        add(weight, apart, factor);
    }

    void add_corner(int k) {
        const int corner = pair_.vertex[1 + k];
        const Vec3 apart = p_ - x_[corner];
        if (apart.squaredNorm() >= pair_.thickness * pair_.thickness) return;
        const int lowest = surface_.vertex_owner[corner];
        if (lowest != face_ && meets(lowest)) return;
        // Whether the cloth from the corner to another vertex falls away: then the corner is the closest point of that edge, and
        // of the face between two such edges.
        const auto falls = [&](int other) { return apart.dot(x_[other] - x_[corner]) <= 0.0; };
        int faces = 0, edges = 0, owner = face_;  // each face of the corner occurs at two edges
        bool inner = true;
        for (const int number : surface_.edges_at(corner)) {
            const ClothSurface::Edge& edge = surface_.edges[number];
            const bool along = falls(edge.vertex[edge.vertex[0] == corner ? 1 : 0]);
            int met = 0;
            for (int side = 0; side < 2; ++side) {
                if (!meets(edge.triangle[side])) continue;
                ++met;
                owner = std::min(owner, edge.triangle[side]);
                faces += along && falls(edge.opposite[side]);
            }
            inner = inner && met == 2;
            edges += along && met == 2;
        }
        if (owner != face_) return;
        std::array<double, 4> weight{1.0, 0.0, 0.0, 0.0};
        weight[1 + k] = -1.0;
        add(weight, apart, faces / 2 - edges + (inner ? 1 : 0));
    }

    const SelfPair& pair_;
    std::span<const Vec3> x_;
    const SelfCloth& cloth_;
    const ClothSurface& surface_;
    int vertex_, face_;
    const Vec3& p_;
    PointTriangle closest_;
    VertexTerms found_;
};

}  // namespace

VertexTerms vertex_terms(const SelfPair& pair, std::span<const Vec3> positions, const SelfCloth& cloth) {
    return TermFinder(pair, positions, cloth).find();
}

}  // namespace percale
