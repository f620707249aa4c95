#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "percale/error.h"
#include "percale/mesh.h"

namespace percale {
namespace {

void require(bool good, const std::string& what) {
    if (!good) throw SceneError(what);
}

bool is_length(double value) { return std::isfinite(value) && value > 0.0; }

TriangleMesh icosahedron() {
    const double g = std::numbers::phi;
    TriangleMesh mesh;
    for (const double s : {-1.0, 1.0}) {
        for (const double t : {-g, g}) {
            mesh.vertices.insert(mesh.vertices.end(), {Vec3(0, s, t), Vec3(s, t, 0), Vec3(t, 0, s)});
        }
    }
    // Faces are the vertex triples at mutual distance 2, wound outwards.
    const int count = static_cast<int>(mesh.vertices.size());
    const auto adjacent = [&](int i, int j) { return (mesh.vertices[i] - mesh.vertices[j]).norm() < 2.1; };
    for (int i = 0; i < count; ++i) {
        for (int j = i + 1; j < count; ++j) {
            for (int k = j + 1; k < count; ++k) {
                if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(k, i)) continue;
                const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
                const bool outward = (b - a).cross(c - a).dot(a) > 0.0;
                mesh.triangles.push_back(outward ? Triangle{i, j, k} : Triangle{i, k, j});
            }
        }
    }
    return mesh;
}

/// Every triangle split into four at its edge midpoints.
void split_triangles(TriangleMesh& mesh) {
    std::map<std::pair<int, int>, int> midpoint_of;
    const auto midpoint = [&](int i, int j) {
        const auto [entry, added] = midpoint_of.try_emplace(std::minmax(i, j), static_cast<int>(mesh.vertices.size()));
        if (added) mesh.vertices.push_back(0.5 * (mesh.vertices[i] + mesh.vertices[j]));
        return entry->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
        finer.insert(finer.end(), {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
}

/// Closed surface of revolution about y: rings from bottom to top of (radius, height), and a pole beyond each end.
TriangleMesh revolve(const std::vector<std::pair<double, double>>& rings, double lowest, double highest, int segments) {
    TriangleMesh mesh;
    for (const auto& [radius, height] : rings) {
        for (int s = 0; s < segments; ++s) {
            const double angle = 2.0 * std::numbers::pi * s / segments;
            mesh.vertices.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
        }
    }
    const int bottom = static_cast<int>(mesh.vertices.size()), top = bottom + 1;
    mesh.vertices.emplace_back(0.0, lowest, 0.0);
    mesh.vertices.emplace_back(0.0, highest, 0.0);
    const int last = static_cast<int>(rings.size()) - 1;
    for (int s = 0; s < segments; ++s) {
        const int next = (s + 1) % segments;
        mesh.triangles.push_back({bottom, s, next});
        for (int r = 0; r < last; ++r) {
            const int a = r * segments + s, b = r * segments + next, c = a + segments, d = b + segments;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
        mesh.triangles.push_back({last * segments + s, top, last * segments + next});
    }
    return mesh;
}

}  // namespace

TriangleMesh make_grid(double width, double depth, int columns, int rows) {
    require(is_length(width) && is_length(depth), "make_grid: width and depth must be positive lengths in m, got " +
                                                      std::to_string(width) + " and " + std::to_string(depth));
    require(columns >= 2 && rows >= 2,
            "make_grid: at least 2 vertices each way, got " + std::to_string(columns) + " x " + std::to_string(rows));
    const int max = std::numeric_limits<int>::max() / 2;  // there are two triangles a cell
    require(columns <= max / rows, "make_grid: " + std::to_string(columns) + " x " + std::to_string(rows) +
                                       " vertices are more than the " + std::to_string(max) + " that there may be");
    TriangleMesh mesh;
    mesh.grid_columns = columns;
    mesh.grid_rows = rows;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            mesh.vertices.emplace_back(-width / 2 + c * width / (columns - 1), 0.0, -depth / 2 + r * depth / (rows - 1));
        }
    }
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c + 1 < columns; ++c) {
            const int a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
            const bool main_diagonal = (c + r) % 2 == 0;
            mesh.triangles.push_back(main_diagonal ? Triangle{a, e, b} : Triangle{a, d, b});
            mesh.triangles.push_back(main_diagonal ? Triangle{a, d, e} : Triangle{b, d, e});
        }
    }
    return mesh;
}

TriangleMesh make_sphere(double radius, int level) {
    require(is_length(radius), "make_sphere: radius must be a positive length in m, got " + std::to_string(radius));
    require(level >= 0 && level <= 8, "make_sphere: level must be 0 ... 8, got " + std::to_string(level));
    TriangleMesh mesh = icosahedron();
    for (int i = 0; i < level; ++i) {
        split_triangles(mesh);
        for (Vec3& x : mesh.vertices) x.normalize();
    }
    for (Vec3& x : mesh.vertices) x *= radius / x.norm();
    return mesh;
}

TriangleMesh make_box(const Vec3& size) {
    require(is_length(size.x()) && is_length(size.y()) && is_length(size.z()),
            "make_box: edge lengths must be positive, in m, got " + std::to_string(size.x()) + ", " + std::to_string(size.y()) +
                " and " + std::to_string(size.z()));
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5, (corner & 4) ? 0.5 : -0.5);
        mesh.vertices.push_back(sign.cwiseProduct(size));
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

TriangleMesh make_cylinder(double radius, double height, int segments) {
    require(is_length(radius) && is_length(height), "make_cylinder: radius and height must be positive lengths in m, got " +
                                                        std::to_string(radius) + " and " + std::to_string(height));
    require(segments >= 3, "make_cylinder: at least 3 segments, got " + std::to_string(segments));
    return revolve({{radius, -height / 2}, {radius, height / 2}}, -height / 2, height / 2, segments);
}

TriangleMesh make_capsule(double radius, double height, int segments) {
    require(is_length(radius) && std::isfinite(height) && height >= 0.0,
            "make_capsule: radius must be a positive length and height not negative, in m, got " + std::to_string(radius) +
                " and " + std::to_string(height));
    require(segments >= 4 && segments % 4 == 0,
            "make_capsule: segments must be a multiple of 4, at least 4, got " + std::to_string(segments));
    const int quarter = segments / 4;
    std::vector<std::pair<double, double>> rings;
    const auto ring = [&](int i, double centre) {
        const double angle = 0.5 * std::numbers::pi * i / quarter;
        rings.emplace_back(radius * std::cos(angle), centre + radius * std::sin(angle));
    };
    for (int i = 1 - quarter; i <= 0; ++i) ring(i, -height / 2);
    for (int i = height > 0.0 ? 0 : 1; i < quarter; ++i) ring(i, height / 2);
    return revolve(rings, -height / 2 - radius, height / 2 + radius, segments);
}

TriangleMesh make_plane(double half_size) {
    require(is_length(half_size), "make_plane: half_size must be a positive length in m, got " + std::to_string(half_size));
    TriangleMesh mesh;
    mesh.vertices = {Vec3(-half_size, 0, -half_size), Vec3(half_size, 0, -half_size), Vec3(-half_size, 0, half_size),
                     Vec3(half_size, 0, half_size)};
    mesh.triangles = {{0, 3, 1}, {0, 2, 3}};
    return mesh;
}

}  // namespace percale
