#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace percale::scenes {

/// Why this build makes no pictures, as a message; "" if it does.
inline std::string pictures_missing() {
#ifdef PERCALE_HAS_PICTURES
    return {};
#else
    return "this build has no pictures: libembree-dev or libstb-dev was not found when it was configured";
#endif
}

/// Red, green, blue as sRGB encodes them.
using Bytes3 = std::array<std::uint8_t, 3>;

/// Rows from the top, pixels from the left, four bytes each: red, green, blue as sRGB encodes them, and how opaque, 255 wholly.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba = {};

    /// Wholly transparent.
    Image(int columns, int rows);
    std::uint8_t* at(int column, int row);
    const std::uint8_t* at(int column, int row) const;
};

/// Blends the colour over what is there: `cover` 0 ... 1. Outside the image nothing happens.
void blend(Image& image, int column, int row, const Bytes3& colour, float cover);

/// Replaces what is there. Throws SceneError where a part would lie outside.
void paste(Image& onto, const Image& part, int left, int top);

/// Writes it as PNG of 8 bits a channel, RGB if all of it is opaque, else RGBA; whole or not at all. Throws SceneError naming
/// the file if it cannot be written. Needs libstb (pictures_missing).
void write_png(const std::string& file, const Image& image);

}  // namespace percale::scenes
