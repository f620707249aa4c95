#include "self/cluster_tree.h"

#include <algorithm>
#include <bit>

namespace percale {

void ClusterTree::refit(std::span<const Box> boxes) {
    leaves_ = std::bit_ceil(std::max<std::size_t>(boxes.size(), 1));
    nodes_.resize(2 * leaves_);
    std::copy(boxes.begin(), boxes.end(), nodes_.begin() + static_cast<long>(leaves_));
    std::fill(nodes_.begin() + static_cast<long>(leaves_ + boxes.size()), nodes_.end(), Box{});
    for (std::size_t k = leaves_ - 1; k > 0; --k) {
        nodes_[k] = nodes_[2 * k];
        nodes_[k].add(nodes_[2 * k + 1]);
    }
}

bool ClusterTree::find_pairs(std::vector<std::pair<int, int>>& pairs, long max) {
    pairs.clear();
    open_.assign({{1, 1}});
    while (!open_.empty()) {
        const auto [a, b] = open_.back();
        open_.pop_back();
        if (!nodes_[a].overlaps(nodes_[b])) continue;
        if (a >= leaves_) {
            if (static_cast<long>(pairs.size()) >= max) return false;
            pairs.emplace_back(static_cast<int>(a - leaves_), static_cast<int>(b - leaves_));
            continue;
        }
        open_.insert(open_.end(), {{2 * a, 2 * b}, {2 * a, 2 * b + 1}, {2 * a + 1, 2 * b + 1}});
        if (a != b) open_.emplace_back(2 * a + 1, 2 * b);
    }
    std::sort(pairs.begin(), pairs.end());
    return true;
}

}  // namespace percale
