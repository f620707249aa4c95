#include "contact_law.h"

namespace percale {

Vec3 relative_move(const ContactMove& move, std::size_t constraint) {
    Vec3 sum = -move.dt * move.obstacle_rate * move.constraints.obstacle_displacement[constraint];
    for (int k = 0; k < 4 && move.constraints.vertex[constraint][k] >= 0; ++k) {
        const int vertex = move.constraints.vertex[constraint][k];
        sum += move.constraints.weight[constraint][k] * (move.end.at(vertex) - move.start.at(vertex));
    }
    return sum;
}

void add_obstacle_advance(const ContactConstraints& constraints, const ContactTerms& terms, double rate,
                          const AlignedVector<double>& free, Vec3Arrays& right_side) {
    for (const CoupledBlock& block : terms.blocks) {
        if (block.constraint < 0) continue;
        const Vec3& n = constraints.direction[block.constraint];
        const Vec3 impulse = quadratic_form(block.k, n) * rate * n.dot(constraints.obstacle_displacement[block.constraint]) * n;
        for (int j = 0; j < 4 && block.vertex[j] >= 0; ++j) {
            right_side.add(block.vertex[j], free[block.vertex[j]] * block.weight[j] * impulse);
        }
    }
}

}  // namespace percale
