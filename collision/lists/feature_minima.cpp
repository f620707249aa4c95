#include "lists/feature_minima.h"

#include "tolerances.h"

namespace percale {

void FeatureMinima::begin(const ContactRows& rows) {
    first_ = rows.size();
    minimum_.clear();
}

bool FeatureMinima::is_taken(const ContactRows& rows, std::size_t i) const {
    const auto same_place = [&](std::size_t k) {
        const Vec3 apart = rows.obstacle_point[first_ + i] - rows.obstacle_point[first_ + k];
        return apart.norm() <= tolerances::same_place * rows.thickness[first_ + i];
    };
    for (std::size_t k = 0; k < minimum_.size(); ++k) {
        const double cosine = rows.direction[first_ + i].dot(rows.direction[first_ + k]);
        if (k == i || !(cosine > tolerances::replaced_direction)) continue;
        if (minimum_[k] > minimum_[i] || (minimum_[k] == minimum_[i] && k < i && same_place(k))) return true;
    }
    return false;
}

void FeatureMinima::next_feature(ContactRows& rows) {
    const bool of_vertex = minimum_.size() > 1 && rows.vertex[first_][1] < 0;
    if (of_vertex) {
        // From behind, so that those still to be looked at have all minima before them in their places.
        for (std::size_t i = minimum_.size(); i-- > 0;) {
            if (!is_taken(rows, i)) continue;
            rows.erase(first_ + i);
            minimum_.erase(minimum_.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    begin(rows);
}

}  // namespace percale
