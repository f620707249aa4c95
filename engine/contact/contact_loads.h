#pragma once

#include <algorithm>
#include <vector>

#include "contact_law.h"
#include "percale/contact_load.h"

namespace percale {

/// What one row, or one touch, does to a vertex on behalf of an obstacle, N.
struct Push {
    int vertex = -1, obstacle = -1;
    Vec3 normal = Vec3::Zero(), friction = Vec3::Zero();
    double press = 0.0;           // N, the size of `normal`
    const Vec3* where = nullptr;  // m, on the obstacle; null where nothing presses
};

/// Calls visit(push) for every row of an obstacle that pushes, vertex by vertex, and for every touch: friction of projection is
/// in the rows, that of penalty in the touches.
template <class Visit>
void for_each_push(const ContactRows& rows, const ContactTerms& terms, const std::vector<RowForce>& row_forces, Visit visit) {
    for (std::size_t row = 0; row < std::min(rows.size(), row_forces.size()); ++row) {
        const RowForce& force = row_forces[row];
        if (rows.obstacle[row] < 0 || force.normal == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const double weight = rows.weight[row][k];
            if (weight == 0.0) continue;
            visit(Push{rows.vertex[row][k], rows.obstacle[row], weight * force.normal * rows.direction[row],
                       weight * force.friction, weight * force.normal, &rows.obstacle_point[row]});
        }
    }
    for (const Touch& touch : terms.touches.all) {
        if (touch.obstacle >= 0) visit(Push{touch.vertex, touch.obstacle, Vec3::Zero(), friction_force(touch)});
    }
}

/// What obstacles do to vertices by the rows and forces of one evaluation, sorted by vertex and obstacle; vertices that no active
/// row presses are left out, and so are rows between cloths. Where the vertices are (cloth_point) is left to the caller.
/// `only`: of one obstacle; -1: of all.
std::vector<ContactLoad> contact_loads(const ContactRows& rows, const ContactTerms& terms,
                                       const std::vector<RowForce>& row_forces, int only = -1);

}  // namespace percale
