#include "frames/obj_layout.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/input_file.h"
#include "meshes/obj_file.h"
#include "meshes/text_scan.h"

namespace percale::scenes {

namespace fs = std::filesystem;

namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// What follows the coordinates of a vertex: its weight or its colour.
std::string behind_coordinates(std::string_view line) {
    for (int k = 0; k < 3; ++k) next_word(line);
    return std::string(trimmed(line));
}

/// a/b/c and a//c without the normal c.
std::string without_normal(std::string_view corner) {
    const std::size_t first = corner.find('/');
    if (first == std::string_view::npos) return std::string(corner);
    const std::size_t second = std::min(corner.find('/', first + 1), corner.size());
    return std::string(corner.substr(0, second == first + 1 ? first : second));
}

/// The place of a vertex among the corners of a polygon.
int corner_of(std::span<const int> polygon, int vertex) {
    return static_cast<int>(std::ranges::find(polygon, vertex) - polygon.begin());
}

/// The vertices at the corners of a face that read_obj has accepted.
std::vector<int> vertices_of(std::string_view corners, std::size_t vertices_above, const TextPlace& place) {
    std::vector<int> vertices;
    for (std::string_view word = next_word(corners); !word.empty(); word = next_word(corners)) {
        const long long index = to_integer(word.substr(0, word.find('/')), place, "vertex index");
        vertices.push_back(static_cast<int>(index > 0 ? index - 1 : static_cast<long long>(vertices_above) + index));
    }
    return vertices;
}

}  // namespace

ObjLayout::ObjLayout(const std::string& file) : file_(file) {
    const std::string content = read_text(file);
    std::istringstream in(content);
    triangles_ = read_obj(in, file).triangles;
    std::size_t line_number = 0, next_triangle = 0;
    for (std::string_view text = content; !text.empty();) {
        const std::string line = take_obj_line(text, line_number);
        std::string_view rest = line;
        const std::string_view keyword = next_word(rest);
        if (keyword == "v") {
            lines_.push_back({Kind::vertex, behind_coordinates(rest)});
            ++vertices_;
        } else if (keyword == "f") {
            add_face(rest, next_triangle);
        } else if (keyword == "mtllib") {
            lines_.push_back({Kind::library, std::string(trimmed(rest))});
        } else if (!keyword.empty() && keyword != "vn" && keyword != obj_note) {
            lines_.push_back({Kind::other, line});
        }
    }
}

void ObjLayout::add_face(std::string_view corners, std::size_t& next_triangle) {
    const std::vector<int> polygon = vertices_of(corners, vertices_, {file_});
    std::string line = "f";
    for (std::string_view word = next_word(corners); !word.empty(); word = next_word(corners)) line += ' ' + without_normal(word);
    lines_.push_back({Kind::other, line});
    const std::size_t first = std::exchange(next_triangle, next_triangle + polygon.size() - 2);
    if (polygon.size() == 3) return;
    std::string note = std::string(obj_note) + " corners";
    for (const Triangle& triangle : std::span(triangles_).subspan(first, polygon.size() - 2)) {
        for (const int vertex : triangle) append_number(note += ' ', corner_of(polygon, vertex));
    }
    lines_.push_back({Kind::other, note});
}

bool ObjLayout::fits(const TriangleMesh& mesh) const { return mesh.vertices.size() == vertices_ && mesh.triangles == triangles_; }

std::string ObjLayout::library_name(const std::string& name, const std::string& folder) const {
    std::error_code error;
    const fs::path file = fs::absolute(fs::path(file_).parent_path() / name, error);
    const fs::path from_there = fs::proximate(file, fs::absolute(folder, error), error);
    return error ? name : from_there.generic_string();
}

std::string ObjLayout::text(std::span<const Vec3> vertices, const std::string& folder) const {
    std::string text;
    std::size_t next = 0;
    for (const Line& line : lines_) {
        if (line.kind == Kind::vertex) {
            append_obj_vertex(text, vertices[next++]);
            if (!line.text.empty()) text += ' ';
        }
        text += line.kind == Kind::library ? "mtllib " + library_name(line.text, folder) : line.text;
        text += '\n';
    }
    return text;
}

}  // namespace percale::scenes
