#include "cloth_anchors.h"

#include <algorithm>
#include <limits>

namespace percale {
namespace {

/// Cosine between the directions of contacts that share an anchor. Less: a vertex between two sheets holds on to either.
constexpr double min_anchor_cosine = 0.5;

/// How far the points of two contacts lie apart, m^2, by the sides with weights of that sign.
double square_between_points(const ClothAnchor& anchor, const ContactConstraints& constraints, std::size_t constraint,
                             const Vec3Arrays& x, bool first_side) {
    Vec3 apart = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
        if (anchor.vertex[k] >= 0 && (anchor.weight[k] > 0.0) == first_side) apart += anchor.weight[k] * x.at(anchor.vertex[k]);
        const int vertex = constraints.vertex[constraint][k];
        const double weight = constraints.weight[constraint][k];
        if (vertex >= 0 && (weight > 0.0) == first_side) apart -= weight * x.at(vertex);
    }
    return apart.squaredNorm();
}

}  // namespace

void ClothAnchors::set(std::span<const ClothAnchor> anchors) {
    anchors_.assign(anchors.begin(), anchors.end());
    entries_.clear();
    for (int i = 0; i < static_cast<int>(anchors.size()); ++i) {
        const int ends = is_of_vertex(anchors[i].weight) ? 1 : 4;
        for (int k = 0; k < ends; ++k) entries_.push_back({anchors[i].vertex[k], i});
    }
    std::ranges::sort(entries_, {}, [](const Entry& entry) { return std::pair(entry.vertex, entry.anchor); });
}

const ClothAnchor* ClothAnchors::find(const ContactConstraints& constraints, std::size_t constraint,
                                      const Vec3Arrays& start) const {
    const bool vertex = is_of_vertex(constraints.weight[constraint]);
    const double h = constraints.thickness[constraint];
    double nearest = vertex ? std::numeric_limits<double>::infinity() : 2.0 * h * h;
    const ClothAnchor* found = nullptr;
    for (int k = 0; k < (vertex ? 1 : 4); ++k) {
        const int end = constraints.vertex[constraint][k];
        for (auto entry = std::ranges::lower_bound(entries_, end, {}, &Entry::vertex);
             entry != entries_.end() && entry->vertex == end; ++entry) {
            const ClothAnchor& anchor = anchors_[entry->anchor];
            if (is_of_vertex(anchor.weight) != vertex || anchor.normal.dot(constraints.direction[constraint]) < min_anchor_cosine)
                continue;
            if (!vertex && anchor.vertex == constraints.vertex[constraint]) return &anchor;
            double square = square_between_points(anchor, constraints, constraint, start, false);
            if (!vertex) square += square_between_points(anchor, constraints, constraint, start, true);
            if (square >= nearest) continue;
            nearest = square;
            found = &anchor;
        }
    }
    return found;
}

/// Hardest pressed first, those of a vertex together.
bool AnchorKeeper::comes_before(const Candidate& a, const Candidate& b) {
    if (is_of_vertex(a.anchor.weight) != is_of_vertex(b.anchor.weight)) return is_of_vertex(a.anchor.weight);
    if (!is_of_vertex(a.anchor.weight)) return a.anchor.vertex < b.anchor.vertex;
    if (a.anchor.vertex[0] != b.anchor.vertex[0]) return a.anchor.vertex[0] < b.anchor.vertex[0];
    return a.limit != b.limit ? a.limit > b.limit : a.anchor.vertex < b.anchor.vertex;
}

void AnchorKeeper::keep(const ContactConstraints& constraints, std::span<const ClothFrictionContact> contacts,
                        std::vector<ClothAnchor>& anchors) {
    candidates_.clear();
    for (const ClothFrictionContact& contact : contacts) {
        if (contact.law.limit <= 0.0) continue;
        const bool stays = !contact.law.slides(contact.slip.norm());
        const std::size_t constraint = contact.constraint;
        candidates_.push_back({.anchor = {.vertex = stays ? contact.vertex : constraints.vertex[constraint],
                                          .weight = stays ? contact.weight : constraints.weight[constraint],
                                          .normal = constraints.direction[constraint],
                                          .stretch = contact.law.anchored(contact.slip)},
                               .limit = contact.law.limit});
    }
    std::ranges::sort(candidates_, comes_before);
    anchors.clear();
    for (const auto& [anchor, limit] : candidates_) {
        bool known = !anchors.empty() && anchors.back().vertex == anchor.vertex && !is_of_vertex(anchor.weight);
        for (std::size_t i = anchors.size(); i-- > 0 && is_of_vertex(anchor.weight) && anchors[i].vertex[0] == anchor.vertex[0];)
            known = known || anchors[i].normal.dot(anchor.normal) >= min_anchor_cosine;
        if (!known) anchors.push_back(anchor);
    }
}

}  // namespace percale
