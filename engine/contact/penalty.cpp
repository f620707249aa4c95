#include "penalty.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// What a_k of a row's vertices makes at the contact: the mean by weight against an obstacle; between cloths, where both sides
/// give way, 1 / sum w_k^2/a_k.
template <class Value>
double at_contact(const ContactRows& rows, std::size_t row, Value value) {
    const bool between_cloths = rows.obstacle[row] < 0;
    double sum = 0.0;
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        const double weight = rows.weight[row][k], a = value(rows.vertex[row][k]);
        sum += between_cloths ? weight * weight / a : weight * a;
    }
    return between_cloths ? 1.0 / sum : sum;
}

/// 1/dt^2 for the share of the masses: of this span where the obstacle comes or goes by a fifth of the thickness or more in the
/// step. A span may be far shorter than its step, and what contact then stored nobody would have paid for: no more than stops
/// cloth at the obstacle's speed u within a share s of the thickness h, (u/(s h))^2.
double inverse_square_dt(const ContactRows& rows, std::size_t row, const ContactStep& step) {
    const double displacement = std::abs(rows.direction[row].dot(rows.obstacle_displacement[row]));
    const double share = std::min(displacement / (moving_obstacle_share * rows.thickness[row]), 1.0);
    const double longer = std::max(step.dt, step.stiffness_dt);
    const double of_both = share / (step.dt * step.dt) + (1.0 - share) / (longer * longer);
    if (longer == step.dt) return of_both;
    const double stopping = displacement * step.obstacle_rate / (stopping_share * rows.thickness[row]);  // 1/s
    return std::min(of_both, std::max(1.0 / (longer * longer), stopping * stopping));
}

double row_stiffness(const ContactRows& rows, std::size_t row, const ContactStep& step) {
    const Vec3& n = rows.direction[row];
    const double inertia = at_contact(rows, row, [&](int vertex) { return quadratic_form(step.diagonal->block(vertex), n); });
    const double inert = std::min(inertia, at_contact(rows, row, [&](int vertex) { return (*step.mass)[vertex]; }));
    double mass = 0.0, press = 0.0, squares = 0.0;
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        const int vertex = rows.vertex[row][k];
        const double weight = rows.weight[row][k];
        mass += std::abs(weight) * (*step.mass)[vertex];
        squares += weight * weight;
        if (step.load) press -= weight * n.dot(step.load->at(vertex));
    }
    const double static_load = std::max(mass * step.gravity.norm(), press / squares);
    const double of_matrix = inert * inverse_square_dt(rows, row, step) + (inertia - inert) / (step.dt * step.dt);
    return rows.share[row] *
           std::max(penalty_stiffness_share * of_matrix, static_load_factor * static_load / rows.thickness[row]);
}

/// Gives the vertices of a row their share of what presses them to the obstacle. Normals that point apart, of the two sides of a
/// gap, press both.
void add_press(const ContactRows& rows, std::size_t row, double normal_force, const ContactStep& step, Touches& touches) {
    const std::span<const ObstacleFlow> flows = step.friction->flows;
    const bool deforms = rows.obstacle[row] < static_cast<int>(flows.size()) && flows[rows.obstacle[row]].deforms;
    const Vec3 press = rows.friction[row] * normal_force * rows.direction[row];
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        if (rows.weight[row][k] <= 0.0) continue;
        Touch& touch = touches.get(rows.vertex[row][k], rows.obstacle[row]);
        touch.press += (touch.press.dot(press) < 0.0 ? -1.0 : 1.0) * rows.weight[row][k] * press;
        touch.reach = stick_reach_share * rows.thickness[row];
        if (!deforms) continue;
        touch.load += rows.weight[row][k] * normal_force;
        touch.carried += rows.weight[row][k] * normal_force * rows.obstacle_displacement[row];
    }
}

