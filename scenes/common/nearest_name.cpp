#include "common/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "common/text.h"

namespace percale::scenes {
namespace {

bool same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

// Optimal string alignment: d(i, j) = min(d(i-1, j) + 1, d(i, j-1) + 1, d(i-1, j-1) + [a_i != b_j], swap: d(i-2, j-2) + 1)
int edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<int> table((a.size() + 1) * width);
    const auto d = [&](std::size_t i, std::size_t j) -> int& { return table[i * width + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) d(i, 0) = static_cast<int>(i);
    for (std::size_t j = 0; j <= b.size(); ++j) d(0, j) = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replaced = d(i - 1, j - 1) + (same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
            d(i, j) = std::min({d(i - 1, j) + 1, d(i, j - 1) + 1, replaced});
            const bool swapped = i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]);
            if (swapped) d(i, j) = std::min(d(i, j), d(i - 2, j - 2) + 1);
        }
    }
    return d(a.size(), b.size());
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
    std::string nearest;
    int smallest = static_cast<int>(std::max<std::size_t>(2, name.size() / 3)) + 1;
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(name, candidate);
        if (distance >= smallest || distance >= static_cast<int>(std::max(name.size(), candidate.size()))) continue;
        smallest = distance;
        nearest = candidate;
    }
    return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
    const std::string nearest = nearest_name(name, candidates);
    return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string suggestion(std::string_view name, std::span<const std::string> candidates) {
    if (candidates.empty()) return "";
    const std::string nearest = did_you_mean(name, candidates);
    return (nearest.empty() ? ";" : nearest) + " valid: " + joined(candidates);
}

}  // namespace percale::scenes
