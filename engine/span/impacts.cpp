#include "impacts.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace percale {
namespace {

/// The nearest row first. A row changes what the next ones see, and the order in which they were found depends on the axes.
void set_order_of_distance(const ContactRows& rows, std::vector<std::size_t>& order) {
    order.resize(rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(rows.distance[a], rows.vertex[a], rows.feature[a]) <
               std::tie(rows.distance[b], rows.vertex[b], rows.feature[b]);
    });
}

/// What a row's vertices do by their weights, against the obstacle.
struct RowMotion {
    Vec3 velocity, mean;    // m/s, at the end of the stage and in its mean
    double mobility = 0.0;  // 1/kg
};

RowMotion row_motion(const StepScene& scene, const StageMove& move, const ClothState& end, std::size_t row) {
    const ContactRows& rows = move.contacts.rows;
    RowMotion motion;
    motion.velocity = motion.mean = -rows.obstacle_displacement[row] / scene.settings.time_step;
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        const int vertex = rows.vertex[row][k];
        const double weight = rows.weight[row][k];
        motion.velocity += weight * end.velocities.at(vertex);
        motion.mean += weight / move.length * (end.positions.at(vertex) - move.start.at(vertex));
        motion.mobility += scene.script.free[vertex] * weight * weight / scene.model.mass[vertex];
    }
    return motion;
}

}  // namespace

void settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, std::vector<std::size_t>& order) {
    const ContactRows& rows = move.contacts.rows;
    set_order_of_distance(rows, order);
    for (const std::size_t row : order) {
        if (rows.distance[row] >= rows.thickness[row]) continue;
        const RowMotion motion = row_motion(scene, move, end, row);
        const Vec3& n = rows.direction[row];
        const double excess = n.dot(motion.velocity) - std::max(n.dot(motion.mean), 0.0);
        if (excess <= 0.0 || motion.mobility == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const int vertex = rows.vertex[row][k];
            const double part = scene.script.free[vertex] * rows.weight[row][k] / (scene.model.mass[vertex] * motion.mobility);
            end.velocities.add(vertex, -rows.share[row] * part * excess * n);
        }
    }
}

}  // namespace percale
