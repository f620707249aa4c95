#include "mesh_header.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <istream>
#include <vector>

#include "text_scan.h"

namespace percale::scenes {

namespace {

struct PlyElement {
    std::string name;
    unsigned long long count = 0;
    unsigned long long least_bytes = 0;  // of one element
    unsigned long long properties = 0;
};

struct PlyHeader {
    bool text = false;
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

void read_property(std::string_view line, const TextPlace& place, PlyHeader& header) {
    if (header.elements.empty()) fail_at(place, "a property before the first element");
    std::string_view type = next_word(line);
    if (type == "list") type = next_word(line);  // an empty list is its count alone
    header.elements.back().least_bytes += type_bytes(type, place);
    header.elements.back().properties += 1;
}

void read_header_line(std::string_view line, const TextPlace& place, PlyHeader& header) {
    const std::string_view keyword = next_word(line);
    if (keyword == "format") header.text = next_word(line) == "ascii";
    if (keyword == "property") read_property(line, place, header);
    if (keyword != "element") return;
    const std::string name(next_word(line));
    const long long count = to_integer(next_word(line), place, "element count");
    if (count < 0) fail_at(place, "element count is " + std::to_string(count));
    header.elements.push_back({name, static_cast<unsigned long long>(count)});
}

PlyHeader read_ply_header(std::istream& in, const std::string& name) {
    PlyHeader header;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        std::string_view words = line;
        const std::string_view keyword = next_word(words);
        if (number == 1 && keyword != "ply") fail_at({name, number}, "not a PLY file: it starts with " + shown(keyword));
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

void check_ply(std::istream& in, const std::string& file) {
    const PlyHeader header = read_ply_header(in, file);
    unsigned long long left = room(in, header.text);
    for (const PlyElement& element : header.elements) {
        if (element.properties == 0 || element.count == 0) continue;
        const unsigned long long each = header.text ? 1 : element.least_bytes;
        if (element.count > left / each)
            fail_claim(file, std::to_string(element.count) + " elements \"" + element.name + "\"", left / each);
        left -= element.count * each;
    }
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
