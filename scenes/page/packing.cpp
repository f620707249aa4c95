#include "page/packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percale::scenes {

namespace {

constexpr std::string_view base64_letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr double largest_packed = packed_absent - 1;

}  // namespace

PackRange range_of(std::span<const float> values) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float value : values) {
        if (!std::isfinite(value)) continue;
        low = std::min<double>(low, value);
        high = std::max<double>(high, value);
    }
    if (!(low <= high)) return {};
    return {low, (high - low) / largest_packed};
}

std::uint16_t packed(double value, const PackRange& range) {
    if (!std::isfinite(value)) return packed_absent;
    if (range.step == 0.0) return 0;
    // Rounding may lead a hair beyond the ends of the range.
    return static_cast<std::uint16_t>(std::clamp(std::round((value - range.low) / range.step), 0.0, largest_packed));
}

std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

std::string base64(std::string_view bytes) {
    std::string text;
    text.reserve(base64_size(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? base64_letters[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

}  // namespace percale::scenes
