#include "meshes/off_file.h"

#include <istream>
#include <iterator>

#include "meshes/text_scan.h"
#include "models/polygon.h"

namespace percale::scenes {

namespace {

// "0 0 0\n" and "3 0 1 2\n": the minimum that a vertex and a face take.
constexpr std::size_t bytes_per_vertex = 6, bytes_per_face = 8;

struct OffText {
    const std::string& name;
    std::string_view rest;
    std::size_t line = 0;

    TextPlace place() const { return {name, line}; }
};

/// The next line that says something, without its comment; empty at the end.
std::string_view next_line(OffText& text) {
    while (!text.rest.empty()) {
        std::string_view line = take_line(text.rest);
        ++text.line;
        line = line.substr(0, line.find('#'));
        std::string_view words = line;
        if (!next_word(words).empty()) return line;
    }
    return {};
}

bool is_plain_keyword(std::string_view word) {
    if (word.starts_with("ST")) word.remove_prefix(2);
    if (word.starts_with("C")) word.remove_prefix(1);
    if (word.starts_with("N")) word.remove_prefix(1);
    return word == "OFF";
}

/// The line with the counts: after the keyword, on its line or the next, or the first line where there is no keyword.
std::string_view counts_line(OffText& text) {
    std::string_view line = next_line(text);
    if (line.empty()) throw SceneError(text.name, "no vertices: the file is empty");
    std::string_view after = line;
    const std::string_view word = next_word(after);
    if (word[0] >= '0' && word[0] <= '9' && !word.ends_with("OFF")) return line;
    if (word.ends_with("4OFF") || word.ends_with("nOFF"))
        fail_at_line(text.place(), shown(word) + ": only three-dimensional OFF files are read");
    if (!is_plain_keyword(word)) fail_at_line(text.place(), "not an OFF file: it starts with " + shown(word));
    std::string_view more = after;
    const std::string_view second = next_word(more);
    if (second == "BINARY") fail_at_line(text.place(), "binary OFF files are not read");
    return second.empty() ? next_line(text) : after;
}

std::size_t read_count(std::string_view& line, const OffText& text, const char* what, std::size_t max) {
    const long long count = to_integer(next_word(line), text.place(), what);
    if (count < 1) fail_at_line(text.place(), std::string(what) + " is " + std::to_string(count));
    if (static_cast<unsigned long long>(count) > max)
        fail_at_line(text.place(), std::string(what) + " is " + std::to_string(count) + ", but the file can hold " +
                                       std::to_string(max) + " at most");
    return static_cast<std::size_t>(count);
}

std::string_view element_line(OffText& text, const char* kind, std::size_t done, std::size_t count) {
    const std::string_view line = next_line(text);
    if (line.empty())
        fail_at_line(text.place(), "the file ends after " + std::to_string(done) + " of " + std::to_string(count) + " " + kind);
    return line;
}

void read_face(std::string_view line, const OffText& text, std::size_t vertex_count, PolygonList& polygons) {
    const long long corners = to_integer(next_word(line), text.place(), "number of corners");
    if (corners < 3) fail_at_line(text.place(), "a face needs 3 corners or more, this one has " + std::to_string(corners));
    for (long long k = 0; k < corners; ++k) {
        const long long index = to_integer(next_word(line), text.place(), "vertex index");
        if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
            fail_at_line(text.place(),
                         "vertex index " + std::to_string(index) + " is out of range 0 ... " + std::to_string(vertex_count - 1));
        polygons.add_corner(static_cast<int>(index));
    }
    polygons.end_polygon();
}

}  // namespace

TriangleMesh read_off(std::istream& in, const std::string& name) {
    const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) throw SceneError(name, "cannot be read");
    OffText text{name, content};
    std::string_view counts = counts_line(text);
    // The last line may lack its line end.
    const std::size_t vertex_count = read_count(counts, text, "number of vertices", (content.size() + 1) / bytes_per_vertex);
    const std::size_t face_count = read_count(counts, text, "number of faces", (content.size() + 1) / bytes_per_face);

    TriangleMesh mesh;
    mesh.vertices.reserve(vertex_count);
    PolygonList polygons;
    polygons.reserve(face_count);
    for (std::size_t k = 0; k < vertex_count; ++k) {
        std::string_view line = element_line(text, "vertices", k, vertex_count);
        Vec3 x;
        x[0] = to_double(next_word(line), text.place(), "coordinate x");
        x[1] = to_double(next_word(line), text.place(), "coordinate y");
        x[2] = to_double(next_word(line), text.place(), "coordinate z");
        mesh.vertices.push_back(x);
    }
    for (std::size_t k = 0; k < face_count; ++k)
        read_face(element_line(text, "faces", k, face_count), text, vertex_count, polygons);
    mesh.triangles = triangles_of(polygons, mesh.vertices);
    return mesh;
}

}  // namespace percale::scenes
