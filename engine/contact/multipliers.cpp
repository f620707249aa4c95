#include "multipliers.h"

#include <algorithm>

namespace percale {
namespace {

/// Smallest mollifier of a constraint that receives forces of others. Smaller: forces go to constraints that hardly act.
constexpr double min_transfer_ratio = 0.5;

/// Cosine between the directions of constraints that pass forces on to each other. Less: they may lie on two sides of a gap. 1:
/// forces stay behind where facets turn.
constexpr double min_transfer_cosine = 0.9;

constexpr int any_feature = -2;  // of an obstacle

ConstraintKey of_cloth_feature(ConstraintKey key) {
    key.feature = any_feature;
    return key;
}

/// Whether a constraint is off the obstacle, and another one of its cloth feature is nearer.
bool has_left(const ContactConstraints& constraints, int constraint, int nearest, const ConstraintClearance& clearance) {
    const double cloth_thickness = constraints.thickness[constraint] / clearance.activation_ratio;
    const double from = std::max(cloth_thickness, constraints.distance[nearest]) + clearance.ratio * cloth_thickness;
    return constraints.distance[constraint] > from &&
           constraints.direction[constraint].dot(constraints.direction[nearest]) > min_transfer_cosine;
}

/// All forces, sorted by their keys.
void set_ordered(const ConstraintTable<ConstraintForce>& forces, std::vector<KeyedForce>& ordered) {
    ordered.clear();
    for (const auto& [key, force] : forces.entries()) ordered.push_back({key, force});
    std::sort(ordered.begin(), ordered.end(), [](const KeyedForce& a, const KeyedForce& b) { return a.key < b.key; });
}

}  // namespace

ConstraintKey constraint_key(const ContactConstraints& constraints, std::size_t constraint) {
    return {.vertex = constraints.vertex[constraint],
            .obstacle = constraints.obstacle[constraint],
            .feature = constraints.feature[constraint]};
}

void ContactMultipliers::transfer(const ContactConstraints& constraints, const ConstraintClearance& clearance) {
    if (forces_.entries().empty()) return;
    places_.clear(2 * constraints.size());
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const ConstraintKey key = constraint_key(constraints, constraint);
        const int number = static_cast<int>(constraint);
        places_.at(key) = number;
        if (constraints.obstacle[constraint] < 0 || constraints.mollifier[constraint] < min_transfer_ratio) continue;
        const int* known = places_.find(of_cloth_feature(key));
        if (!known || constraints.distance[constraint] < constraints.distance[*known]) places_.at(of_cloth_feature(key)) = number;
    }
    set_ordered(forces_, ordered_);
    forces_.clear(ordered_.size());
    for (const auto& [key, force] : ordered_) {
        const int *own = places_.find(key), *nearest = places_.find(of_cloth_feature(key));
        const bool goes_on = nearest && force.direction.dot(constraints.direction[*nearest]) > 0.0 &&
                             (!own || has_left(constraints, *own, *nearest, clearance));
        ConstraintForce& handed = forces_.at(goes_on ? constraint_key(constraints, *nearest) : key);
        handed.normal += force.normal;
        handed.friction += force.friction;
        handed.stiffness = std::max(handed.stiffness, force.stiffness);
        handed.direction = goes_on ? constraints.direction[*nearest] : force.direction;
    }
}

std::vector<KeyedForce> ContactMultipliers::all() const {
    std::vector<KeyedForce> all;
    set_ordered(forces_, all);
    return all;
}

void ContactMultipliers::set(std::span<const KeyedForce> all) {
    clear(all.size());
    for (const auto& [key, force] : all) add(key, force);
}

ConstraintForce ContactMultipliers::of(const ConstraintKey& key) const {
    const ConstraintForce* force = forces_.find(key);
    return force ? *force : ConstraintForce{};
}

}  // namespace percale
