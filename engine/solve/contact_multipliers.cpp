#include "contact_multipliers.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace percale {

RowKey row_key(const ContactRows& rows, std::size_t row) {
    return {.vertex = rows.vertex[row], .obstacle = rows.obstacle[row], .feature = rows.feature[row]};
}

void ContactMultipliers::clear(std::size_t rows) {
    slots_.assign(std::bit_ceil(2 * rows + 1), -1);
    forces_.clear();
}

std::size_t ContactMultipliers::place(const RowKey& key) const {
    // Multiplication carries every bit upwards, the shift brings the upper half down again (Knuth, The Art of Computer
    // Programming 3, 6.4: Fibonacci hashing). Looked up for each row of each evaluation.
    std::uint64_t mixed = 0;
    const auto mix = [&mixed](int number) {
        mixed = (mixed ^ static_cast<std::uint32_t>(number)) * 0x9e3779b97f4a7c15U;
        mixed ^= mixed >> 32U;
    };
    for (const int vertex : key.vertex) mix(vertex);
    mix(key.obstacle);
    mix(key.feature);
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = mixed & mask;
    while (slots_[at] >= 0 && !(forces_[slots_[at]].key == key)) at = (at + 1) & mask;
    return at;
}

void ContactMultipliers::add(const RowKey& key, const RowForce& force) {
    slots_[place(key)] = static_cast<int>(forces_.size());
    forces_.push_back({key, force});
}

std::vector<KeyedForce> ContactMultipliers::all() const {
    std::vector<KeyedForce> all = forces_;
    std::sort(all.begin(), all.end(), [](const KeyedForce& a, const KeyedForce& b) { return a.key < b.key; });
    return all;
}

void ContactMultipliers::set(std::span<const KeyedForce> all) {
    clear(all.size());
    for (const auto& [key, force] : all) add(key, force);
}

RowForce ContactMultipliers::of(const RowKey& key) const {
    const int number = slots_.empty() ? -1 : slots_[place(key)];
    return number >= 0 ? forces_[number].force : RowForce{};
}

}  // namespace percale
