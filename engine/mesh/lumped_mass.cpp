#include "lumped_mass.h"

namespace percale {
namespace {

double area(const TriangleMesh& mesh, int a, int b, int c) {
    return 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
}

}  // namespace

std::vector<double> lumped_masses(const TriangleMesh& rest, double area_density) {
    std::vector<double> masses(rest.vertices.size(), 0.0);
    if (!rest.is_grid()) {
        for (const auto& [a, b, c] : rest.triangles) {
            const double share = area_density * area(rest, a, b, c) / 3.0;
            for (const int vertex : {a, b, c}) masses[vertex] += share;
        }
        return masses;
    }
    for (int r = 0; r + 1 < rest.grid_rows; ++r) {
        for (int c = 0; c + 1 < rest.grid_columns; ++c) {
            const int i = r * rest.grid_columns + c, right = i + 1, below = i + rest.grid_columns, across = below + 1;
            const double share = area_density * (area(rest, i, below, across) + area(rest, i, across, right)) / 4.0;
            for (const int vertex : {i, right, below, across}) masses[vertex] += share;
        }
    }
    return masses;
}

}  // namespace percale
