#include "multipliers.h"

#include <algorithm>

#include "tolerances.h"

namespace percale {
namespace {

constexpr int any_feature = -2;  // of an obstacle

RowKey of_cloth_feature(RowKey key) {
    key.feature = any_feature;
    return key;
}

/// Whether a row is off the obstacle, and another of its cloth feature nearer.
bool has_left(const ContactRows& rows, int row, int nearest, const RowClearance& clearance) {
    const double cloth_thickness = rows.thickness[row] / clearance.zone;
    const double from = std::max(cloth_thickness, rows.distance[nearest]) + clearance.share * cloth_thickness;
    return rows.distance[row] > from && rows.direction[row].dot(rows.direction[nearest]) > least_handing_cosine;
}

/// All forces by their keys, in whatever order they came.
void set_ordered(const RowTable<RowForce>& forces, std::vector<KeyedForce>& ordered) {
    ordered.clear();
    for (const auto& [key, force] : forces.entries()) ordered.push_back({key, force});
    std::sort(ordered.begin(), ordered.end(), [](const KeyedForce& a, const KeyedForce& b) { return a.key < b.key; });
}

}  // namespace

RowKey row_key(const ContactRows& rows, std::size_t row) {
    return {.vertex = rows.vertex[row], .obstacle = rows.obstacle[row], .feature = rows.feature[row]};
}

void ContactMultipliers::hand_over(const ContactRows& rows, const RowClearance& clearance) {
    if (forces_.entries().empty()) return;
    places_.clear(2 * rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const RowKey key = row_key(rows, row);
        const int number = static_cast<int>(row);
        places_.at(key) = number;
        if (rows.obstacle[row] < 0 || rows.share[row] < least_handed_share) continue;
        const int* known = places_.find(of_cloth_feature(key));
        if (!known || rows.distance[row] < rows.distance[*known]) places_.at(of_cloth_feature(key)) = number;
    }
    set_ordered(forces_, ordered_);
    forces_.clear(ordered_.size());
    for (const auto& [key, force] : ordered_) {
        const int *own = places_.find(key), *nearest = places_.find(of_cloth_feature(key));
        const bool goes_on = nearest && (!own || has_left(rows, *own, *nearest, clearance));
        RowForce& handed = forces_.at(goes_on ? row_key(rows, *nearest) : key);
        handed.normal += force.normal;
        handed.friction += force.friction;
        handed.stiffness = std::max(handed.stiffness, force.stiffness);
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

RowForce ContactMultipliers::of(const RowKey& key) const {
    const RowForce* force = forces_.find(key);
    return force ? *force : RowForce{};
}

}  // namespace percale
