#include "contact_multipliers.h"

#include <algorithm>
#include <bit>

#include "support/hash.h"

namespace percale {

RowKey row_key(const ContactRows& rows, std::size_t row) {
    return {.vertex = rows.vertex[row], .obstacle = rows.obstacle[row], .feature = rows.feature[row]};
}

void ContactMultipliers::clear(std::size_t rows) {
    slots_.assign(std::bit_ceil(2 * rows + 1), {});
    size_ = 0;
}

std::size_t ContactMultipliers::place(const RowKey& key) const {
    Hash hash;
    for (const int vertex : key.vertex) hash.add(vertex);
    hash.add(key.obstacle);
    hash.add(key.feature);
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash.value() & mask;
    while (slots_[at].used && !(slots_[at].key == key)) at = (at + 1) & mask;
    return at;
}

void ContactMultipliers::add(const RowKey& key, const RowForce& force) {
    slots_[place(key)] = {.key = key, .force = force, .used = true};
    ++size_;
}

std::vector<KeyedForce> ContactMultipliers::all() const {
    std::vector<KeyedForce> all;
    for (const Slot& slot : slots_) {
        if (slot.used) all.push_back({slot.key, slot.force});
    }
    std::sort(all.begin(), all.end(), [](const KeyedForce& a, const KeyedForce& b) { return a.key < b.key; });
    return all;
}

void ContactMultipliers::set(std::span<const KeyedForce> all) {
    clear(all.size());
    for (const auto& [key, force] : all) add(key, force);
}

RowForce ContactMultipliers::of(const RowKey& key) const { return slots_.empty() ? RowForce{} : slots_[place(key)].force; }

}  // namespace percale
