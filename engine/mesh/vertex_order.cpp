#include "vertex_order.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace percale {
namespace {

/// Bits of each axis along the curve that orders the vertices; three axes fit into 63. Fewer: vertices of a fine mesh share a
/// cell and keep their order. Cost alone.
constexpr int curve_key_bits = 20;

/// Vertices along the curve that are sorted by their springs: 16 slices, 8 KB of positions. More: neighbours lie farther apart
/// in memory. Fewer: more padding. Cost alone.
constexpr std::size_t vertex_sorting_window = 256;

using Cell = std::array<std::uint32_t, 3>;

/// The bits of the three numbers in turn, the highest ones first.
std::uint64_t interleave(const Cell& cell) {
    std::uint64_t key = 0;
    for (int bit = curve_key_bits; bit-- > 0;) {
        for (const std::uint32_t number : cell) key = key << 1 | (number >> bit & 1U);
    }
    return key;
}

/// The distance of a cell along the Hilbert curve (J. Skilling, "Programming the Hilbert curve", 2004): from the coarsest level
/// down, each half cube's reflections and exchanges of axes are undone in all finer levels; the octant numbers then are a Gray
/// code.
std::uint64_t curve_key(Cell cell) {
    constexpr std::uint32_t top = 1U << (curve_key_bits - 1);
    for (std::uint32_t level = top; level > 1; level >>= 1) {
        const std::uint32_t finer = level - 1;
        for (std::uint32_t& number : cell) {
            const std::uint32_t change = (number & level) != 0 ? finer : 0U;
            const std::uint32_t exchange = (number & level) != 0 ? 0U : (cell[0] ^ number) & finer;
            cell[0] ^= change | exchange;
            number ^= exchange;
        }
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    std::uint32_t carry = 0;
    for (std::uint32_t level = top; level > 1; level >>= 1) {
        if ((cell[2] & level) != 0) carry ^= level - 1;
    }
    for (std::uint32_t& number : cell) number ^= carry;
    return interleave(cell);
}

std::vector<std::uint64_t> curve_keys(std::span<const Vec3> points) {
    Vec3 low = points[0], high = points[0];
    for (const Vec3& x : points) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const double scale = ((1U << curve_key_bits) - 1U) / std::max((high - low).maxCoeff(), 1e-300);
    std::vector<std::uint64_t> keys;
    for (const Vec3& x : points) {
        const Vec3 at = scale * (x - low);
        keys.push_back(curve_key(
            {static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.z()), static_cast<std::uint32_t>(at.y())}));
    }
    return keys;
}

}  // namespace

std::vector<int> along_curve(std::span<const Vec3> points) {
    const std::vector<std::uint64_t> keys = curve_keys(points);
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
    return order;
}

VertexOrder memory_order(std::span<const Vec3> rest, std::span<const int> springs) {
    VertexOrder order{.place = std::vector<int>(rest.size()), .vertex = along_curve(rest)};
    for (std::size_t from = 0; from < rest.size(); from += vertex_sorting_window) {
        const auto first = order.vertex.begin() + static_cast<long>(from);
        const auto last = order.vertex.begin() + static_cast<long>(std::min(rest.size(), from + vertex_sorting_window));
        std::stable_sort(first, last, [&](int a, int b) { return springs[a] > springs[b]; });
    }
    for (std::size_t at = 0; at < rest.size(); ++at) order.place[order.vertex[at]] = static_cast<int>(at);
    return order;
}

}  // namespace percale
