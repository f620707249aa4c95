#include "hinges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/rest_edges.h"
#include "mesh/topology.h"

namespace percale {
namespace {

/// Radians. Smaller rest angles count as 0, those between triangles that curve with a radius of a thousand edges or more.
/// Smaller: the rounding of a file makes hinges of flat panels curved (8 digits: by 4e-5), which costs more and takes long to
/// solve where cloth folds together.
constexpr double min_rest_angle = 1e-3;

/// Fraction of a cell's size (of its square, for its corner's cosine). A grid whose cells differ by less is regular and gets
/// hinges along its lines. Smaller: grids given in single precision get hinges of triangles. Larger: bending has an error of
/// that size.
constexpr double grid_cell_error = 1e-6;

/// A triangle on one side of an edge: its height over the edge, and the foot of the height, from 0 at the edge's first vertex to
/// 1 at its second.
struct Side {
    double area, height, foot;
};

Side side_of(const Vec3& a, const Vec3& edge, const Vec3& opposite) {
    const double area = 0.5 * edge.cross(opposite - a).norm();
    return {area, 2.0 * area / edge.norm(), edge.dot(opposite - a) / edge.squaredNorm()};
}

/// Angle between the normals e x (x2 - x0) and (x3 - x0) x e, positive where the opposite vertices lie behind them.
double rest_angle(const std::array<Vec3, 4>& x) {
    const Vec3 edge = x[1] - x[0], first = edge.cross(x[2] - x[0]), second = (x[3] - x[0]).cross(edge);
    const double angle = std::atan2(first.cross(second).dot(edge.normalized()), first.dot(second));
    return std::abs(angle) > min_rest_angle ? angle : 0.0;
}

/// `x`: the corners without strain, m.
Hinge triangle_hinge(const MeshEdge& edge, const std::array<Vec3, 4>& x, double bend_stiffness) {
    Hinge hinge{.vertex = {edge.vertex[0], edge.vertex[1], edge.opposite[0], edge.opposite[1]}, .weight = {}, .stiffness = 0.0};
    const Vec3 along = x[1] - x[0];
    const Side first = side_of(x[0], along, x[2]), second = side_of(x[0], along, x[3]);
    hinge.weight = {-(1.0 - first.foot) / first.height - (1.0 - second.foot) / second.height,
                    -first.foot / first.height - second.foot / second.height, 1.0 / first.height, 1.0 / second.height};
    hinge.stiffness = bend_stiffness * along.squaredNorm() / (first.area + second.area);
    hinge.rest_angle = rest_angle(x);
    return hinge;
}

using PairNumbers = std::map<std::pair<int, int>, int>;

/// Adds the hinges of one cloth.
class HingeWriter {
public:
    HingeWriter(const HingeMesh& mesh, double bend_stiffness, Hinges& hinges, SpringNetwork& network)
        : mesh_(mesh), bend_stiffness_(bend_stiffness), hinges_(hinges), network_(network) {
        for (int k = mesh.first_spring; k < network.size(); ++k) {
            numbers_.try_emplace(std::minmax(network.first[k], network.second[k]), k);
        }
    }

    void add_triangles() {
        const std::vector<MeshEdge> edges = mesh_edges(mesh_.triangles);
        std::vector<RestEdge> shaped;
        if (!mesh_.corners.empty()) shaped = rest_edges(mesh_.triangles, edges, mesh_.corners);
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const auto& [ends, opposite] = edges[k];
            if (opposite[1] < 0) continue;
            const auto at_rest = [&](int vertex) { return mesh_.rest[static_cast<std::size_t>(vertex)]; };
            const std::array<Vec3, 4> lying = {at_rest(ends[0]), at_rest(ends[1]), at_rest(opposite[0]), at_rest(opposite[1])};
            add(triangle_hinge(edges[k], shaped.empty() ? lying : shaped[k].corner, bend_stiffness_));
        }
    }

    /// Whether all cells are the same rectangle.
    bool is_regular_grid() const {
        if (mesh_.columns < 2 || mesh_.rows < 2) return false;
        const Vec3 along = at(1, 0) - at(0, 0), across = at(0, 1) - at(0, 0);
        const double size = along.norm() + across.norm();
        if (std::abs(along.dot(across)) > grid_cell_error * size * size) return false;
        for (int r = 0; r < mesh_.rows; ++r) {
            for (int c = 0; c < mesh_.columns; ++c) {
                const Vec3 regular = at(0, 0) + c * along + r * across;
                if ((at(c, r) - regular).norm() > grid_cell_error * size) return false;
            }
        }
        return true;
    }

