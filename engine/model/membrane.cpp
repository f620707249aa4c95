#include "membrane.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mesh/rest_edges.h"
#include "mesh/topology.h"
#include "percale/error.h"

namespace percale {
namespace {

/// Fraction of the shear modulus by which a fabric may differ from an isotropic one and count as isotropic.
constexpr double isotropic_shear_error = 1e-3;

double mean_modulus(const Fabric& fabric) {
    const auto [warp, weft] = *fabric.stretch_stiffness;
    return std::sqrt(warp * weft);
}

double isotropic_shear(const Fabric& fabric) { return mean_modulus(fabric) / (2.0 * (1.0 + fabric.poisson_ratio)); }

using Corners = std::array<Vec3, 3>;

double area(const Corners& x) { return 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm(); }

Corners corners_of(const ShapedMesh& rest, std::size_t t) { return rest_corners(rest.mesh, rest.shape, t); }

MembraneTriangle membrane_triangle(const ShapedMesh& rest, std::size_t t, const Eigen::Matrix3d& law) {
    const Corners x = corners_of(rest, t);
    MembraneTriangle triangle{
        .vertex = rest.mesh.triangles[t], .stiffness = triangle_stiffness(corners_in_plane(rest, t), law), .rest_square = {}};
    for (int e = 0; e < 3; ++e) triangle.rest_square[e] = (x[(e + 1) % 3] - x[(e + 2) % 3]).squaredNorm();
    return triangle;
}

/// The index of the edge between two vertices among mesh_edges.
std::size_t edge_between(const std::vector<MeshEdge>& edges, int a, int b) {
    const std::array<int, 2> key = {std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(edges.begin(), edges.end(), key,
                                        [](const MeshEdge& e, const std::array<int, 2>& k) { return e.vertex < k; });
    return static_cast<std::size_t>(found - edges.begin());
}

/// Stiffness of every edge, in N/m, when it alone becomes longer.
struct EdgeStiffness {
    std::vector<double> triangle_springs, van_gelder;
};

EdgeStiffness edge_stiffness(const ShapedMesh& rest, const std::vector<MeshEdge>& edges, const Fabric& fabric) {
    EdgeStiffness result{std::vector<double>(edges.size(), 0.0), std::vector<double>(edges.size(), 0.0)};
    const Eigen::Matrix3d law = stress_law(fabric);
    for (std::size_t number = 0; number < rest.mesh.triangles.size(); ++number) {
        const Triangle& t = rest.mesh.triangles[number];
        const MembraneTriangle triangle = membrane_triangle(rest, number, law);
        for (int e = 0; e < 3; ++e) {
            const std::size_t edge = edge_between(edges, t[(e + 1) % 3], t[(e + 2) % 3]);
            result.triangle_springs[edge] += 4.0 * triangle.rest_square[e] * triangle.stiffness(e, e);
            result.van_gelder[edge] += mean_modulus(fabric) * area(corners_of(rest, number)) / triangle.rest_square[e];
        }
    }
    return result;
}

void check_frame(const ShapedMesh& rest, const Fabric& fabric, const std::string& name) {
    if (rest.mesh.is_grid() || rest.shape.warp != Vec3::Zero() || is_isotropic(fabric)) return;
    throw SceneError(
        name, "warp and weft differ, or shear_stiffness is not that of isotropic cloth (" +
                  std::to_string(isotropic_shear(fabric)) +
                  " N/m), but a free mesh does not say where warp is unless its rest shape does; give two equal numbers and that "
                  "shear_stiffness or none");
}

SpringKind kind_of(const TriangleMesh& mesh, const MeshEdge& edge) {
    const int apart = edge.vertex[1] - edge.vertex[0];
    const bool diagonal = mesh.is_grid() && apart != 1 && apart != mesh.grid_columns;
    return diagonal ? SpringKind::shear : SpringKind::structural;
}

}  // namespace

Eigen::Matrix3d stress_law(const Fabric& fabric) {
    const auto [warp, weft] = *fabric.stretch_stiffness;
    const double nu = fabric.poisson_ratio, scale = 1.0 / (1.0 - nu * nu), across = scale * nu * mean_modulus(fabric);
    Eigen::Matrix3d law;
    law << scale * warp, across, 0.0,  //
        across, scale * weft, 0.0,     //
        0.0, 0.0, fabric.shear_stiffness.value_or(isotropic_shear(fabric));
    return law;
}

bool is_isotropic(const Fabric& fabric) {
    const auto [warp, weft] = *fabric.stretch_stiffness;
    const double shear = isotropic_shear(fabric);
    return warp == weft && std::abs(fabric.shear_stiffness.value_or(shear) - shear) <= isotropic_shear_error * shear;
}

Eigen::Matrix3d triangle_stiffness(const std::array<Eigen::Vector2d, 3>& corner, const Eigen::Matrix3d& law) {
    Eigen::Matrix3d squares_by_strain;  // s = B (E_xx, E_yy, 2 E_xy), from s_e = 2 D_e.E D_e with the rest edge D_e
    for (int e = 0; e < 3; ++e) {
        const Eigen::Vector2d d = corner[(e + 2) % 3] - corner[(e + 1) % 3];
        squares_by_strain.row(e) << 2.0 * d.x() * d.x(), 2.0 * d.y() * d.y(), 2.0 * d.x() * d.y();
    }
    const Eigen::Vector2d a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double triangle_area = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    const Eigen::Matrix3d strain = squares_by_strain.inverse();
    const Eigen::Matrix3d stiffness = triangle_area * strain.transpose() * law * strain;
    return 0.5 * (stiffness + stiffness.transpose());
}

void append_membrane(SpringNetwork& network, std::vector<MembraneTriangle>& triangles, const ShapedMesh& rest,
                     const Fabric& fabric, int first_vertex, const std::string& name) {
    const auto& [mesh, shape] = rest;
    check_frame(rest, fabric, name);
    const std::vector<MeshEdge> edges = mesh_edges(mesh.triangles);
    const std::vector<RestEdge> lengths =
        shape.corners.empty() ? std::vector<RestEdge>() : rest_edges(mesh.triangles, edges, shape.corners);
    const EdgeStiffness stiffness = edge_stiffness(rest, edges, fabric);
    const bool plain = fabric.membrane == Membrane::van_gelder;
    const std::vector<double>& own = plain ? stiffness.van_gelder : stiffness.triangle_springs;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const auto [a, b] = edges[k].vertex;
        network.first.push_back(first_vertex + a);
        network.second.push_back(first_vertex + b);
        network.rest_length.push_back(lengths.empty() ? (mesh.vertices[a] - mesh.vertices[b]).norm() : lengths[k].length);
        network.stiffness.push_back(plain ? own[k] : 0.0);
        network.damping.push_back(fabric.damping_time ? *fabric.damping_time * own[k] : fabric.spring_damping);
        network.kind.push_back(kind_of(mesh, edges[k]));
    }
    if (plain) return;
    const Eigen::Matrix3d law = stress_law(fabric);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        triangles.push_back(membrane_triangle(rest, t, law));
        for (int& vertex : triangles.back().vertex) vertex += first_vertex;
    }
}

}  // namespace percale
