#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "constraint_table.h"
#include "percale/contact.h"

namespace percale {

ConstraintKey constraint_key(const ContactConstraints& constraints, std::size_t constraint);

/// The force of one constraint on the cloth, N: `normal` along its direction, below 0 where it is subtracted, and the friction.
struct ConstraintForce {
    double normal = 0.0;
    Vec3 friction = Vec3::Zero();
    double stiffness = 0.0;         // N/m, with which it was computed
    Vec3 direction = Vec3::Zero();  // of a multiplier: that of its constraint
};

struct KeyedForce {
    ConstraintKey key;
    ConstraintForce force;
};

/// The clearance from which on a constraint counts as off the obstacle.
struct ConstraintClearance {
    double activation_ratio = 1.0;  // thickness of the constraints over that of the cloth
    double ratio = 0.0;             // clearance beyond the cloth's thickness, over that thickness
};

/// Contact forces, found again by the keys of their constraints. An unknown constraint has no force.
class ContactMultipliers {
public:
    /// Forgets everything and reserves memory for that many constraints.
    void clear(std::size_t constraints) { forces_.clear(constraints); }
    /// Each key may be added once.
    void add(const ConstraintKey& key, const ConstraintForce& force) { forces_.at(key) = force; }
    ConstraintForce of(const ConstraintKey& key) const;
    bool knows(const ConstraintKey& key) const { return forces_.find(key) != nullptr; }
    /// How many there are with obstacles: these move on.
    std::size_t count_with_obstacles() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(forces_.entries(), [](const auto& entry) { return entry.key.obstacle >= 0; }));
    }

    /// Where facets pass under a feature of the cloth, a force moves on with it: from a constraint that is gone, or off and
    /// farther than another, to the nearest constraint of the same cloth feature with the same obstacle that has most of its
    /// stiffness, unless that is on the other side. Left where it was, it would act behind the place of contact and move on only
    /// slowly. Forces between cloths stay where they are.
    void transfer(const ContactConstraints& constraints, const ConstraintClearance& clearance);

    /// All known forces with their keys, and the reverse.
    std::vector<KeyedForce> all() const;
    void set(std::span<const KeyedForce> all);

private:
    ConstraintTable<ConstraintForce> forces_;
    ConstraintTable<int> places_;      // scratch space of transfer: numbers of constraints
    std::vector<KeyedForce> ordered_;  // likewise: the forces before it, sorted as sums depend on their order
};

}  // namespace percale