    void add_grid() {
        const double width = (at(1, 0) - at(0, 0)).norm(), depth = (at(0, 1) - at(0, 0)).norm();
        for (int r = 0; r < mesh_.rows; ++r) {
            for (int c = 0; c < mesh_.columns; ++c) {
                const bool first_or_last_row = r == 0 || r + 1 == mesh_.rows,
                           first_or_last_column = c == 0 || c + 1 == mesh_.columns;
                if (!first_or_last_column) add_line(c, r, {1, 0}, width, first_or_last_row ? 0.5 * depth : depth);
                if (!first_or_last_row) add_line(c, r, {0, 1}, depth, first_or_last_column ? 0.5 * width : width);
                if (c + 1 < mesh_.columns && r + 1 < mesh_.rows) add_twist(c, r, width * depth);
            }
        }
    }

private:
    int index(int column, int row) const { return mesh_.first_vertex + row * mesh_.columns + column; }
    const Vec3& at(int column, int row) const { return mesh_.rest[index(column, row)]; }

    /// The second difference along a line through (c, r), segments of length h, over the given breadth of cloth.
    void add_line(int c, int r, std::array<int, 2> step, double h, double breadth) {
        add({.vertex = {index(c, r), -1, index(c - step[0], r - step[1]), index(c + step[0], r + step[1])},
             .weight = {-2.0 / h, 0.0, 1.0 / h, 1.0 / h},
             .stiffness = bend_stiffness_ * breadth / h});
    }

    void add_twist(int c, int r, double area) {
        const double w = 1.0 / std::sqrt(area);
        add({.vertex = {index(c, r), index(c + 1, r + 1), index(c + 1, r), index(c, r + 1)},
             .weight = {w, w, -w, -w},
             .stiffness = 2.0 * bend_stiffness_,
             .folds = false});
    }

    void add(Hinge hinge) {
        for (int p = 0; p < 6; ++p) {
            const int first = hinge.vertex[hinge_pairs[p][0]], second = hinge.vertex[hinge_pairs[p][1]];
            if (first >= 0 && second >= 0) hinge.pair[p] = pair_number(first, second);
        }
        if (hinge.rest_angle != 0.0) hinges_.curved.push_back(static_cast<int>(hinges_.all.size()));
        hinges_.all.push_back(hinge);
    }

    int pair_number(int i, int j) {
        const auto [low, high] = std::minmax(i, j);
        const auto [found, is_new] = numbers_.try_emplace({low, high}, network_.size());
        if (is_new) append_pair(low, high, network_);
        return found->second;
    }

    const HingeMesh& mesh_;
    double bend_stiffness_;
    Hinges& hinges_;
    SpringNetwork& network_;
    PairNumbers numbers_;
};

}  // namespace

void append_hinges(const HingeMesh& mesh, double bend_stiffness, Hinges& hinges, SpringNetwork& network) {
    HingeWriter writer(mesh, bend_stiffness, hinges, network);
    writer.is_regular_grid() ? writer.add_grid() : writer.add_triangles();
}

void set_clamps(std::span<const double> free, Hinges& hinges) {
    for (Hinge& hinge : hinges.all) {
        const auto pinned = [&](int k) { return hinge.vertex[k] < 0 || free[hinge.vertex[k]] == 0.0; };
        hinge.clamp = hinge.folds && pinned(0) && pinned(1) && pinned(2) != pinned(3) ? 2.0 : 1.0;
    }
}

void set_pair_bending(const Hinges& hinges, SpringNetwork& network) {
    network.bending.assign(hinges.all.empty() ? 0 : network.size(), 0.0);
    for (const Hinge& hinge : hinges.all) {
        for (int p = 0; p < 6; ++p) {
            if (hinge.pair[p] < 0) continue;
            const double product = hinge.weight[hinge_pairs[p][0]] * hinge.weight[hinge_pairs[p][1]];
            network.bending[hinge.pair[p]] -= hinge.clamp * hinge.stiffness * product;
        }
    }
}

}  // namespace percale
