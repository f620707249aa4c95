#include "friction.h"

#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "forces/blocks.h"
#include "tolerances.h"

namespace percale {
namespace {

std::pair<int, int> key(const StickAnchor& stick_anchor) { return {stick_anchor.vertex, stick_anchor.obstacle}; }

/// Null if the vertex had no stick anchor on the obstacle.
const StickAnchor* anchor_at_start(const FrictionStart& start, int vertex, int obstacle) {
    const std::pair<int, int> wanted{vertex, obstacle};
    const auto found = std::lower_bound(
        start.stick_anchors.begin(), start.stick_anchors.end(), wanted,
        [](const StickAnchor& stick_anchor, const std::pair<int, int>& value) { return key(stick_anchor) < value; });
    return found != start.stick_anchors.end() && key(*found) == wanted ? &*found : nullptr;
}

/// The linear part of a pose.
Eigen::Matrix3d matrix_of(const Pose& pose) {
    const Pose turn{.translation = Vec3::Zero(), .rotation = pose.rotation, .scale = pose.scale};
    Eigen::Matrix3d m;
    for (int axis = 0; axis < 3; ++axis) m.col(axis) = transform(turn, Vec3::Unit(axis));
    return m;
}

}  // namespace

ObstacleMotion obstacle_motion(const Pose& start, const Pose& end, double fraction) {
    if (start == end) return {};
    // x(s) = (1 - s) (t0 + R0 y) + s (t1 + R1 y) for the point y of the obstacle.
    const Vec3 shift = end.translation - start.translation;
    const Eigen::Matrix3d from = matrix_of(start), change = matrix_of(end) - from;
    const Eigen::Matrix3d turn = change * (from + fraction * change).inverse();
    return {turn, shift - turn * (start.translation + fraction * shift)};
}

void FrictionContacts::clear(std::size_t vertices) {
    for (const FrictionContact& contact : all) first[contact.vertex] = -1;
    all.clear();
    first.resize(vertices, -1);
}

const FrictionContact* FrictionContacts::find(int vertex, int obstacle) const {
    if (vertex >= static_cast<int>(first.size())) return nullptr;
    int at = first[vertex];
    while (at >= 0 && all[at].obstacle != obstacle) at = all[at].next;
    return at >= 0 ? &all[at] : nullptr;
}

FrictionContact& FrictionContacts::get(int vertex, int obstacle) {
    if (const FrictionContact* found = find(vertex, obstacle)) return all[found - all.data()];
    FrictionContact contact;
    contact.vertex = vertex;
    contact.obstacle = obstacle;
    contact.next = first[vertex];
    first[vertex] = static_cast<int>(all.size());
    return all.emplace_back(contact);
}

void set_slip(const FrictionStart& start, const Vec3& position, double fraction, FrictionContact& contact) {
    const StickAnchor* stick_anchor = anchor_at_start(start, contact.vertex, contact.obstacle);
    contact.had_anchor = stick_anchor != nullptr;
    const Vec3 held = start.positions->at(contact.vertex) - (stick_anchor ? stick_anchor->stretch : Vec3(Vec3::Zero()));
    if (contact.obstacle < static_cast<int>(start.obstacle_motions.size())) {
        const ObstacleMotion& motion = start.obstacle_motions[contact.obstacle];
        contact.obstacle_displacement =
            motion.deforms ? Vec3(contact.carried / contact.load) : Vec3(motion.turn * held + motion.shift);
    }
    contact.slip = tangential(position - held - (fraction - start.fraction) * contact.obstacle_displacement,
                              contact.friction_limit.normalized());
}

ClothFrictionContact cloth_friction_contact(const FrictionStart& start, const ContactConstraints& constraints, int constraint,
                                            double normal_force, const Vec3Arrays& positions) {
    ClothFrictionContact contact{.constraint = constraint,
                                 .law = {.limit = constraints.friction[constraint] * normal_force,
                                         .stick_threshold = stick_threshold_ratio * constraints.thickness[constraint]}};
    const ClothAnchor* anchor =
        start.cloth_anchors ? start.cloth_anchors->find(constraints, constraint, *start.positions) : nullptr;
    contact.had_anchor = anchor != nullptr;
    contact.vertex = anchor ? anchor->vertex : constraints.vertex[constraint];
    contact.weight = anchor ? anchor->weight : constraints.weight[constraint];
    for (int k = 0; k < 4 && contact.vertex[k] >= 0; ++k)
        contact.moved += contact.weight[k] * (positions.at(contact.vertex[k]) - start.positions->at(contact.vertex[k]));
    contact.moved = tangential(contact.moved, constraints.direction[constraint]);
    contact.slip = contact.moved;
    if (anchor) contact.slip += tangential(anchor->stretch, constraints.direction[constraint]);
    return contact;
}

double stick_energy(const FrictionContacts& friction_contacts) {
    double energy = 0.0;
    for (const FrictionContact& contact : friction_contacts.all) energy += contact.law().stored(contact.slip.norm());
    return energy;
}

double stick_energy(std::span<const ClothFrictionContact> cloth_friction_contacts) {
    double energy = 0.0;
    for (const ClothFrictionContact& contact : cloth_friction_contacts) energy += contact.law.stored(contact.slip.norm());
    return energy;
}

void set_stick_anchors(const FrictionContacts& friction_contacts, std::vector<StickAnchor>& stick_anchors) {
    stick_anchors.clear();
    for (const FrictionContact& contact : friction_contacts.all) {
        stick_anchors.push_back({contact.vertex, contact.obstacle, contact.law().anchored(contact.slip)});
    }
    std::sort(stick_anchors.begin(), stick_anchors.end(),
              [](const StickAnchor& a, const StickAnchor& b) { return key(a) < key(b); });
}

}  // namespace percale
