#pragma once

#include <span>
#include <string>
#include <string_view>

namespace percale::scenes {

/// Letters to insert, delete, replace or swap with their neighbour to turn `a` into `b`; upper and lower case count as equal.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance, the first of equals. It must look like a slip: at most 2 edits or a third of
/// the name's letters, whichever is more, and not every letter of both. "" if there is none.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'x'?", or "" if no candidate is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'x'? valid: x, y, z", "; valid: x, y, z" if none is near, or "" without candidates.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

}  // namespace percale::scenes
