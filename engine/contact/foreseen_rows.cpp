#include "foreseen_rows.h"

namespace percale {
namespace {

/// The distance at which a row begins to push; below half the thickness its force is no longer linear.
double reach_of(const ContactRows& rows, std::size_t row, const RowForce& force) {
    const bool linear = rows.distance[row] >= 0.5 * rows.thickness[row];
    return linear ? rows.distance[row] + force.normal / force.stiffness : rows.thickness[row];
}

}  // namespace

void ForeseenRows::add_to(const AlignedVector<double>& free, Vectors& right_side) const {
    const std::size_t first = blocks.size() - impulses.size();
    for (std::size_t i = 0; i < impulses.size(); ++i) {
        const CoupledBlock& block = blocks[first + i];
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            right_side.add(block.vertex[k], free[block.vertex[k]] * block.weight[k] * impulses[i]);
        }
    }
}

double foresee_rows(const std::vector<CoupledBlock>& blocks_at_start, const RowMove& move, ForeseenRows& found) {
    const ContactRows& rows = move.rows;
    const double h = move.h, weighted = move.weight * h;
    found.blocks = blocks_at_start;
    found.impulses.clear();
    double slope = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const RowForce& force = move.row_forces[row];
        if (!(force.normal > 0.0)) continue;
        const Vec3& n = rows.direction[row];
        CoupledBlock block{.vertex = rows.vertex[row], .weight = rows.weight[row], .k = {}};
        double distance = -n.dot(rows.obstacle_point[row]), opening = 0.0;
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            distance += block.weight[k] * n.dot(move.start.at(block.vertex[k]));
            opening += block.weight[k] * n.dot(move.direction.at(block.vertex[k]));
        }
        const double apart = distance - reach_of(rows, row, force);
        if (apart < 0.0) continue;
        slope -= weighted * force.normal * opening;
        add_normal_block(block.k, weighted * h * force.stiffness, n);
        found.blocks.push_back(block);
        found.impulses.push_back(-weighted * force.stiffness * apart * n);
    }
    return slope;
}

}  // namespace percale
