#include "meshes/obj_file.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "common/whole_file.h"
#include "meshes/text_scan.h"
#include "models/mesh_part.h"
#include "models/polygon.h"

namespace percale::scenes {

namespace {

/// The corners of all faces read so far, one after another, as 0-based indices that are checked once all vertices are known.
struct FaceList {
    std::vector<long long> corners;
    std::vector<long long> textures;  // of the corners; -1: none
    std::vector<std::size_t> ends;    // one past a face's last corner
    std::vector<std::size_t> lines;   // where the face stands
    /// How faces are cut into triangles, by the numbers of their corners, where the file says it (ObjLayout).
    std::map<std::size_t, std::vector<Triangle>> cuts;
};

/// How many vertices and texture coordinates stand above a line.
struct ReadSoFar {
    std::size_t vertices = 0, textures = 0;
};

/// Which faces are taken: all, or those of one object or group.
class PartChoice {
public:
    explicit PartChoice(const std::string& part) : part_(part) {}

    /// A line `o NAME` or `g NAME...`: what the next faces belong to.
    void enter(std::string_view keyword, std::string_view line) {
        reported_ = false;
        if (keyword == "o") {
            const std::size_t first = line.find_first_not_of(" \t"), last = line.find_last_not_of(" \t\r");
            object_ = first == std::string_view::npos ? "" : std::string(line.substr(first, last - first + 1));
            return;
        }
        groups_.clear();
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) groups_.emplace_back(word);
    }

    bool takes_next_face() {
        if (part_.empty()) return true;
        if (!std::exchange(reported_, true)) {
            names_.add(object_);
            for (const std::string& group : groups_) names_.add(group);
        }
        return object_ == part_ || std::ranges::find(groups_, part_) != groups_.end();
    }

    [[noreturn]] void fail_without_faces(const std::string& file) const { names_.fail(file, part_); }

private:
    const std::string& part_;
    std::string object_;
    std::vector<std::string> groups_;
    PartNames names_;
    bool reported_ = false;  // what the next faces belong to is among the names
};

/// Indices of one corner as they stand in the file; texture 0: none.
struct Corner {
    long long vertex = 0, texture = 0;
};

Vec3 read_vertex(std::string_view line, const TextPlace& place) {
    constexpr const char* names[] = {"coordinate x", "coordinate y", "coordinate z", "weight or colour"};
    std::array<double, 8> numbers{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty() && count < numbers.size(); word = next_word(line)) {
        numbers[count] = to_double(word, place, names[std::min<std::size_t>(count, 3)]);
        ++count;
    }
    if (count < 3) fail_at_line(place, std::string(names[count]) + " is missing");
    if (count > 7)
        fail_at_line(place, "a vertex has 3 coordinates, at most a weight and a colour after them, not 8 numbers or more");
    const bool weighted = count == 4 || count == 7;
    if (weighted && numbers[3] != 1.0) fail_at_line(place, "a vertex weight other than 1 is not supported");
    return {numbers[0], numbers[1], numbers[2]};
}

/// One corner a, a/b, a//c or a/b/c; the index of its normal is only checked for form.
Corner read_corner(std::string_view word, const TextPlace& place) {
    const std::size_t slash = word.find('/');
    Corner corner{.vertex = to_integer(word.substr(0, slash), place, "vertex index")};
    if (slash == std::string_view::npos) return corner;
    std::string_view rest = word.substr(slash + 1);
    const std::size_t second = std::min(rest.find('/'), rest.size());
    if (second > 0) corner.texture = to_integer(rest.substr(0, second), place, "texture index");
    if (second < rest.size()) to_integer(rest.substr(second + 1), place, "normal index");
    return corner;
}

/// The index counted from 0, -1: none. A negative index in the file counts backwards from what stands above the line.
long long from_zero(long long index, std::size_t so_far) {
    return index >= 0 ? index - 1 : std::max(-1LL, static_cast<long long>(so_far) + index);
}

void read_face(std::string_view line, const TextPlace& place, const ReadSoFar& so_far, FaceList& faces) {
    const std::size_t vertex_count = so_far.vertices;
    const std::size_t start = faces.corners.size();
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
        const auto [index, texture] = read_corner(word, place);
        if (index == 0) fail_at_line(place, "vertex index 0: indices start at 1 (or at -1, backwards)");
        if (index < -static_cast<long long>(vertex_count))
            fail_at_line(place, "vertex index " + std::to_string(index) + " reaches before the first of " +
                                    std::to_string(vertex_count) + " vertices read so far");
        faces.corners.push_back(from_zero(index, vertex_count));
        faces.textures.push_back(from_zero(texture, so_far.textures));
    }
    const std::size_t count = faces.corners.size() - start;
    if (count < 3) fail_at_line(place, "a face needs 3 corners or more, this one has " + std::to_string(count));
    faces.ends.push_back(faces.corners.size());
    faces.lines.push_back(place.line);
}

