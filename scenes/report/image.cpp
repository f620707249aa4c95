#include "report/image.h"

#ifdef PERCALE_HAS_PICTURES
#include <stb/stb_image_write.h>
#endif

#include <algorithm>
#include <cmath>

#include "common/whole_file.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

#ifdef PERCALE_HAS_PICTURES
bool is_opaque(const Image& image) {
    for (std::size_t k = 3; k < image.rgba.size(); k += 4)
        if (image.rgba[k] != 255) return false;
    return true;
}

std::vector<std::uint8_t> without_alpha(const Image& image) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t k = 0; k < image.rgba.size(); k += 4)
        rgb.insert(rgb.end(), image.rgba.begin() + static_cast<std::ptrdiff_t>(k),
                   image.rgba.begin() + static_cast<std::ptrdiff_t>(k) + 3);
    return rgb;
}

void append_bytes(void* text, void* bytes, int count) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(count));
}

std::string png_bytes(const Image& image) {
    const bool opaque = is_opaque(image);
    const std::vector<std::uint8_t> rgb = opaque ? without_alpha(image) : std::vector<std::uint8_t>();
    const int channels = opaque ? 3 : 4;
    std::string bytes;
    if (stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, channels, opaque ? rgb.data() : image.rgba.data(),
                               channels * image.width) == 0)
        throw SceneError("the picture of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                         " pixels cannot be made into a PNG");
    return bytes;
}
#endif

}  // namespace

Image::Image(int columns, int rows)
    : width(columns), height(rows), rgba(4 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

std::uint8_t* Image::at(int column, int row) {
    return rgba.data() + 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column));
}

const std::uint8_t* Image::at(int column, int row) const { return const_cast<Image*>(this)->at(column, row); }

void blend(Image& image, int column, int row, const Bytes3& colour, float cover) {
    if (column < 0 || row < 0 || column >= image.width || row >= image.height || cover <= 0.0f) return;
    std::uint8_t* pixel = image.at(column, row);
    const float under = (1.0f - cover) * static_cast<float>(pixel[3]) / 255.0f, whole = cover + under;
    for (std::size_t k = 0; k < 3; ++k)
        pixel[k] = static_cast<std::uint8_t>(
            std::lround((cover * static_cast<float>(colour[k]) + under * static_cast<float>(pixel[k])) / whole));
    pixel[3] = static_cast<std::uint8_t>(std::lround(255.0f * std::min(whole, 1.0f)));
}

void paste(Image& onto, const Image& part, int left, int top) {
    if (left < 0 || top < 0 || left + part.width > onto.width || top + part.height > onto.height)
        throw SceneError("a part of a picture does not fit into it");
    for (int row = 0; row < part.height; ++row)
        std::copy_n(part.at(0, row), 4 * static_cast<std::size_t>(part.width), onto.at(left, top + row));
}

#ifdef PERCALE_HAS_PICTURES
void write_png(const std::string& file, const Image& image) { write_whole_file(file, png_bytes(image)); }
#else
void write_png(const std::string&, const Image&) { throw SceneError(pictures_missing()); }
#endif

}  // namespace percale::scenes
