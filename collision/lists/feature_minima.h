#pragma once

#include <cstddef>
#include <vector>

#include "percale/contact.h"

namespace percale {

/// Says which contact constraints of one cloth feature with one obstacle are minima of the distance now. A constraint of a vertex
/// that is only persistent, because it was a minimum since the last update of the candidates, is left out where a minimum in
/// nearly the same direction has taken its place: where a vertex passes from face to face their distances agree, and both
/// together would push it twice. So would both faces at the edge between them, which rounding takes for the inside of either: of
/// two constraints at one place the first stays. All constraints of edges and faces stay: contacts of other features take their
/// place where they end.
class FeatureMinima {
public:
    /// Only constraints behind these are examined.
    void begin(const ContactConstraints& constraints);
    /// A constraint was added.
    void add(bool minimum) { minimum_.push_back(minimum ? 1 : 0); }
    /// The constraints added since the last call are all those of one feature: leaves out those whose place is taken.
    void next_feature(ContactConstraints& constraints);

private:
    bool is_taken(const ContactConstraints& constraints, std::size_t i) const;

    std::size_t first_ = 0;  // constraint of the feature
    std::vector<unsigned char> minimum_;
};

}  // namespace percale
