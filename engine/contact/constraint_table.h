#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace percale {

/// The key of a contact constraint: unique within one evaluation, the same in the next.
struct ConstraintKey {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    int obstacle = -1;
    int feature = -1;

    auto operator<=>(const ConstraintKey&) const = default;
};

/// Values found by the keys of their constraints, in order of insertion: constraints are looked up in much the same order.
template <class Value>
class ConstraintTable {
public:
    struct Entry {
        ConstraintKey key;
        Value value;
    };

    /// Forgets everything and reserves memory for that many keys.
    void clear(std::size_t count) {
        slots_.assign(std::bit_ceil(2 * count + 1), -1);
        entries_.clear();
    }

    /// Null if the key is not known.
    const Value* find(const ConstraintKey& key) const {
        const int number = slots_.empty() ? -1 : slots_[place(key)];
        return number >= 0 ? &entries_[number].value : nullptr;
    }

    /// The value of a key, a new default value if it was not known; the reference is valid until the next key is added.
    Value& at(const ConstraintKey& key) {
        int& slot = slots_[place(key)];
        if (slot < 0) {
            slot = static_cast<int>(entries_.size());
            entries_.push_back({key, {}});
        }
        return entries_[slot].value;
    }

    std::span<const Entry> entries() const { return entries_; }

private:
    std::size_t place(const ConstraintKey& key) const {
        // Multiplication carries every bit upwards, the shift brings the upper half down again (Knuth, The Art of Computer
        // Programming 3, 6.4: Fibonacci hashing). It runs for each constraint of each evaluation.
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
        while (slots_[at] >= 0 && !(entries_[slots_[at]].key == key)) at = (at + 1) & mask;
        return at;
    }

    std::vector<Entry> entries_;
    std::vector<int> slots_;  // numbers of entries, -1 = unused; their count is a power of two, at most half of them are used
};

}  // namespace percale
