#include "geometry/morton_order.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "geometry/box.h"

namespace percale {
namespace {

/// Spreads the lowest 20 bits to every third bit.
std::uint64_t spread(std::uint64_t x) {
    std::uint64_t result = 0;
    for (int bit = 0; bit < 20; ++bit) result |= (x >> bit & 1U) << (3 * bit);
    return result;
}

std::vector<std::uint64_t> morton_codes(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    // The box holds these triangles alone: other vertices would move the cells of the curve, and pieces of it would be less
    // compact.
    Box box;
    for (const Triangle& triangle : triangles) {
        for (const int v : triangle) box.add(positions[v]);
    }
    constexpr double max = 1048575.0;
    const double extent = std::max((box.high - box.low).maxCoeff(), 1e-300);
    std::vector<std::uint64_t> codes;
    for (const auto& [a, b, c] : triangles) {
        const Vec3 place = ((positions[a] + positions[b] + positions[c]) / 3.0 - box.low) / extent * max;
        const Vec3 centre = place.cwiseMax(0.0).cwiseMin(max);  // by rounding it may lie outside, far if all points coincide
        codes.push_back(spread(static_cast<std::uint64_t>(centre.x())) | spread(static_cast<std::uint64_t>(centre.y())) << 1 |
                        spread(static_cast<std::uint64_t>(centre.z())) << 2);
    }
    return codes;
}

}  // namespace

std::vector<int> morton_order(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    const std::vector<std::uint64_t> codes = morton_codes(triangles, positions);
    std::vector<int> order(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return codes[a] < codes[b]; });
    return order;
}

}  // namespace percale
