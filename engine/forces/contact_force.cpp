#include "contact_force.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

constexpr double stick_speed = 1e-3;  // m/s, below it friction is a damper
constexpr double share_of_matrix =
    0.5;  // of the step matrix that the contact stiffness takes: softer sinks, stiffer takes Newton longer

double quadratic_form(const DiagonalBlocks& a, int i, const Vec3& n) {
    return n.x() * (a[0][i] * n.x() + 2.0 * a[1][i] * n.y() + 2.0 * a[2][i] * n.z()) +
           n.y() * (a[3][i] * n.y() + 2.0 * a[4][i] * n.z()) + a[5][i] * n.z() * n.z();
}

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

double row_stiffness(const ContactRows& rows, std::size_t row, const ContactStep& step) {
    const double inertia =
        at_contact(rows, row, [&](int vertex) { return quadratic_form(*step.diagonal, vertex, rows.direction[row]); });
    double mass = 0.0;
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        mass += std::abs(rows.weight[row][k]) * (*step.mass)[rows.vertex[row][k]];
    }
    return std::max(share_of_matrix * inertia / (step.dt * step.dt), 4.0 * mass * step.gravity.norm() / rows.thickness[row]);
}

Vec3 row_velocity(const ContactRows& rows, std::size_t row, const Vectors& velocities) {
    Vec3 velocity = Vec3::Zero();
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) velocity += rows.weight[row][k] * velocities.at(rows.vertex[row][k]);
    return velocity;
}

Vec3 tangential(const Vec3& v, const Vec3& normal) { return v - normal * normal.dot(v); }

/// Adds factor (I - n n^T - t t^T) to a symmetric block; t may be zero.
void add_tangent_block(std::array<double, 6>& k, double factor, const Vec3& n, const Vec3& t) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * ((a == b ? 1.0 : 0.0) - n[a] * n[b] - t[a] * t[b]);
    }
}

void add_normal_block(std::array<double, 6>& k, double factor, const Vec3& n) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * n[a] * n[b];
    }
}

/// Friction force of a row pressed by `normal_force`, and its matrix added to `block`.
Vec3 friction(const ContactRows& rows, std::size_t row, double normal_force, const Vec3& velocity, const ContactStep& step,
              ContactBlock& block) {
    const Vec3& n = rows.direction[row];
    const double limit = rows.friction[row] * normal_force;
    if (limit == 0.0) return Vec3::Zero();
    const Vec3 obstacle_velocity = step.obstacle_rate * rows.obstacle_displacement[row];
    Vec3 slip = tangential(velocity - obstacle_velocity, n);
    const bool between_cloths = rows.obstacle[row] < 0;
    double mass = at_contact(rows, row, [&](int vertex) { return (*step.mass)[vertex]; }), weight_squares = 0.0;
    for (const double weight : block.weight) weight_squares += weight * weight;
    if (!between_cloths) mass /= weight_squares;
    // Gravity pushes both of two cloths alike.
    const Vec3 push = step.first_evaluation && !between_cloths ? tangential(step.gravity, n) : Vec3(Vec3::Zero());
    const Vec3 heading = slip + step.dt * push;
    const double speed = heading.norm();
    // Sliding: friction at its limit cannot stop the point within the step.
    const bool slides = speed > stick_speed && speed * mass > step.dt * limit;
    if (slides) {
        add_tangent_block(block.k, step.dt * limit / speed, n, heading / speed);
        return -limit / speed * heading;
    }
    const double slip_speed = slip.norm();
    const double y = slip_speed / stick_speed;
    const double damping = step.first_evaluation || y < 1.0 ? limit * (2.0 - std::min(y, 1.0)) / stick_speed : limit / slip_speed;
    add_tangent_block(block.k, step.dt * damping, n, Vec3::Zero());
    return -damping * slip;
}

}  // namespace

ContactPotential contact_potential(double distance, double thickness, double stiffness) {
    if (distance >= thickness) return {};
    const double half = 0.5 * thickness, depth = thickness - distance;
    if (distance >= half) return {0.5 * stiffness * depth * depth, stiffness * depth, stiffness};
    // Below h/2 the slope is k (h/2)^2 / d, which meets k (h - d) there with the same value and derivative.
    const double scale = stiffness * half * half;
    return {0.5 * scale + scale * std::log(half / distance), scale / distance, scale / (distance * distance)};
}

void add_contact(const ContactRows& rows, const ContactStep& step, const Vectors& velocities, Vectors& forces,
                 ContactTerms& terms) {
    terms.blocks.clear();
    terms.energy = terms.largest_stiffness = terms.obstacle_power = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const double stiffness = row_stiffness(rows, row, step);
        const ContactPotential potential = contact_potential(rows.distance[row], rows.thickness[row], stiffness);
        ContactBlock block{.vertex = rows.vertex[row], .weight = rows.weight[row], .k = {}};
        add_normal_block(block.k, step.dt * step.dt * potential.curvature, rows.direction[row]);
        const Vec3 velocity = row_velocity(rows, row, velocities);
        const Vec3 force = potential.slope * rows.direction[row] + friction(rows, row, potential.slope, velocity, step, block);
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) forces.add(block.vertex[k], block.weight[k] * force);
        terms.blocks.push_back(block);
        terms.energy += potential.energy;
        terms.largest_stiffness = std::max(terms.largest_stiffness, stiffness);
        terms.obstacle_power += force.dot(rows.obstacle_displacement[row]) * step.obstacle_rate;
    }
}

}  // namespace percale
