#include "vertex_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace percale {
namespace {

/// Areas of the triangles around a vertex, summed with their directions, over the products of their edges. A vertex with less
/// has no normal. Smaller: rounding counts as a normal. Larger: needles have no normal.
constexpr double min_normal_ratio = 1e-12;

}  // namespace

void vertex_normals(const NormalMesh& mesh, std::span<Vec3> normals) {
    std::ranges::fill(normals, Vec3::Zero());
    std::vector<double> scale(normals.size(), 0.0);  // m^2
    for (const Triangle& t : mesh.triangles) {
        const Vec3 b = mesh.points[t[1]] - mesh.points[t[0]], c = mesh.points[t[2]] - mesh.points[t[0]];
        const Vec3 twice_area = b.cross(c);
        const double edges = b.norm() * c.norm();
        for (const int vertex : t) {
            const int at = mesh.order.vertex_at(vertex - mesh.first_vertex);
            normals[at] += twice_area;
            scale[at] += edges;
        }
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double size = normals[i].norm();
        normals[i] = size > min_normal_ratio * scale[i] ? Vec3(normals[i] / size) : Vec3(Vec3::Zero());
    }
}

}  // namespace percale
