#pragma once

#include <cstddef>
#include <vector>

#include "percale/contact.h"

namespace percale {

/// Of the rows of one cloth feature with one obstacle: which are minima of the distance now. Of a vertex, one that only stands,
/// because it was a minimum since the last refresh, is left out where a minimum in nearly the same direction has taken its place:
/// where a vertex passes from face to face their distances agree, and both together would push it twice. So would both faces
/// at the edge between them, which rounding takes for inside of either: of two at one place the first one stays. Of edges and
/// faces all stay: what takes their place where they end are contacts of other features.
class FeatureMinima {
public:
    /// What comes behind these rows is looked at.
    void begin(const ContactRows& rows);
    /// A row was added.
    void add(bool minimum) { minimum_.push_back(minimum ? 1 : 0); }
    /// The rows added since the last feature are all of theirs: leaves out those whose place is taken.
    void next_feature(ContactRows& rows);

private:
    bool is_taken(const ContactRows& rows, std::size_t i) const;

    std::size_t first_ = 0;  // row of the feature
    std::vector<unsigned char> minimum_;
};

}  // namespace percale
