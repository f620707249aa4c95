#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "percale/contact.h"
#include "row_table.h"

namespace percale {

RowKey row_key(const ContactRows& rows, std::size_t row);

/// The force of one row on the cloth: `normal` >= 0 along the row's direction and the friction, N.
struct RowForce {
    double normal = 0.0;
    Vec3 friction = Vec3::Zero();
    double stiffness = 0.0;  // N/m, that it was found with
};

struct KeyedForce {
    RowKey key;
    RowForce force;
};

/// From where on a row counts as off the obstacle.
struct RowClearance {
    double zone = 1.0;   // the rows' thickness over the cloth's
    double share = 0.0;  // of the cloth's thickness, beyond it
};

/// Contact forces found again by row. A row that is not known has none.
class ContactMultipliers {
public:
    /// Forgets everything and makes room for that many rows.
    void clear(std::size_t rows) { forces_.clear(rows); }
    /// Each key once.
    void add(const RowKey& key, const RowForce& force) { forces_.at(key) = force; }
    RowForce of(const RowKey& key) const;
    std::size_t size() const { return forces_.entries().size(); }

    /// Where facets pass under a feature of the cloth, a force goes on with it: from a row that is gone, or off and farther than
    /// another, to the nearest row of the same feature of the cloth on the same obstacle that has most of its stiffness. Left
    /// where it was it would act behind the place of contact and only slowly move on. Between cloths forces stay where they are.
    void hand_over(const ContactRows& rows, const RowClearance& clearance);

    /// All that are known, by their keys, and back.
    std::vector<KeyedForce> all() const;
    void set(std::span<const KeyedForce> all);

private:
    RowTable<RowForce> forces_;
    RowTable<int> places_;             // scratch space of hand_over: numbers of rows
    std::vector<KeyedForce> ordered_;  // likewise: the forces before it, as sums depend on their order
};

}  // namespace percale
