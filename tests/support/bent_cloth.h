#pragma once

#include <cmath>
#include <numbers>

#include "engine/forces/hinge_bending.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {

inline constexpr double bend_stiffness = 1e-3;  // N m

inline ClothModel bending_model(const TriangleMesh& mesh, double stiffness = bend_stiffness) {
    ClothModel model;
    append_cloth(model, mesh, mesh.is_grid() ? sheet_fabric() : free_fabric(), "cloth");
    order_last_cloth(model);
    append_hinges_of_last_cloth(model, stiffness);
    finish_model(model);
    return model;
}

/// Equilateral triangles of side h, `columns` x `rows` vertices, in the plane y = 0.
inline TriangleMesh equilateral_sheet(double h, int columns, int rows) {
    TriangleMesh mesh;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) mesh.vertices.push_back({h * (c + 0.5 * (r % 2)), 0.0, 0.5 * std::sqrt(3.0) * h * r});
    }
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c + 1 < columns; ++c) {
            const int i = r * columns + c, above = i + columns;
            if (r % 2 == 0) {
                mesh.triangles.insert(mesh.triangles.end(), {{i, above, i + 1}, {i + 1, above, above + 1}});
            } else {
                mesh.triangles.insert(mesh.triangles.end(), {{i, above, above + 1}, {i, above + 1, i + 1}});
            }
        }
    }
    return mesh;
}

/// The sheet rolled onto a cylinder of radius 1/curvature whose axis makes `angle` with z, without stretch.
inline std::vector<Vec3> rolled(const std::vector<Vec3>& flat, double curvature, double angle) {
    const Vec3 along(std::cos(angle), 0.0, std::sin(angle)), axis(-std::sin(angle), 0.0, std::cos(angle));
    std::vector<Vec3> result;
    for (const Vec3& x : flat) {
        const double s = curvature * along.dot(x);
        result.push_back(axis.dot(x) * axis + std::sin(s) / curvature * along + (std::cos(s) - 1.0) / curvature * Vec3::UnitY());
    }
    return result;
}

inline double bending_energy(const ClothModel& model, const std::vector<Vec3>& points) {
    return hinge_energy(model.hinges, to_vec3_arrays(points));
}

}  // namespace percale::test
