#include "friction.h"

#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "forces/blocks.h"
#include "tolerances.h"

namespace percale {
namespace {

std::pair<int, int> key(const Grip& grip) { return {grip.vertex, grip.obstacle}; }

/// Null if the vertex did not hold on to the obstacle.
const Grip* grip_at_start(const FrictionStart& start, int vertex, int obstacle) {
    const std::pair<int, int> wanted{vertex, obstacle};
    const auto found = std::lower_bound(start.grips.begin(), start.grips.end(), wanted,
                                        [](const Grip& grip, const std::pair<int, int>& value) { return key(grip) < value; });
    return found != start.grips.end() && key(*found) == wanted ? &*found : nullptr;
}

/// The linear part of a pose.
Eigen::Matrix3d matrix_of(const Pose& pose) {
    const Pose turn{.translation = Vec3::Zero(), .rotation = pose.rotation, .scale = pose.scale};
    Eigen::Matrix3d m;
    for (int axis = 0; axis < 3; ++axis) m.col(axis) = transform(turn, Vec3::Unit(axis));
    return m;
}

double spring_energy(double press, double reach, double slip) {
    const double stretch = std::min(slip, reach);
    return 0.5 * press / reach * stretch * stretch;
}

}  // namespace

ObstacleFlow obstacle_flow(const Pose& start, const Pose& end, double fraction) {
    if (start == end) return {};
    // x(s) = (1 - s) (t0 + R0 y) + s (t1 + R1 y) for the point y of the obstacle.
    const Vec3 shift = end.translation - start.translation;
    const Eigen::Matrix3d from = matrix_of(start), change = matrix_of(end) - from;
    const Eigen::Matrix3d turn = change * (from + fraction * change).inverse();
    return {turn, shift - turn * (start.translation + fraction * shift)};
}

void Touches::clear(std::size_t vertices) {
    for (const Touch& touch : all) first[touch.vertex] = -1;
    all.clear();
    first.resize(vertices, -1);
}

const Touch* Touches::find(int vertex, int obstacle) const {
    if (vertex >= static_cast<int>(first.size())) return nullptr;
    int at = first[vertex];
    while (at >= 0 && all[at].obstacle != obstacle) at = all[at].next;
    return at >= 0 ? &all[at] : nullptr;
}

Touch& Touches::get(int vertex, int obstacle) {
    if (const Touch* found = find(vertex, obstacle)) return all[found - all.data()];
    Touch touch;
    touch.vertex = vertex;
    touch.obstacle = obstacle;
    touch.next = first[vertex];
    first[vertex] = static_cast<int>(all.size());
    return all.emplace_back(touch);
}

void set_slip(const FrictionStart& start, const Vec3& position, double fraction, Touch& touch) {
    const Grip* grip = grip_at_start(start, touch.vertex, touch.obstacle);
    touch.old = grip != nullptr;
    const Vec3 held = start.positions->at(touch.vertex) - (grip ? grip->stretch : Vec3(Vec3::Zero()));
    if (touch.obstacle < static_cast<int>(start.flows.size())) {
        const ObstacleFlow& flow = start.flows[touch.obstacle];
        touch.flow = flow.deforms ? Vec3(touch.carried / touch.load) : Vec3(flow.turn * held + flow.shift);
    }
    touch.slip = tangential(position - held - (fraction - start.fraction) * touch.flow, touch.press.normalized());
}

Rub rub_of(const FrictionStart& start, const ContactRows& rows, int row, double normal_force, const Vectors& positions) {
    Rub rub{.row = row, .press = rows.friction[row] * normal_force, .reach = stick_reach_share * rows.thickness[row]};
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        const int vertex = rows.vertex[row][k];
        rub.moved += rows.weight[row][k] * (positions.at(vertex) - start.positions->at(vertex));
    }
    rub.moved = tangential(rub.moved, rows.direction[row]);
    rub.slip = rub.moved;
    if (!start.held) return rub;
    const RowForce before = start.held->of(row_key(rows, row));
    if (before.normal > 0.0) {
        rub.slip -= rub.reach / (rows.friction[row] * before.normal) * tangential(before.friction, rows.direction[row]);
    }
    return rub;
}

Vec3 friction_force(const Touch& touch) { return -touch.press.norm() / std::max(touch.slip.norm(), touch.reach) * touch.slip; }

Vec3 friction_force(const Rub& rub) { return -rub.press / std::max(rub.slip.norm(), rub.reach) * rub.slip; }

double grip_energy(const Touches& touches) {
    double energy = 0.0;
    for (const Touch& touch : touches.all) energy += spring_energy(touch.press.norm(), touch.reach, touch.slip.norm());
    return energy;
}

double grip_energy(std::span<const Rub> rubs) {
    double energy = 0.0;
    for (const Rub& rub : rubs) energy += spring_energy(rub.press, rub.reach, rub.slip.norm());
    return energy;
}

void set_grips(const Touches& touches, std::vector<Grip>& grips) {
    grips.clear();
    for (const Touch& touch : touches.all) {
        const double length = touch.slip.norm();
        const double kept = length > touch.reach ? touch.reach / length : 1.0;
        grips.push_back({touch.vertex, touch.obstacle, kept * touch.slip});
    }
    std::sort(grips.begin(), grips.end(), [](const Grip& a, const Grip& b) { return key(a) < key(b); });
}

void set_held(const ContactRows& rows, std::span<const Rub> rubs, const std::vector<RowForce>& row_forces,
              ContactMultipliers& held) {
    held.clear(rubs.size());
    for (const Rub& rub : rubs) {
        held.add(row_key(rows, rub.row), {.normal = row_forces[rub.row].normal, .friction = friction_force(rub)});
    }
}

}  // namespace percale
