#include "lumped_mass.h"

#include "percale/strain.h"
#include "rest_edges.h"

namespace percale {
namespace {

double area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

}  // namespace

std::vector<double> lumped_masses(const TriangleMesh& rest, double area_density, const RestShape& shape) {
    std::vector<double> masses(rest.vertices.size(), 0.0);
    if (!rest.is_grid()) {
        for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
            const auto [a, b, c] = rest_corners(rest, shape, t);
            const double share = area_density * area(a, b, c) / 3.0;
            for (const int vertex : rest.triangles[t]) masses[vertex] += share;
        }
        return masses;
    }
    for (int r = 0; r + 1 < rest.grid_rows; ++r) {
        for (int c = 0; c + 1 < rest.grid_columns; ++c) {
            const int i = r * rest.grid_columns + c, right = i + 1, below = i + rest.grid_columns, across = below + 1;
            const std::vector<Vec3>& x = rest.vertices;
            const double cell = area(x[i], x[below], x[across]) + area(x[i], x[across], x[right]),
                         share = area_density * cell / 4.0;
            for (const int vertex : {i, right, below, across}) masses[vertex] += share;
        }
    }
    return masses;
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) { return lumped_masses(mesh, 1.0); }

}  // namespace percale
