#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace percale {

/// What tells contact rows of one evaluation from each other and finds them again in the next.
struct RowKey {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    int obstacle = -1;
    int feature = -1;

    auto operator<=>(const RowKey&) const = default;
};

/// Values found again by row, in the order in which they came: rows are looked up in much the same one.
template <class Value>
class RowTable {
public:
    struct Entry {
        RowKey key;
        Value value;
    };

    /// Forgets everything and makes room for that many keys.
    void clear(std::size_t count) {
        slots_.assign(std::bit_ceil(2 * count + 1), -1);
        entries_.clear();
    }

    /// Null if the key is not known.
    const Value* find(const RowKey& key) const {
        const int number = slots_.empty() ? -1 : slots_[place(key)];
        return number >= 0 ? &entries_[number].value : nullptr;
    }

    /// The value of a key, a new one with the default if it was not known; good until the next one comes.
    Value& at(const RowKey& key) {
        int& slot = slots_[place(key)];
        if (slot < 0) {
            slot = static_cast<int>(entries_.size());
            entries_.push_back({key, {}});
        }
        return entries_[slot].value;
    }

    std::span<const Entry> entries() const { return entries_; }

private:
    std::size_t place(const RowKey& key) const {
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
        while (slots_[at] >= 0 && !(entries_[slots_[at]].key == key)) at = (at + 1) & mask;
        return at;
    }

    std::vector<Entry> entries_;
    std::vector<int> slots_;  // numbers of entries, -1 = unused; a power of two, at most half of them used
};

}  // namespace percale
