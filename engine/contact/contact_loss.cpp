#include "contact_loss.h"

#include <algorithm>

namespace percale {
namespace {

constexpr double least_share = 1e-3;  // of the thickness: a row is not taken to have been nearer at the start

Vec3 way(const ContactMove& move, int vertex) { return move.end.at(vertex) - move.start.at(vertex); }

/// The stiffness that a row's potential was made with, N/m: n.K n = dt^2 P'' with P'' = k, k (h/2)^2/d^2 below h/2.
double row_stiffness(const ContactMove& move, const ContactBlock& block) {
    const double h = move.rows.thickness[block.row], d = move.rows.distance[block.row];
    const double curvature = quadratic_form(block.k, move.rows.direction[block.row]) / (move.dt * move.dt);
    return d >= 0.5 * h ? curvature : 4.0 * d * d / (h * h) * curvature;
}

void add_row(const ContactMove& move, const ContactBlock& block, ContactLoss& loss) {
    const std::size_t row = block.row;
    const double h = move.rows.thickness[row], d = move.rows.distance[row], k = row_stiffness(move, block);
    const double opened = move.rows.direction[row].dot(relative_move(move, row));
    const double began = std::max(d - opened, std::min(d, least_share * h));
    const ContactPotential end = contact_potential(d, h, k), start = contact_potential(began, h, k);
    loss.stored_at_start += start.energy;
    loss.integrator += start.energy - end.energy - end.slope * opened;
}

/// 1/2 N/r e^2 up to e = r, N (e - r/2) beyond.
double huber(double press, double reach, double stretch) {
    return stretch <= reach ? 0.5 * press / reach * stretch * stretch : press * (stretch - 0.5 * reach);
}

void add_touch(const ContactMove& move, const Touch& touch, ContactLoss& loss) {
    const double press = touch.press.norm();
    if (press == 0.0) return;
    const Vec3 along = way(move, touch.vertex) - move.dt * move.obstacle_rate * touch.flow;
    const Vec3 moved = tangential(along, touch.press / press);
    const double end = huber(press, touch.reach, touch.slip.norm());
    const double start = huber(press, touch.reach, (touch.slip - moved).norm());
    loss.friction += press * std::max(touch.slip.norm() - touch.reach, 0.0);
    loss.stored_at_start += start;
    loss.integrator += start - end - friction_force(touch).dot(moved);
}

}  // namespace

Vec3 relative_move(const ContactMove& move, std::size_t row) {
    Vec3 sum = -move.dt * move.obstacle_rate * move.rows.obstacle_displacement[row];
    for (int k = 0; k < 4 && move.rows.vertex[row][k] >= 0; ++k) {
        sum += move.rows.weight[row][k] * way(move, move.rows.vertex[row][k]);
    }
    return sum;
}

ContactLoss contact_loss(const ContactMove& move) {
    ContactLoss loss{.friction = move.dt * move.terms.rubbing_power};
    for (const ContactBlock& block : move.terms.blocks) {
        if (block.row >= 0) add_row(move, block, loss);
    }
    for (const Touch& touch : move.terms.touches.all) add_touch(move, touch, loss);
    return loss;
}

}  // namespace percale
