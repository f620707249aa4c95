#include "projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tolerances.h"

namespace percale {
namespace {

constexpr RowClearance leaving{.zone = projection_zone, .share = contact_accuracy};

/// One row at one point of the search.
struct RowState {
    Vec3 normal;
    double stiffness = 0.0;   // k, N/m
    ContactPotential spring;  // beside the multiplier: pulls beyond the target distance
    double approach = 0.0;    // m, how much nearer than its target the row is
    Vec3 slip;                // m/s
    double friction = 0.0;    // mu
    double share = 1.0;       // of all it does
};

/// What a row is told beside the point.
struct RowPast {
    double least_distance = 0.0;       // ContactMemory::least_distance
    double multiplier = 0.0;           // N, of its push
    const std::vector<double>& crowd;  // ProjectedContact::crowd_
};

/// k = share/(dt^2 W), W = sum c w^2/(n.A n) over the row's vertices: n.A^-1 n if these had no neighbours, and c rows shared
/// what a vertex can bear. Without c a dozen rows of finely meshed obstacles make it a dozen times as stiff as its cloth.
double row_stiffness(const ContactRows& rows, std::size_t row, const ContactStep& step, const std::vector<double>& crowd) {
    double yielding = 0.0;
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        const double weight = rows.weight[row][k];
        const std::size_t vertex = rows.vertex[row][k];
        const double sharing = vertex < crowd.size() ? std::max(1.0, crowd[vertex]) : 1.0;
        yielding += sharing * weight * weight / quadratic_form(step.diagonal->block(rows.vertex[row][k]), rows.direction[row]);
    }
    return projection_stiffness_share / (step.dt * step.dt * yielding);
}

/// The distance a row has to keep: the thickness; if it began nearer, only part of what is missing, as pushing it out at once
/// would throw the cloth off. Where the row began follows from its velocity, but it was nowhere nearer than `kept`.
double target_distance(double thickness, double kept, double began, double dt) {
    const double start = std::clamp(began, std::min(kept, thickness), thickness);
    return thickness - (thickness - start) * std::exp(-dt / thickness_recovery_time);
}

/// Where a row has to be, m.
struct RowRange {
    double distance = 0.0, target = 0.0, zone = 0.0;
};

/// What acts beside the multiplier: k (target - d), but logarithmic below half of the target, as a motion that only multipliers
/// can stop must not reach d = 0 first, and beyond the target so steep that the row's force ends before the zone does.
ContactPotential row_spring(const RowRange& range, double multiplier, double stiffness) {
    if (range.distance < range.target) return contact_potential(range.distance, range.target, stiffness);
    const double depth = range.target - range.distance;
    const double steep = std::max(stiffness, multiplier / (multiplier_zone_share * (range.zone - range.target)));
    return {0.5 * steep * depth * depth, steep * depth, steep};
}

RowState row_state(const ContactPoint& point, std::size_t row, const RowPast& past) {
    const ContactRows& rows = point.rows;
    Vec3 velocity = Vec3::Zero();
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        velocity += rows.weight[row][k] * point.velocities.at(rows.vertex[row][k]);
    }
    const Vec3 &n = rows.direction[row], &displacement = rows.obstacle_displacement[row];
    const double thickness = rows.thickness[row] / projection_zone;
    const double began = rows.distance[row] - n.dot(point.step.dt * velocity - point.obstacles_moved * displacement);
    const double target = target_distance(thickness, past.least_distance * thickness, began, point.step.dt);
    const double stiffness = row_stiffness(rows, row, point.step, past.crowd);
    return {.normal = n,
            .stiffness = stiffness,
            .spring = row_spring({rows.distance[row], target, rows.thickness[row]}, past.multiplier, stiffness),
            .approach = target - rows.distance[row],
            .slip = tangential(velocity - point.step.obstacle_rate * displacement, n),
            .friction = rows.friction[row],
            .share = rows.share[row]};
}

/// The row's force, N, its matrix, kg, added to the block; no matrix if it does not push.
RowForce row_force(const RowState& row, const RowForce& multiplier, double dt, SymmetricBlock& block) {
    RowForce force{.normal = row.share * std::max(0.0, multiplier.normal + row.spring.slope), .stiffness = row.stiffness};
    if (force.normal == 0.0) return force;
    const double damping = row.share * row.stiffness * dt, limit = row.friction * force.normal;
    const Vec3 trial = row.share * tangential(multiplier.friction, row.normal) - damping * row.slip;
    const double size = trial.norm();
    const bool slides = size > limit;
    const double kept = slides ? limit / size : 1.0;
    force.friction = kept * trial;
    const Vec3 along = slides ? Vec3(trial / size) : Vec3(Vec3::Zero());
    const double normal_part = row.share * dt * dt * row.spring.curvature,
                 slip_part = row.friction > 0.0 ? dt * damping * kept : 0.0;
    add_normal_block(block, normal_part, row.normal);
    add_tangent_block(block, slip_part, row.normal, along);
    return force;
}

