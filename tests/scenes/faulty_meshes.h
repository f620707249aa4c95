#pragma once

#include <utility>

#include "percale/mesh.h"

// Meshes with one fault each, and the pieces to make them.
namespace percale::scenes::test {

inline TriangleMesh turned(TriangleMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

inline TriangleMesh shifted(TriangleMesh mesh, const Vec3& way) {
    for (Vec3& x : mesh.vertices) x += way;
    return mesh;
}

inline TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (Vec3& x : mesh.vertices) x *= factor;
    return mesh;
}

inline TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return mesh;
}

/// Every triangle with vertices of its own.
inline TriangleMesh split_corners(const TriangleMesh& mesh) {
    TriangleMesh split;
    for (const Triangle& t : mesh.triangles) {
        const int first = static_cast<int>(split.vertices.size());
        for (const int v : t) split.vertices.push_back(mesh.vertices[v]);
        split.triangles.push_back({first, first + 1, first + 2});
    }
    return split;
}

/// A free sheet, 0.6 m wide, edges of 0.1 m.
inline TriangleMesh free_sheet() {
    TriangleMesh sheet = make_grid(0.6, 0.6, 7, 7);
    sheet.grid_columns = sheet.grid_rows = 0;
    return sheet;
}

/// The sheet with a third triangle on the diagonal of its first cell.
inline TriangleMesh crowded_sheet() {
    TriangleMesh sheet = free_sheet();
    sheet.vertices.push_back(sheet.vertices[0] + Vec3(0, 0.1, 0));
    sheet.triangles.push_back({0, 8, static_cast<int>(sheet.vertices.size()) - 1});
    return sheet;
}

/// Two sheets that cross in the middle.
inline TriangleMesh crossed_sheets() {
    TriangleMesh upright = free_sheet();
    for (Vec3& x : upright.vertices) x = Vec3(x.x() + 0.013, x.z() + 0.017, 0.021);
    return both(free_sheet(), upright);
}

}  // namespace percale::scenes::test
