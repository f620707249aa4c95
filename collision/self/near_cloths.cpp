#include "self/near_cloths.h"

#include <algorithm>

#include "geometry/disjoint_sets.h"
#include "tolerances.h"

namespace percale {

NearCloths::NearCloths(std::vector<Cloth> cloths) : cloths_(std::move(cloths)), boxes_(cloths_.size()) {}

void NearCloths::set_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
    for (std::size_t c = 0; c < cloths_.size(); ++c) {
        boxes_[c] = Box{};
        for (const int v : cloths_[c].vertices) {
            boxes_[c].add(from[v]);
            boxes_[c].add(to[v]);
        }
    }
}

/// Of boxes grown by so many thicknesses.
const std::vector<std::pair<int, int>>& NearCloths::near_pairs(double grown) {
    grown_boxes_ = boxes_;
    for (std::size_t c = 0; c < cloths_.size(); ++c) grown_boxes_[c].grow(grown * cloths_[c].thickness);
    tree_.refit(grown_boxes_);
    tree_.find_pairs(pairs_);
    std::erase_if(pairs_, [](const auto& pair) { return pair.first == pair.second; });
    return pairs_;
}

const std::vector<std::pair<int, int>>& NearCloths::meeting() { return near_pairs(0.5); }

std::vector<std::vector<int>> NearCloths::groups(std::span<const int> cloths) {
    DisjointSets sets(cloths_.size());
    std::vector<char> asked(cloths_.size(), 0);
    for (const int c : cloths) asked[c] = 1;
    // Wider than what meets: cloths that hover there would be divided and joined again and again.
    for (const auto& [a, b] : near_pairs(0.5 + tolerances::self_skin)) {
        if (asked[a] && asked[b]) sets.join(a, b);
    }
    std::vector<std::vector<int>> groups;
    std::vector<int> group_of(cloths_.size(), -1);
    for (const int c : cloths) {
        int& group = group_of[sets.of(c)];
        if (group < 0) {
            group = static_cast<int>(groups.size());
            groups.emplace_back();
        }
        groups[group].push_back(c);
    }
    return groups;
}

}  // namespace percale
