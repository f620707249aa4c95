#include "common/input_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace {

std::string reason() { return std::strerror(errno != 0 ? errno : EIO); }

/// Whether a text begins with two letters that have a zero behind or before each of them, as only one of wide characters does.
bool begins_wide(std::string_view text) {
    if (text.size() < 4) return false;
    const auto zeros = [&](std::size_t at) { return text[at] == 0 && text[at + 2] == 0; };
    const auto letters = [&](std::size_t at) { return text[at] > 0 && text[at + 2] > 0; };
    return (zeros(0) && letters(1)) || (zeros(1) && letters(0));
}

}  // namespace

std::ifstream open_input(const std::string& file) {
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::status(file, error).type();
    if (type == std::filesystem::file_type::directory) throw SceneError(file, "cannot be read: it is a folder");
    const bool there = type != std::filesystem::file_type::not_found && type != std::filesystem::file_type::none;
    if (there && type != std::filesystem::file_type::regular)
        throw SceneError(file, "cannot be read: it is a device or a pipe, not a file");
    errno = 0;
    return std::ifstream(file, std::ios::binary);
}

std::size_t encoding_mark(std::string_view beginning, const std::string& file) {
    const bool marked = beginning.starts_with("\xFF\xFE") || beginning.starts_with("\xFE\xFF") ||
                        beginning.starts_with(std::string_view("\0\0\xFE\xFF", 4));
    if (marked || begins_wide(beginning)) throw SceneError(file, "is UTF-16 or UTF-32 text; save it as UTF-8");
    return beginning.starts_with("\xEF\xBB\xBF") ? 3 : 0;
}

std::vector<std::byte> read_bytes(const std::string& file) {
    std::ifstream in = open_input(file);
    if (!in) throw SceneError(file, "cannot be read: " + reason());
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) throw SceneError(file, "cannot be read: " + error.message());
    std::vector<std::byte> bytes(size);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
        throw SceneError(file, "cannot be read: " + reason());
    return bytes;
}

std::string read_text(const std::string& file) {
    const std::vector<std::byte> bytes = read_bytes(file);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    text.remove_prefix(encoding_mark(text, file));
    return std::string(text);
}

}  // namespace percale::scenes
