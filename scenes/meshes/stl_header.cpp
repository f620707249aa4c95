#include "meshes/stl_header.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "common/input_file.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

/// Whether text in wide characters begins with "solid". A binary title may hold anything.
bool is_wide_text(std::string_view start) {
    std::string letters;
    for (const char byte : start.substr(0, 12))
        if (byte > 0) letters += byte;
    return letters.starts_with("solid") && start.substr(0, 12).find('\0') != std::string_view::npos;
}

}  // namespace

/// Binary STL: 80 bytes of title, a 32-bit count, 50 bytes a triangle. Text files start with "solid" and have no counts; a binary
/// title may start so, too, and is recognised by its size.
void check_stl_header(const std::string& file) {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SceneError(file, std::string("cannot be read: ") + std::strerror(errno));
    char start[84] = {};
    in.read(start, sizeof start);
    const std::string_view begins(start, static_cast<std::size_t>(in.gcount()));
    if (is_wide_text(begins)) encoding_mark(begins, file);
    const bool says_solid = begins.starts_with("solid");
    if (in.gcount() < static_cast<std::streamsize>(sizeof start)) {
        if (says_solid) return;
        throw SceneError(file, "not an STL file: " + std::to_string(in.gcount()) + " bytes are less than its header");
    }
    std::uint32_t count = 0;
    for (int k = 3; k >= 0; --k) count = count << 8 | static_cast<unsigned char>(start[80 + k]);
    in.seekg(0, std::ios::end);
    const std::streamoff max = (in.tellg() - static_cast<std::streamoff>(sizeof start)) / 50;
    if (count > max && !says_solid)
        throw SceneError(file, "the header claims " + std::to_string(count) + " triangles, but the file can hold " +
                                   std::to_string(max) + " at most");
}

}  // namespace percale::scenes
