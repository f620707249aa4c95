#include "lists/feature_minima.h"

#include "tolerances.h"

namespace percale {
namespace {

/// Cosine between the directions of two constraints of one cloth feature above which a local minimum of the distance replaces a
/// constraint that is a minimum no longer. Smaller: forces turn suddenly where cloth passes an edge. Larger: cloth that slides
/// over an edge is pushed twice, which sets a sheet that slides on a plane of two triangles trembling.
constexpr double replaced_direction = 0.9;

}  // namespace

void FeatureMinima::begin(const ContactConstraints& constraints) {
    first_ = constraints.size();
    minimum_.clear();
}

bool FeatureMinima::is_taken(const ContactConstraints& constraints, std::size_t i) const {
    const auto same_place = [&](std::size_t k) {
        const Vec3 apart = constraints.obstacle_point[first_ + i] - constraints.obstacle_point[first_ + k];
        return apart.norm() <= tolerances::same_place * constraints.thickness[first_ + i];
    };
    for (std::size_t k = 0; k < minimum_.size(); ++k) {
        const double cosine = constraints.direction[first_ + i].dot(constraints.direction[first_ + k]);
        if (k == i || !(cosine > replaced_direction)) continue;
        if (minimum_[k] > minimum_[i] || (minimum_[k] == minimum_[i] && k < i && same_place(k))) return true;
    }
    return false;
}

void FeatureMinima::next_feature(ContactConstraints& constraints) {
    const bool of_vertex = minimum_.size() > 1 && constraints.vertex[first_][1] < 0;
    if (of_vertex) {
        // The loop runs backwards, so that all minima before the constraints still to be examined keep their places.
        for (std::size_t i = minimum_.size(); i-- > 0;) {
            if (!is_taken(constraints, i)) continue;
            constraints.erase(first_ + i);
            minimum_.erase(minimum_.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    begin(constraints);
}

}  // namespace percale