/// A comment of ObjLayout behind a face: how it is cut.
void read_cut(std::string_view line, const TextPlace& place, FaceList& faces) {
    if (next_word(line) != "corners") return;
    if (faces.ends.empty()) fail_at_line(place, "no face stands above it");
    const std::size_t face = faces.ends.size() - 1;
    const std::size_t count = faces.ends[face] - (face == 0 ? 0 : faces.ends[face - 1]);
    std::vector<Triangle> cut;
    for (std::string_view word = next_word(line); !word.empty() && cut.size() <= count; word = next_word(line)) {
        Triangle& triangle = cut.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const long long corner = to_integer(k == 0 ? word : next_word(line), place, "corner");
            if (corner < 0 || corner >= static_cast<long long>(count))
                fail_at_line(place, "corner " + std::to_string(corner) + " of a face with " + std::to_string(count));
            triangle[k] = static_cast<int>(corner);
        }
    }
    if (cut.size() + 2 != count)
        fail_at_line(place, "a face of " + std::to_string(count) + " corners is cut into " + std::to_string(count - 2) +
                                " triangles, not " + std::to_string(cut.size()));
    faces.cuts[face] = std::move(cut);
}

/// A triangle by the numbers of its corners in the list, and its face.
struct CornerTriangle {
    std::array<std::size_t, 3> corners;
    std::size_t face = 0;
};

std::vector<CornerTriangle> corner_triangles(const FaceList& faces, std::span<const Vec3> vertices, const std::string& name) {
    std::vector<CornerTriangle> triangles;
    triangles.reserve(faces.corners.size());
    std::vector<Vec3> places;
    std::size_t start = 0;
    for (std::size_t face = 0; face < faces.ends.size(); ++face) {
        places.clear();
        for (std::size_t k = start; k < faces.ends[face]; ++k) {
            if (faces.corners[k] >= static_cast<long long>(vertices.size()))
                fail_at_line({name, faces.lines[face]}, "vertex index " + std::to_string(faces.corners[k] + 1) +
                                                            " is out of range 1 ... " + std::to_string(vertices.size()));
            places.push_back(vertices[static_cast<std::size_t>(faces.corners[k])]);
        }
        const auto cut = faces.cuts.find(face);
        for (const Triangle& t : cut != faces.cuts.end() ? cut->second : polygon_triangles(places))
            triangles.push_back({{start + t[0], start + t[1], start + t[2]}, face});
        start = faces.ends[face];
    }
    return triangles;
}

/// Texture coordinates of the corners.
std::vector<std::array<Eigen::Vector2d, 3>> corner_textures(const FaceList& faces, std::span<const CornerTriangle> triangles,
                                                            const std::vector<Eigen::Vector2d>& textures,
                                                            const std::string& name) {
    std::vector<std::array<Eigen::Vector2d, 3>> uv;
    for (const auto& [corners, face] : triangles) {
        const auto texture = [&, line = faces.lines[face]](std::size_t corner) {
            const long long index = faces.textures[corner];
            if (index >= 0 && index < static_cast<long long>(textures.size())) return textures[static_cast<std::size_t>(index)];
            fail_at_line({name, line}, index < 0 ? "a corner has no texture index (vt), which every corner needs here"
                                                 : "texture index " + std::to_string(index + 1) + " is out of range 1 ... " +
                                                       std::to_string(textures.size()));
        };
        uv.push_back({texture(corners[0]), texture(corners[1]), texture(corners[2])});
    }
    return uv;
}

