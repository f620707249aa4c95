#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// Numbers of a playback in two bytes each, and bytes as text.
namespace percale::scenes {

/// The number for a value that is not finite.
inline constexpr std::uint16_t packed_absent = 65535;

/// value = low + step * number, with whole numbers 0 ... 65534; step 0 where all values are equal.
struct PackRange {
    double low = 0.0, step = 0.0;
};

/// The range from the smallest to the largest finite value; 0 without any.
PackRange range_of(std::span<const float> values);

/// The nearest number for a value of the range, off by half a step at most; packed_absent where it is not finite.
std::uint16_t packed(double value, const PackRange& range);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);
/// The number of letters of so many bytes in base64.
std::size_t base64_size(std::size_t bytes);

}  // namespace percale::scenes
