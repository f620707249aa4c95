#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef PERCALE_HAS_PICTURES
#include <stb/stb_image.h>
#endif

#include "report/image.h"
#include "tests/support/catch.h"
#include "tests/support/skip.h"

namespace percale::scenes::test {

/// Whether this build draws; says that the test is skipped where it does not.
inline bool draws() {
    if (pictures_missing().empty()) return true;
    percale::test::skip(pictures_missing());
    return false;
}

struct PngPixels {
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint8_t> bytes = {};

    const std::uint8_t* at(int column, int row) const {
        const std::size_t number =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
        return bytes.data() + static_cast<std::size_t>(channels) * number;
    }
};

#ifdef PERCALE_HAS_PICTURES
/// What stb_image reads of a file's bytes, after a look at the header. Throws where it is no PNG.
inline PngPixels read_png(const std::string& file) {
    if (file.substr(0, 8) != "\x89PNG\r\n\x1a\n" || file.substr(12, 4) != "IHDR" || file.size() < 33)
        throw std::runtime_error("no PNG");
    PngPixels png;
    std::uint8_t* pixels = stbi_load_from_memory(reinterpret_cast<const std::uint8_t*>(file.data()),
                                                 static_cast<int>(file.size()), &png.width, &png.height, &png.channels, 0);
    if (pixels == nullptr) throw std::runtime_error(stbi_failure_reason());
    const auto count =
        static_cast<std::size_t>(png.width) * static_cast<std::size_t>(png.height) * static_cast<std::size_t>(png.channels);
    png.bytes.assign(pixels, pixels + count);
    stbi_image_free(pixels);
    if (file.at(25) != (png.channels == 3 ? 2 : 6)) throw std::runtime_error("another kind of pixels than the header says");
    return png;
}
#else
inline PngPixels read_png(const std::string&) { throw std::runtime_error(pictures_missing()); }
#endif

}  // namespace percale::scenes::test