/// Its derivative by the distance is -force; the multiplier's part is what it does from the target on.
double row_energy(const RowState& row, double multiplier, double force) {
    if (force == 0.0) return -0.5 * row.share * multiplier * multiplier / row.spring.curvature;
    return row.share * (multiplier * row.approach + row.spring.energy);
}

Vec3 total(const ContactRows& rows, std::size_t row, const RowForce& force) {
    return force.normal * rows.direction[row] + force.friction;
}

void take(const ContactRows& rows, const std::vector<RowForce>& forces, ContactMultipliers& multipliers) {
    multipliers.clear(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (forces[row].normal > 0.0) multipliers.add(row_key(rows, row), forces[row]);
    }
}

}  // namespace

double ProjectedContact::zone() const { return projection_zone; }

void ProjectedContact::begin(const ContactMemory& memory) {
    multipliers_ = memory.lasting;
    least_distance_ = memory.least_distance;
}

void ProjectedContact::evaluate(const ContactPoint& point, ContactForces forces) const {
    const ContactRows& rows = point.rows;
    ContactTerms& terms = forces.terms;
    terms.clear();
    forces.row_forces.clear();
    for (std::size_t row = 0; row < rows.size(); ++row) {
        CoupledBlock block{.vertex = rows.vertex[row], .weight = rows.weight[row], .k = {}, .row = static_cast<int>(row)};
        const RowForce multiplier = multipliers_.of(row_key(rows, row));
        const RowState state = row_state(point, row, {least_distance_, multiplier.normal, crowd_});
        const RowForce& force = forces.row_forces.emplace_back(row_force(state, multiplier, point.step.dt, block.k));
        terms.energy += row_energy(state, multiplier.normal, force.normal);
        if (force.normal == 0.0) continue;
        const Vec3 whole = total(rows, row, force);
        spread(rows, row, whole, forces.total);
        terms.blocks.push_back(block);
        terms.largest_stiffness = std::max(terms.largest_stiffness, state.stiffness);
        terms.obstacle_power += whole.dot(rows.obstacle_displacement[row]) * point.step.obstacle_rate;
    }
}

void ProjectedContact::meet(const ContactRows& rows) {
    multipliers_.hand_over(rows, leaving);
    std::fill(crowd_.begin(), crowd_.end(), 0.0);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const bool near = rows.distance[row] * projection_zone < rows.thickness[row];
        if (!near && multipliers_.of(row_key(rows, row)).normal == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const std::size_t vertex = rows.vertex[row][k];
            if (vertex >= crowd_.size()) crowd_.resize(vertex + 1, 0.0);
            crowd_[vertex] += rows.share[row] * std::abs(rows.weight[row][k]);
        }
    }
}

double ProjectedContact::mismatch(const ContactRows& rows, const std::vector<RowForce>& forces) const {
    double largest = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const RowForce before = multipliers_.of(row_key(rows, row));
        const double change = std::hypot(forces[row].normal - before.normal, (forces[row].friction - before.friction).norm());
        if (change > 0.0) largest = std::max(largest, change / forces[row].stiffness);
    }
    return largest;
}

bool ProjectedContact::correct(const ContactPoint& point, ContactForces forces, double enough) {
    const ContactRows& rows = point.rows;
    if (mismatch(rows, forces.row_forces) <= enough) return false;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        spread(rows, row, -total(rows, row, forces.row_forces[row]), forces.total);
    }
    take(rows, forces.row_forces, multipliers_);
    evaluate(point, forces);
    return true;
}

void ProjectedContact::end(const ContactRows& rows, const ContactTerms&, const std::vector<RowForce>& row_forces,
                           ContactMemory& memory) {
    memory.last.hand_over(rows, leaving);  // what lasted may have gone on during the span
    std::vector<RowForce>& lasting = lasting_forces_;
    lasting = row_forces;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const double before = memory.last.of(row_key(rows, row)).normal;
        if (lasting[row].normal <= before) continue;
        lasting[row].friction *= before / lasting[row].normal;
        lasting[row].normal = before;
    }
    take(rows, lasting, memory.lasting);
    take(rows, row_forces, memory.last);
    memory.least_distance = 1.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        memory.least_distance = std::min(memory.least_distance, rows.distance[row] * projection_zone / rows.thickness[row]);
    }
}

ContactLoss ProjectedContact::loss(const ContactMove& move, double stored) const {
    ContactLoss loss;
    for (std::size_t row = 0; row < move.rows.size(); ++row) {
        const RowForce& force = move.row_forces[row];
        const Vec3 moved = relative_move(move, row);
        loss.contact -= force.normal * move.rows.direction[row].dot(moved);
        loss.friction -= force.friction.dot(moved);
    }
    loss.contact += stored - move.terms.energy;
    return loss;
}

}  // namespace percale