/// Where the matrix lets a vertex slide. An active set: what was held and slipped slides, what turned back is held. At the first
/// sight of a touch it slides if it did so before or if friction at its limit cannot stop it within the step.
Vec3 heading(const Touch& touch, const ContactStep& step) {
    const double length = touch.slip.norm();
    if (length <= touch.reach) return Vec3::Zero();
    const Vec3 along = touch.slip / length;
    if (const Touch* before = step.previous ? step.previous->find(touch.vertex, touch.obstacle) : nullptr) {
        if (touch.slip == before->slip) return before->heading;  // others were moved alone
        return along.dot(before->heading) < 0.0 ? Vec3(Vec3::Zero()) : along;
    }
    const double stopping = step.dt * step.dt * touch.press.norm();
    return touch.old || length * (*step.mass)[touch.vertex] > stopping ? along : Vec3(Vec3::Zero());
}

/// Force and matrix of a touch whose press is known.
void add_friction(const ContactStep& step, const Vectors& positions, Touch& touch, Vectors& forces, ContactTerms& terms) {
    set_slip(*step.friction, positions.at(touch.vertex), step.fraction, touch);
    touch.heading = heading(touch, step);
    const double limit = touch.press.norm();
    CoupledBlock block{.vertex = {touch.vertex, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {}};
    const double stiffness = limit / std::max(touch.slip.norm(), touch.reach);
    add_tangent_block(block.k, step.dt * step.dt * stiffness, touch.press / limit, touch.heading);
    terms.blocks.push_back(block);
    const Vec3 force = friction_force(touch);
    forces.add(touch.vertex, force);
    terms.obstacle_power += force.dot(touch.flow) * step.obstacle_rate;
}

/// Whether the matrix lets a rub beyond its reach slide: at the first sight if it held before or if friction at its limit cannot
/// stop it within the step, later always.
bool slides(const ContactRows& rows, const Rub& rub, const ContactStep& step) {
    const double length = rub.slip.norm();
    if (length <= rub.reach) return false;
    if (step.previous || rub.slip != rub.moved) return true;
    const double mass = at_contact(rows, rub.row, [&](int vertex) { return (*step.mass)[vertex]; });
    return length * mass > step.dt * step.dt * rub.press;
}

/// Friction force of two cloths that a row presses together, its matrix added to the row's block.
Vec3 friction_between_cloths(const ContactRows& rows, const Rub& rub, const ContactStep& step, CoupledBlock& block) {
    const double length = rub.slip.norm(), stiffness = rub.press / std::max(length, rub.reach);
    const Vec3 heading = slides(rows, rub, step) ? Vec3(rub.slip / length) : Vec3(Vec3::Zero());
    add_tangent_block(block.k, step.dt * step.dt * stiffness, rows.direction[rub.row], heading);
    return friction_force(rub);
}

/// What a move took, and what the rows of its end, with their stiffness, would have stored at its start: their distances and the
/// stretch of their grips, moved back with the relative velocity, J.
struct PenaltyLoss {
    double friction = 0.0, integrator = 0.0, stored_at_start = 0.0;
};

/// The stiffness that a row's potential was made with, N/m: n.K n = dt^2 P'' with P'' = k, k (h/2)^2/d^2 below h/2.
double stiffness_of(const ContactMove& move, const CoupledBlock& block) {
    const double h = move.rows.thickness[block.row], d = move.rows.distance[block.row];
    const double curvature = quadratic_form(block.k, move.rows.direction[block.row]) / (move.dt * move.dt);
    return d >= 0.5 * h ? curvature : 4.0 * d * d / (h * h) * curvature;
}

void add_row_loss(const ContactMove& move, const CoupledBlock& block, PenaltyLoss& loss) {
    const std::size_t row = block.row;
    const double h = move.rows.thickness[row], d = move.rows.distance[row], k = stiffness_of(move, block);
    const double opened = move.rows.direction[row].dot(relative_move(move, row));
    const double began = std::max(d - opened, std::min(d, least_start_share * h));
    const ContactPotential end = contact_potential(d, h, k), start = contact_potential(began, h, k);
    loss.stored_at_start += start.energy;
    loss.integrator += start.energy - end.energy - end.slope * opened;
}

/// 1/2 N/r e^2 up to e = r, N (e - r/2) beyond.
double huber(double press, double reach, double stretch) {
    return stretch <= reach ? 0.5 * press / reach * stretch * stretch : press * (stretch - 0.5 * reach);
}

/// Of a touch or a rub, of which `moved` of the slip is the move's.
template <class Holding>
void add_friction_loss(const Holding& holding, double press, const Vec3& moved, PenaltyLoss& loss) {
    const double end = huber(press, holding.reach, holding.slip.norm());
    const double start = huber(press, holding.reach, (holding.slip - moved).norm());
    loss.friction += press * std::max(holding.slip.norm() - holding.reach, 0.0);
    loss.stored_at_start += start;
    loss.integrator += start - end - friction_force(holding).dot(moved);
}

void add_touch_loss(const ContactMove& move, const Touch& touch, PenaltyLoss& loss) {
    const double press = touch.press.norm();
    if (press == 0.0) return;
    const Vec3 along = move.end.at(touch.vertex) - move.start.at(touch.vertex) - move.dt * move.obstacle_rate * touch.flow;
    add_friction_loss(touch, press, tangential(along, touch.press / press), loss);
}

}  // namespace

