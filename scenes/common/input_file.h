#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace percale::scenes {

/// A file to read, in binary mode; it has failed where there is none or it may not be read (errno says why). Throws SceneError
/// naming the file where it is a folder, a device or a pipe, which may give bytes for ever, or none.
std::ifstream open_input(const std::string& file);

/// How many of a text's first bytes say that it is UTF-8 (its byte-order mark): 3 or 0. Throws SceneError naming the file where
/// they say that it is UTF-16 or UTF-32, by a mark or by a zero beside each of the first two letters.
std::size_t encoding_mark(std::string_view beginning, const std::string& file);

/// Throws SceneError naming the file if it cannot be read.
std::vector<std::byte> read_bytes(const std::string& file);
/// The same as a text; without the byte-order mark that a UTF-8 text may begin with.
std::string read_text(const std::string& file);

}  // namespace percale::scenes
