#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <vector>

#include "percale/contact.h"

namespace percale {

/// What tells contact rows of one evaluation from each other and finds them again in the next.
struct RowKey {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    int obstacle = -1;
    int feature = -1;

    auto operator<=>(const RowKey&) const = default;
};

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

/// Contact forces found again by row. A row that is not known has none.
class ContactMultipliers {
public:
    /// Forgets everything and makes room for that many rows.
    void clear(std::size_t rows);
    /// Each key once.
    void add(const RowKey& key, const RowForce& force);
    RowForce of(const RowKey& key) const;
    std::size_t size() const { return forces_.size(); }

    /// All that are known, by their keys, and back.
    std::vector<KeyedForce> all() const;
    void set(std::span<const KeyedForce> all);

private:
    std::size_t place(const RowKey& key) const;

    std::vector<KeyedForce> forces_;  // in the order in which they came: rows are looked up in much the same one
    std::vector<int> slots_;          // numbers of forces, -1 = unused; a power of two, at most half of them used
};

}  // namespace percale