Eigen::Vector2d read_texture(std::string_view line, const TextPlace& place) {
    constexpr const char* names[] = {"texture coordinate u", "texture coordinate v"};
    Eigen::Vector2d uv;
    for (int axis = 0; axis < 2; ++axis) {
        const std::string_view word = next_word(line);
        if (word.empty()) fail_at_line(place, std::string(names[axis]) + " is missing");
        uv[axis] = to_double(word, place, names[axis]);
        if (!std::isfinite(uv[axis])) fail_at_line(place, std::string(names[axis]) + " is not finite");
    }
    return uv;
}

/// With `textured`, vt are read, too.
TexturedMesh read_content(std::istream& in, const std::string& name, bool textured, const std::string& part) {
    const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) throw SceneError(name, "cannot be read");
    TexturedMesh result;
    TriangleMesh& mesh = result.mesh;
    std::vector<Eigen::Vector2d> textures;
    FaceList faces;
    PartChoice choice(part);
    std::size_t line_number = 0;
    bool taken = true;  // the face above
    for (std::string_view text = content; !text.empty();) {
        const TextPlace place{name, line_number + 1};
        const std::string line = take_obj_line(text, line_number);
        std::string_view rest = line;
        const std::string_view keyword = next_word(rest);
        if (keyword == "v") mesh.vertices.push_back(read_vertex(rest, place));
        if (keyword == "vt" && textured) textures.push_back(read_texture(rest, place));
        if (keyword == "o" || keyword == "g") choice.enter(keyword, rest);
        if (keyword == "f") taken = choice.takes_next_face();
        if (keyword == "f" && taken) read_face(rest, place, {mesh.vertices.size(), textures.size()}, faces);
        if (keyword == obj_note && taken) read_cut(rest, place, faces);
    }
    if (mesh.vertices.empty()) throw SceneError(name, "no vertices");
    if (faces.ends.empty() && !part.empty()) choice.fail_without_faces(name);
    if (faces.ends.empty()) throw SceneError(name, "no triangles");
    const std::vector<CornerTriangle> triangles = corner_triangles(faces, mesh.vertices, name);
    const auto vertex = [&](std::size_t corner) { return static_cast<int>(faces.corners[corner]); };
    for (const auto& [corners, face] : triangles) {
        mesh.triangles.push_back({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
    }
    if (textured) result.uv = corner_textures(faces, triangles, textures, name);
    if (!part.empty()) drop_unused_vertices(mesh);
    return result;
}

std::string obj_text(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    std::string text;
    text.reserve(vertices.size() * 64 + triangles.size() * 24);
    for (const Vec3& x : vertices) append_obj_vertex(text, x) += '\n';
    for (const Triangle& triangle : triangles) {
        text += 'f';
        for (const int vertex : triangle) append_number(text += ' ', static_cast<long long>(vertex) + 1);
        text += '\n';
    }
    return text;
}

}  // namespace

std::string& append_obj_vertex(std::string& text, const Vec3& x) {
    text += 'v';
    for (int k = 0; k < 3; ++k) append_number(text += ' ', x[k]);
    return text;
}

TriangleMesh read_obj(std::istream& in, const std::string& name, const std::string& part) {
    return read_content(in, name, false, part).mesh;
}

TexturedMesh read_textured_obj(std::istream& in, const std::string& name, const std::string& part) {
    return read_content(in, name, true, part);
}

void write_obj(const std::string& file, std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    write_whole_file(file, obj_text(vertices, triangles));
}

}  // namespace percale::scenes
