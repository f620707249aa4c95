#include "report/colour.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "percale/error.h"

namespace percale::scenes {

namespace {

Colour colour_of_number(std::uint32_t number) {
    const auto channel = [&](int shift) { return linear_of_srgb(static_cast<float>((number >> shift) & 0xffu) / 255.0f); };
    return {channel(16), channel(8), channel(0)};
}

constexpr std::uint32_t cloth_colours[] = {0xb23a34, 0x3a6ea5, 0xe0a83a, 0x5a9a68, 0x8459a0, 0xd9703a, 0x3a9ea0, 0xb05a80};
constexpr std::uint32_t body_colours[] = {0xcbbbac, 0xa9b4be, 0xb8bfa6, 0xbfaebd};
constexpr std::uint32_t rising_colours[] = {0x3f3f98, 0x3f6bb2, 0x3a96a8, 0x4bb488, 0xa2d062, 0xf7e75c};
constexpr std::uint32_t diverging_colours[] = {0x1f4e9c, 0x6d9fd0, 0xf2f0eb, 0xe08a68, 0xa3202c};

/// Full colours around the circle; the golden section keeps neighbours in the list apart.
Colour colour_of_hue(std::size_t number) {
    const double hue = 6.0 * std::fmod(0.618033988749895 * static_cast<double>(number), 1.0);
    const auto channel = [&](double centre) {
        const double off = std::abs(std::remainder(hue - centre, 6.0));
        return linear_of_srgb(static_cast<float>(0.28 + 0.5 * std::clamp(2.0 - off, 0.0, 1.0)));
    };
    return {channel(0.0), channel(2.0), channel(4.0)};
}

/// Between the two nearest of evenly spaced colours, as they are encoded, where equal steps look equal.
Colour between_colours(std::span<const std::uint32_t> colours, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(place), colours.size() - 2);
    const float part = static_cast<float>(place - static_cast<double>(low));
    Colour mixed;
    for (int k = 0; k < 3; ++k) {
        const auto encoded = [&](std::uint32_t number) { return static_cast<float>((number >> (16 - 8 * k)) & 0xffu) / 255.0f; };
        mixed[k] = linear_of_srgb((1.0f - part) * encoded(colours[low]) + part * encoded(colours[low + 1]));
    }
    return mixed;
}

}  // namespace

float linear_of_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_of_linear(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

std::array<std::uint8_t, 3> srgb_bytes(const Colour& colour) {
    std::array<std::uint8_t, 3> bytes{};
    for (int k = 0; k < 3; ++k) {
        const float encoded = srgb_of_linear(std::clamp(colour[k], 0.0f, 1.0f));
        bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255.0f * encoded));
    }
    return bytes;
}

Colour colour_of_hex(const std::string& digits) {
    if (digits.size() != 6 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw SceneError("'" + digits + "' is no colour; a colour is six hexadecimal digits RRGGBB, as b5403a");
    return colour_of_number(static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16)));
}

Colour cloth_colour(std::size_t number) {
    return number < std::size(cloth_colours) ? colour_of_number(cloth_colours[number]) : colour_of_hue(number);
}

Colour body_colour(std::size_t number) { return colour_of_number(body_colours[number % std::size(body_colours)]); }

Colour ramp_colour(double share, bool diverging) {
    return diverging ? between_colours(diverging_colours, share) : between_colours(rising_colours, share);
}

}  // namespace percale::scenes