void add_contact(const ContactRows& rows, const ContactStep& step, const Vectors& positions, Vectors& forces, ContactTerms& terms,
                 std::vector<RowForce>& row_forces) {
    terms.clear();
    row_forces.clear();
    terms.touches.clear(positions.padded_size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const double stiffness = row_stiffness(rows, row, step);
        const ContactPotential potential = contact_potential(rows.distance[row], rows.thickness[row], stiffness);
        row_forces.push_back({.normal = potential.slope, .stiffness = stiffness});
        CoupledBlock block{.vertex = rows.vertex[row], .weight = rows.weight[row], .k = {}, .row = static_cast<int>(row)};
        add_normal_block(block.k, step.dt * step.dt * potential.curvature, rows.direction[row]);
        Vec3 force = potential.slope * rows.direction[row];
        const bool rubs = step.friction && rows.friction[row] * potential.slope > 0.0, on_obstacle = rows.obstacle[row] >= 0;
        if (rubs && !on_obstacle) {
            terms.rubs.push_back(rub_of(*step.friction, rows, static_cast<int>(row), potential.slope, positions));
            force += friction_between_cloths(rows, terms.rubs.back(), step, block);
        }
        spread(rows, row, force, forces);
        terms.blocks.push_back(block);
        terms.energy += potential.energy;
        terms.largest_stiffness = std::max(terms.largest_stiffness, stiffness);
        terms.obstacle_power += force.dot(rows.obstacle_displacement[row]) * step.obstacle_rate;
        if (rubs && on_obstacle) add_press(rows, row, potential.slope, step, terms.touches);
    }
    for (Touch& touch : terms.touches.all) add_friction(step, positions, touch, forces, terms);
}

void PenaltyContact::evaluate(const ContactPoint& point, ContactForces forces) const {
    add_contact(point.rows, point.step, point.positions, forces.total, forces.terms, forces.row_forces);
    forces.potential += forces.terms.energy;
}

void PenaltyContact::end(const ContactRows& rows, const ContactTerms& terms, const std::vector<RowForce>& row_forces,
                         ContactMemory& memory) {
    set_held(rows, terms.rubs, row_forces, memory.held);
}

ContactLoss PenaltyContact::loss(const ContactMove& move, double stored) const {
    PenaltyLoss loss;
    for (const CoupledBlock& block : move.terms.blocks) {
        if (block.row >= 0) add_row_loss(move, block, loss);
    }
    for (const Touch& touch : move.terms.touches.all) add_touch_loss(move, touch, loss);
    for (const Rub& rub : move.terms.rubs) add_friction_loss(rub, rub.press, rub.moved, loss);
    return {.friction = loss.friction, .contact = stored - loss.stored_at_start, .integrator = loss.integrator};
}

}  // namespace percale
