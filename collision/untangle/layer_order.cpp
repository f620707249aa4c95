#include "untangle/layer_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "certificate/box_tree.h"
#include "certificate/triangle_gap.h"
#include "geometry/triangle_distance.h"

namespace percale {
namespace {

/// Fraction of that gap. A place with this gap is left as it is, so that the rounds end.
constexpr double enough_gap = 0.8;

/// Fraction of area to the power 3/2. A cloth whose normals enclose less than three times that volume is a flat sheet. A tube ten
/// times as long as wide encloses 0.1.
constexpr double min_enclosing = 0.02;

Vec3 area_normal(const Triangle& t, std::span<const Vec3> x) { return 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]); }

/// A place on a surface, and how far outside of it a point is.
struct Foot {
    int triangle = -1;
    std::array<double, 3> weight = {};
    Vec3 normal = Vec3::Zero();
    double outside = 0.0;  // m, along the normal
};

/// Some of the triangles, with their outer normals.
class Sheet {
public:
    Sheet(const LayeredCloth& cloth, std::span<const Vec3> x, std::vector<int> triangles)
        : cloth_(cloth), x_(x), triangles_(std::move(triangles)), corners_(corners()), tree_(corners_) {
        for (const int t : triangles_) face_normal_.push_back(face_normal(t));
        add_normals();
    }

    /// The nearest place within reach of a vertex of another sheet where both face the same side, which excludes the other side
    /// of a limb; nothing where there is none, or where it lies on a rim.
    std::optional<Foot> foot_of(const Sheet& other, int vertex) const {
        const Vec3& point = x_[vertex];
        const Vec3& facing = other.vertex_normal_[vertex];
        certificate::Box here;
        here.add(point);
        const auto box_distance = [&](const certificate::Box& box) { return certificate::distance(here, box); };
        const auto item_distance = [&](int i) {
            if (face_normal_[i].dot(facing) <= 0.0) return std::numeric_limits<double>::infinity();
            return certificate::point_triangle_distance(point, corners_[i]);
        };
        const int item = tree_.nearest(cloth_.reach, box_distance, item_distance).first;
        if (item < 0) return std::nullopt;
        const auto& [a, b, c] = corners_[item];
        const PointTriangle nearest = closest_on_triangle(point, a, b, c);
        const std::optional<Vec3> normal = normal_at(triangles_[item], nearest);
        if (!normal) return std::nullopt;
        return Foot{triangles_[item], nearest.weight, *normal, normal->dot(point - nearest.point)};
    }

    /// The vertices, ascending.
    std::set<int> vertices() const {
        std::set<int> all;
        for (const int t : triangles_) all.insert(cloth_.surface.triangles[t].begin(), cloth_.surface.triangles[t].end());
        return all;
    }

private:
    std::vector<certificate::Corners> corners() const {
        std::vector<certificate::Corners> all;
        for (const int t : triangles_) {
            const auto& [a, b, c] = cloth_.surface.triangles[t];
            all.push_back({x_[a], x_[b], x_[c]});
        }
        return all;
    }

    Vec3 face_normal(int t) const {
        return cloth_.outwards[cloth_.cloth[t]] * area_normal(cloth_.surface.triangles[t], x_).normalized();
    }

    void add_normals() {
        vertex_normal_.assign(x_.size(), Vec3::Zero());
        on_rim_.assign(x_.size(), false);
        for (const int t : triangles_) {
            const Triangle& corner = cloth_.surface.triangles[t];
            for (int k = 0; k < 3; ++k) {
                const Vec3 u = x_[corner[(k + 1) % 3]] - x_[corner[k]], v = x_[corner[(k + 2) % 3]] - x_[corner[k]];
                vertex_normal_[corner[k]] += std::atan2(u.cross(v).norm(), u.dot(v)) * face_normal(t);
                const ClothSurface::Edge& edge = cloth_.surface.edges[cloth_.surface.triangle_edges[t][k]];
                if (edge.triangle[1] >= 0) continue;
                for (const int vertex : edge.vertex) on_rim_[vertex] = true;
            }
        }
    }

    std::optional<Vec3> normal_at(int t, const PointTriangle& place) const {
        const Triangle& corner = cloth_.surface.triangles[t];
        if (place.region == TriangleRegion::face) return face_normal(t);
        if (place.region == TriangleRegion::vertex) {
            const int vertex = corner[place.corner];
            return on_rim_[vertex] ? std::nullopt : std::optional<Vec3>(vertex_normal_[vertex].normalized());
        }
        const ClothSurface::Edge& edge = cloth_.surface.edges[cloth_.surface.triangle_edges[t][place.corner]];
        if (edge.triangle[1] < 0) return std::nullopt;
        return Vec3((face_normal(edge.triangle[0]) + face_normal(edge.triangle[1])).normalized());
    }

