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

/// What a PNG holds; beyond 0 ... 1 the nearest that it can.
std::array<std::uint8_t, 3> srgb_bytes(const Colour& colour);

/// "b5403a". Throws SceneError for what is not six hexadecimal digits.
Colour colour_of_hex(const std::string& digits);

/// Of the number-th cloth or body of a picture. The first eight are told apart by most eyes, further ones by hue.
Colour cloth_colour(std::size_t number);
Colour body_colour(std::size_t number);

/// Of a value of a field at a share, 0 ... 1, of the range shown. From dark blue over green to yellow, ever lighter; `diverging`:
/// blue to red, white in the middle.
Colour ramp_colour(double share, bool diverging);

}  // namespace percale::scenes
