#include "mesh_header.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <istream>
#include <iterator>
#include <limits>
#include <vector>

#include "text_scan.h"

namespace percale::scenes {

namespace {

struct PlyProperty {
    unsigned long long count_bytes = 0;  // of a list's length; 0: no list
    unsigned long long item_bytes = 0;
};

struct PlyElement {
    std::string name;
    unsigned long long count = 0;
    unsigned long long least_bytes = 0;  // of one element
    std::vector<PlyProperty> properties = {};
};

struct PlyHeader {
    bool has_format = false, text = false, big_endian = false;
    std::vector<PlyElement> elements;
};

unsigned long long type_bytes(std::string_view type, const TextPlace& place) {
    const auto is_any = [&](std::initializer_list<std::string_view> names) {
        return std::find(names.begin(), names.end(), type) != names.end();
    };
    if (is_any({"char", "uchar", "int8", "uint8"})) return 1;
    if (is_any({"short", "ushort", "int16", "uint16"})) return 2;
    if (is_any({"int", "uint", "int32", "uint32", "float", "float32"})) return 4;
    if (is_any({"double", "float64"})) return 8;
    fail_at(place, "unknown PLY type " + shown(type));
}

/// Of an element or a property. Other readers skip what does not begin like a name.
std::string read_name(std::string_view& line, const TextPlace& place) {
    const std::string_view name = next_word(line);
    const char first = name.empty() ? ' ' : name[0];
    if ((first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z') || first == '_') return std::string(name);
    fail_at(place, "a name must begin with a letter, not " + shown(name));
}

void check_end(std::string_view line, const TextPlace& place) {
    const std::string_view word = next_word(line);
    if (!word.empty()) fail_at(place, "more than belongs on this line of a PLY header: " + shown(word));
}

void read_property(std::string_view line, const TextPlace& place, PlyHeader& header) {
    if (header.elements.empty()) fail_at(place, "a property before the first element");
    PlyProperty property;
    std::string_view type = next_word(line);
    if (type == "list") {
        type = next_word(line);
        property.count_bytes = type_bytes(type, place);
        if (type.starts_with("float") || type.starts_with("double"))
            fail_at(place, "the length of a list must be a whole number, not a " + shown(type));
        type = next_word(line);
    }
    property.item_bytes = type_bytes(type, place);
    read_name(line, place);
    check_end(line, place);
    PlyElement& element = header.elements.back();
    // An empty list is its count alone.
    element.least_bytes += property.count_bytes > 0 ? property.count_bytes : property.item_bytes;
    element.properties.push_back(property);
}

bool is_free_text(std::string_view keyword) { return keyword == "comment" || keyword == "obj_info"; }

/// Other readers take a line to end at a control character.
void check_letters(std::string_view line, std::string_view keyword, const TextPlace& place) {
    for (const char letter : line) {
        const auto code = static_cast<unsigned char>(letter);
        if ((code >= ' ' || letter == '\t' || letter == '\r') && (code <= '~' || is_free_text(keyword))) continue;
        fail_at(place, "a character in the header of a PLY file that is no text: code " + std::to_string(code));
    }
}

void read_format(std::string_view format, const TextPlace& place, PlyHeader& header) {
    constexpr std::array<std::string_view, 3> known = {"ascii", "binary_little_endian", "binary_big_endian"};
    if (std::find(known.begin(), known.end(), format) == known.end()) fail_at(place, "unknown PLY format " + shown(format));
    if (header.has_format) fail_at(place, "a second format");
    header.has_format = true;
    header.text = format == known[0];
    header.big_endian = format == known[2];
}

void read_header_line(std::string_view line, const TextPlace& place, PlyHeader& header) {
    const std::string_view keyword = next_word(line);
    if (keyword == "ply" || is_free_text(keyword) || keyword.empty()) return;
    if (keyword == "property") return read_property(line, place, header);
    if (keyword == "format") return read_format(next_word(line), place, header);
    if (keyword != "element") fail_at(place, "unknown word in the header of a PLY file: " + shown(keyword));
    const std::string name = read_name(line, place);
    const long long count = to_integer(next_word(line), place, "element count");
    if (count < 0) fail_at(place, "element count is " + std::to_string(count));
    check_end(line, place);
    header.elements.push_back({name, static_cast<unsigned long long>(count)});
}

PlyHeader read_ply_header(std::istream& in, const std::string& name) {
    PlyHeader header;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        std::string_view words = line;
        const std::string_view keyword = next_word(words);
        if (number == 1 && keyword != "ply") fail_at({name, number}, "not a PLY file: it starts with " + shown(keyword));
        check_letters(line, keyword, {name, number});
        if (keyword == "end_header") return header;
        read_header_line(line, {name, number}, header);
    }
    throw SceneError(name + ": not a PLY file: its header has no end");
}

[[noreturn]] void fail_claim(const std::string& file, const std::string& claim, unsigned long long most) {
    throw SceneError(file + ": the header claims " + claim + ", but the file can hold " + std::to_string(most) + " at most");
}

/// Text: one element a line. Returns the bytes or lines that are left for the elements.
unsigned long long room(std::istream& in, bool text) {
    unsigned long long count = 0;
    if (text) {
        for (std::string line; std::getline(in, line);) count += line.find_first_not_of(" \t\r") != std::string::npos ? 1 : 0;
        return count;
    }
    const auto start = in.tellg();
    in.seekg(0, std::ios::end);
    return static_cast<unsigned long long>(in.tellg() - start);
}

void check_counts(const PlyHeader& header, unsigned long long left, const std::string& file) {
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty() || element.count == 0) continue;
        const unsigned long long each = header.text ? 1 : element.least_bytes;
        if (element.count > left / each)
            fail_claim(file, std::to_string(element.count) + " elements \"" + element.name + "\"", left / each);
        left -= element.count * each;
    }
}

/// What stands behind a PLY header, read from front to back.
struct PlyBody {
    const PlyHeader& header;
    std::string bytes;
    std::string_view rest;

