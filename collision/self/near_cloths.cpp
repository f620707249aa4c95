#include "self/near_cloths.h"

namespace percale {

NearCloths::NearCloths(std::vector<Cloth> cloths) : cloths_(std::move(cloths)), boxes_(cloths_.size()), sets_(cloths_.size()) {}

void NearCloths::set_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
    for (std::size_t c = 0; c < cloths_.size(); ++c) {
        boxes_[c] = Box{};
        for (const int v : cloths_[c].vertices) {
            boxes_[c].add(from[v]);
            boxes_[c].add(to[v]);
        }
    }
}

const std::vector<int>& NearCloths::islands(std::span<const int> before, bool may_part) {
    const auto grown = [&](int c, double thicknesses) {
        Box box = boxes_[c];
        box.grow(thicknesses * cloths_[c].thickness);
        return box;
    };
    const int count = static_cast<int>(cloths_.size());
    grown_.resize(cloths_.size());
    // These boxes are wider than those that join: otherwise cloths that hover there would be divided and joined repeatedly.
    for (int c = 0; c < count; ++c) grown_[c] = grown(c, 1.0);
    tree_.refit(grown_);
    tree_.find_pairs(pairs_);
    sets_.part_all(cloths_.size());
    for (int c = 0; !may_part && c < static_cast<int>(before.size()); ++c) sets_.join(c, before[c]);
    for (const auto& [a, b] : pairs_) {
        if (before.empty() || before[a] == before[b] || grown(a, 0.5).overlaps(grown(b, 0.5))) sets_.join(a, b);
    }
    islands_.resize(cloths_.size());
    for (int c = 0; c < count; ++c) islands_[c] = sets_.of(c);
    return islands_;
}

}  // namespace percale
