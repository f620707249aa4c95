#include "percale/strain.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "percale/error.h"
#include "rest_edges.h"

namespace percale {
namespace {

using Gradient = Eigen::Matrix<double, 3, 2>;

/// F = [x1 - x0, x2 - x0] [X1 - X0, X2 - X0]^-1.
Gradient deformation_gradient(const std::array<Eigen::Vector2d, 3>& rest, const std::array<Vec3, 3>& now) {
    Eigen::Matrix2d edges;
    edges << rest[1] - rest[0], rest[2] - rest[0];
    Gradient moved;
    moved << now[1] - now[0], now[2] - now[0];
    return moved * edges.inverse();
}

TriangleStrain along_axes(const Gradient& f) {
    const double warp = f.col(0).norm(), weft = f.col(1).norm();
    if (!(warp * weft > 0.0)) return {warp - 1.0, weft - 1.0, 0.0};  // no length, no angle
    const double cosine = std::clamp(f.col(0).dot(f.col(1)) / (warp * weft), -1.0, 1.0);
    return {warp - 1.0, weft - 1.0, std::asin(cosine)};
}

/// Roots of the eigenvalues of F^T F.
TriangleStrain principal(const Gradient& f) {
    const Eigen::Matrix2d c = f.transpose() * f;
    const double middle = 0.5 * c.trace(), radius = std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
    return {std::sqrt(middle + radius) - 1.0, std::sqrt(std::max(0.0, middle - radius)) - 1.0, 0.0};
}

}  // namespace

std::vector<TriangleStrain> triangle_strains(const TriangleMesh& mesh, const RestShape& rest, std::span<const Vec3> positions) {
    if (positions.size() != mesh.vertices.size()) {
        throw SceneError("triangle_strains: " + std::to_string(positions.size()) + " positions for " +
                         std::to_string(mesh.vertices.size()) + " vertices");
    }
    const bool has_axes = mesh.is_grid() || rest.warp != Vec3::Zero();
    std::vector<TriangleStrain> strains;
    strains.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        const Gradient f = deformation_gradient(corners_in_plane({mesh, rest}, t), {positions[a], positions[b], positions[c]});
        strains.push_back(has_axes ? along_axes(f) : principal(f));
    }
    return strains;
}

}  // namespace percale
