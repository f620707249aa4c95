#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace percale {

/// Disjoint sets of the numbers 0 ... count - 1, each known by its lowest member.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) { part_all(count); }

    /// Each number is a set of its own.
    void part_all(std::size_t count) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    int of(int number) {
        while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
        return number;
    }
    void join(int a, int b) {
        const int x = of(a), y = of(b);
        parent_[std::max(x, y)] = std::min(x, y);
    }

private:
    std::vector<int> parent_;
};

}  // namespace percale