    const LayeredCloth& cloth_;
    std::span<const Vec3> x_;
    std::vector<int> triangles_;
    std::vector<certificate::Corners> corners_;
    certificate::BoxTree tree_;
    std::vector<Vec3> face_normal_;  // of each of its triangles
    std::vector<Vec3> vertex_normal_;
    std::vector<bool> on_rim_;
};

/// Requested moves of vertices: each vertex moves by their mean.
struct Requests {
    std::vector<Vec3> moves;
    std::vector<double> weights;

    void add(int vertex, double weight, const Vec3& move) {
        moves[vertex] += weight * move;
        weights[vertex] += weight;
    }
};

std::vector<int> triangles_of(const LayeredCloth& cloth, int layer) {
    std::vector<int> triangles;
    for (std::size_t t = 0; t < cloth.layer.size(); ++t) {
        if (cloth.layer[t] == layer) triangles.push_back(static_cast<int>(t));
    }
    return triangles;
}

/// Requests the moves that bring the upper of two layers outside of the lower one; returns false where it is outside.
bool ask_outside(const LayeredCloth& cloth, const Sheet& lower, const Sheet& upper, Requests& requests) {
    bool any = false;
    for (const int vertex : upper.vertices()) {
        const auto foot = lower.foot_of(upper, vertex);
        if (!foot || foot->outside >= enough_gap * cloth.gap) continue;
        requests.add(vertex, 1.0, (cloth.gap - foot->outside) * foot->normal);
        any = true;
    }
    for (const int vertex : lower.vertices()) {
        const auto foot = upper.foot_of(lower, vertex);
        if (!foot || foot->outside <= -enough_gap * cloth.gap) continue;
        double squares = 0.0;
        for (const double weight : foot->weight) squares += weight * weight;
        for (int k = 0; k < 3; ++k) {
            const double weight = foot->weight[k];
            if (weight == 0.0) continue;
            const Vec3 move = (weight / squares) * (cloth.gap + foot->outside) * foot->normal;
            requests.add(cloth.surface.triangles[foot->triangle][k], weight, move);
        }
        any = true;
    }
    return any;
}

/// Pushes one layer outside of each that is below it.
bool push_layer(const LayeredCloth& cloth, int layer, const std::set<int>& layers, std::vector<Vec3>& x) {
    const Sheet upper(cloth, x, triangles_of(cloth, layer));
    Requests requests{std::vector<Vec3>(x.size(), Vec3::Zero()), std::vector<double>(x.size(), 0.0)};
    bool any = false;
    for (auto below = layers.begin(); *below != layer; ++below) {
        any = ask_outside(cloth, Sheet(cloth, x, triangles_of(cloth, *below)), upper, requests) || any;
    }
    for (std::size_t v = 0; v < x.size(); ++v) {
        if (requests.weights[v] > 0.0 && cloth.free[v] > 0.0) x[v] += requests.moves[v] / requests.weights[v];
    }
    return any;
}

}  // namespace

std::vector<double> outward_signs(std::span<const Triangle> triangles, std::span<const int> cloth, std::span<const Vec3> x) {
    const int cloths = 1 + *std::max_element(cloth.begin(), cloth.end());
    std::vector<Vec3> middle(cloths, Vec3::Zero());
    std::vector<double> area(cloths, 0.0), away(cloths, 0.0), signs;
    const auto centre = [&](const Triangle& t) { return Vec3((x[t[0]] + x[t[1]] + x[t[2]]) / 3.0); };
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const double own = area_normal(triangles[t], x).norm();
        middle[cloth[t]] += own * centre(triangles[t]);
        area[cloth[t]] += own;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        away[cloth[t]] += (centre(triangles[t]) - middle[cloth[t]] / area[cloth[t]]).dot(area_normal(triangles[t], x));
    }
    for (int k = 0; k < cloths; ++k) {
        signs.push_back(away[k] < -min_enclosing * area[k] * std::sqrt(area[k]) ? -1.0 : 1.0);
    }
    return signs;
}

bool push_outside(const LayeredCloth& cloth, std::vector<Vec3>& positions) {
    const std::set<int> layers(cloth.layer.begin(), cloth.layer.end());
    bool any = false;
    for (const int layer : layers) {
        if (layer != *layers.begin()) any = push_layer(cloth, layer, layers, positions) || any;
    }
    return any;
}

}  // namespace percale
