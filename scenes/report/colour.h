#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace percale::scenes {

/// Red, green, blue in linear light, of the primaries of sRGB; 1 is white.
using Colour = Eigen::Vector3f;

/// One channel as IEC 61966-2-1 encodes it, 0 ... 1, to linear light and back.
float linear_of_srgb(float encoded);
float srgb_of_linear(float linear);

/// The bytes for a PNG; values beyond 0 ... 1 become the nearest one that it can hold.
std::array<std::uint8_t, 3> srgb_bytes(const Colour& colour);

/// "b5403a". Throws SceneError for what is not six hexadecimal digits.
Colour colour_of_hex(const std::string& digits);

/// The colour of the number-th cloth or body of a picture. Most people can distinguish the first eight; further ones differ by
/// hue.
Colour cloth_colour(std::size_t number);
Colour body_colour(std::size_t number);

/// The colour of a value of a field at a fraction `share`, 0 ... 1, of the range shown: from dark blue over green to yellow, ever
/// lighter; `diverging`: blue to red, white in the middle.
Colour ramp_colour(double share, bool diverging);

}  // namespace percale::scenes
