#pragma once

#include <span>
#include <string>
#include <string_view>

namespace percale::scenes {

/// Letters to insert, delete, replace or swap with their neighbour to turn `a` into `b`; upper and lower case count as equal.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance, the first of equals; "" if there are none.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'x'? valid: x, y, z", or "" without candidates.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

}  // namespace percale::scenes
