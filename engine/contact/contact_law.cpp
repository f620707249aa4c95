#include "contact_law.h"

namespace percale {

Vec3 relative_move(const ContactMove& move, std::size_t row) {
    Vec3 sum = -move.dt * move.obstacle_rate * move.rows.obstacle_displacement[row];
    for (int k = 0; k < 4 && move.rows.vertex[row][k] >= 0; ++k) {
        const int vertex = move.rows.vertex[row][k];
        sum += move.rows.weight[row][k] * (move.end.at(vertex) - move.start.at(vertex));
    }
    return sum;
}

void add_obstacle_advance(const ContactRows& rows, const ContactTerms& terms, double rate, const AlignedVector<double>& free,
                          Vectors& right_side) {
    for (const CoupledBlock& block : terms.blocks) {
        if (block.row < 0) continue;
        const Vec3& n = rows.direction[block.row];
        const Vec3 impulse = quadratic_form(block.k, n) * rate * n.dot(rows.obstacle_displacement[block.row]) * n;
        for (int j = 0; j < 4 && block.vertex[j] >= 0; ++j) {
            right_side.add(block.vertex[j], free[block.vertex[j]] * block.weight[j] * impulse);
        }
    }
}

}  // namespace percale
