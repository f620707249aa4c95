#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace percale::scenes {

/// The units of length that files of meshes and patterns are in.
inline constexpr std::array<std::string_view, 5> length_unit_words = {"mm", "cm", "dm", "m", "inch"};
/// The length of each unit in that order, m.
inline constexpr std::array<double, 5> length_unit_metres = {0.001, 0.01, 0.1, 1.0, 0.0254};

/// The length of a unit, m; nothing for a word that is none of them.
inline std::optional<double> metres_of_unit(std::string_view word) {
    const auto found = std::ranges::find(length_unit_words, word);
    if (found == length_unit_words.end()) return std::nullopt;
    return length_unit_metres[static_cast<std::size_t>(found - length_unit_words.begin())];
}

}  // namespace percale::scenes