    /// How long a list is that begins here.
    unsigned long long length(const PlyProperty& list) {
        if (header.text) {
            const std::string_view word = next_word(rest);
            unsigned long long count = 0;
            const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), count);
            return status == std::errc() && end == word.data() + word.size() ? count : most();
        }
        unsigned long long count = 0;
        for (std::size_t k = 0; k < list.count_bytes; ++k) {
            const std::size_t at = header.big_endian ? k : list.count_bytes - 1 - k;
            count = count << 8 | static_cast<unsigned char>(rest[at]);
        }
        rest.remove_prefix(list.count_bytes);
        return count;
    }

    /// Leaves out values; false if there are not so many.
    bool skip(unsigned long long count, unsigned long long bytes_each) {
        if (count > rest.size() / (header.text ? 1 : bytes_each)) return false;
        if (!header.text) rest.remove_prefix(count * bytes_each);
        for (unsigned long long k = 0; header.text && k < count; ++k) {
            if (next_word(rest).empty()) return false;
        }
        return true;
    }

    static unsigned long long most() { return std::numeric_limits<unsigned long long>::max(); }

    bool skip(const PlyProperty& property) {
        if (property.count_bytes == 0) return skip(1, property.item_bytes);
        if (rest.size() < (header.text ? 1 : property.count_bytes)) return false;
        return skip(length(property), property.item_bytes);
    }
};

/// Lists must not be longer than the file, or reading them takes any time and memory.
void check_lists(std::istream& in, const PlyHeader& header, const std::string& file) {
    PlyBody body{header, {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}, {}};
    if (header.text) std::replace(body.bytes.begin(), body.bytes.end(), '\n', ' ');
    body.rest = body.bytes;
    for (const PlyElement& element : header.elements) {
        for (unsigned long long k = 0; k < (element.properties.empty() ? 0 : element.count); ++k) {
            const auto fits = [&](const PlyProperty& property) { return body.skip(property); };
            if (std::all_of(element.properties.begin(), element.properties.end(), fits)) continue;
            throw SceneError(file + ": the file ends within element \"" + element.name + "\" " + std::to_string(k));
        }
    }
}

void check_ply(std::istream& in, const std::string& file) {
    const PlyHeader header = read_ply_header(in, file);
    const auto start = in.tellg();
    const unsigned long long left = room(in, header.text);
    in.clear();
    in.seekg(start);
    check_counts(header, left, file);
    check_lists(in, header, file);
}

/// Binary STL: 80 bytes of title, a 32-bit count, 50 bytes a triangle. Text files start with "solid" and have no counts; a binary
/// title may start so, too, and is told by its size.
void check_stl(std::istream& in, const std::string& file) {
    char start[84] = {};
    in.read(start, sizeof start);
    const bool says_solid = std::string_view(start, sizeof start).starts_with("solid");
    if (in.gcount() < static_cast<std::streamsize>(sizeof start)) {
        if (says_solid) return;
        throw SceneError(file + ": not an STL file: " + std::to_string(in.gcount()) + " bytes are less than its header");
    }
    std::uint32_t count = 0;
    for (int k = 3; k >= 0; --k) count = count << 8 | static_cast<unsigned char>(start[80 + k]);
    const unsigned long long most = room(in, false) / 50;
    if (count > most && !says_solid) fail_claim(file, std::to_string(count) + " triangles", most);
}

}  // namespace

void check_mesh_header(const std::string& file, const std::string& extension) {
    if (extension != ".ply" && extension != ".stl") return;
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SceneError(file + ": cannot be read: " + std::strerror(errno));
    if (extension == ".ply") check_ply(in, file);
    if (extension == ".stl") check_stl(in, file);
}

}  // namespace percale::scenes
