#include "meshes/ply_file.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <istream>
#include <iterator>
#include <limits>
#include <vector>

#include "meshes/text_scan.h"
#include "models/polygon.h"

namespace percale::scenes {

namespace {

struct PlyType {
    enum class Kind { signed_whole, unsigned_whole, real };
    Kind kind = Kind::real;
    std::size_t bytes = 0;
};

constexpr int no_role = -1;

struct PlyProperty {
    PlyType item;
    PlyType length;      // of a list; 0 bytes: no list
    int role = no_role;  // 0, 1, 2: x, y, z of a vertex; 0: the corners of a face
    std::string_view name = {};

    bool is_list() const { return length.bytes > 0; }
    /// Whether it is a field of vertices, unless it is a coordinate.
    bool is_real() const { return !is_list() && item.kind == PlyType::Kind::real; }
};

struct PlyElement {
    std::string_view name;
    std::size_t line = 0;
    std::size_t count = 0;
    std::vector<PlyProperty> properties = {};
    std::array<bool, 3> has_role = {};
};

struct PlyHeader {
    enum class Format { unknown, text, little_endian, big_endian };
    Format format = Format::unknown;
    std::vector<PlyElement> elements;
};

struct PlyText {
    const std::string& name;
    std::string_view rest;
    std::size_t line = 0;

    TextPlace place() const { return {name, line}; }
};

PlyType type_of(std::string_view word, const TextPlace& place) {
    using enum PlyType::Kind;
    if (word == "char" || word == "int8") return {signed_whole, 1};
    if (word == "uchar" || word == "uint8") return {unsigned_whole, 1};
    if (word == "short" || word == "int16") return {signed_whole, 2};
    if (word == "ushort" || word == "uint16") return {unsigned_whole, 2};
    if (word == "int" || word == "int32") return {signed_whole, 4};
    if (word == "uint" || word == "uint32") return {unsigned_whole, 4};
    if (word == "float" || word == "float32") return {real, 4};
    if (word == "double" || word == "float64") return {real, 8};
    fail_at_line(place, "unknown PLY type " + shown(word));
}

PlyType whole_type_of(std::string_view word, const TextPlace& place, const char* what) {
    const PlyType type = type_of(word, place);
    if (type.kind == PlyType::Kind::real) fail_at_line(place, std::string(what) + " must be of a whole type, not " + shown(word));
    return type;
}

/// Whether its elements are lists of corners: faces, or strips of triangles, which scanners write.
bool has_corners(std::string_view element) { return element == "face" || element == "tristrips"; }

int role_of(std::string_view element, std::string_view property) {
    if (has_corners(element)) return property == "vertex_indices" || property == "vertex_index" ? 0 : no_role;
    if (element != "vertex" || property.size() != 1 || property[0] < 'x' || property[0] > 'z') return no_role;
    return property[0] - 'x';
}

std::string_view read_name(std::string_view& line, const TextPlace& place, const char* what) {
    const std::string_view name = next_word(line);
    if (name.empty()) fail_at_line(place, std::string("the ") + what + " has no name");
    return name;
}

void check_end(std::string_view line, const TextPlace& place) {
    const std::string_view word = next_word(line);
    if (!word.empty()) fail_at_line(place, "more than belongs on this line of a PLY header: " + shown(word));
}

void read_property(std::string_view line, const TextPlace& place, PlyHeader& header) {
    if (header.elements.empty()) fail_at_line(place, "a property before the first element");
    PlyElement& element = header.elements.back();
    PlyProperty property;
    std::string_view type = next_word(line);
    if (type == "list") {
        property.length = whole_type_of(next_word(line), place, "the length of a list");
        type = next_word(line);
    }
    property.item = type_of(type, place);
    const std::string_view name = read_name(line, place, "property");
    check_end(line, place);
    property.name = name;
    property.role = role_of(element.name, name);
    if (property.role != no_role) {
        if (element.has_role[property.role]) fail_at_line(place, "a second property " + shown(name));
        element.has_role[property.role] = true;
        const bool is_face = has_corners(element.name);
        if (is_face != property.is_list())
            fail_at_line(place, "property " + shown(name) + (is_face ? " must be a list" : " must be a number, not a list"));
        if (is_face) whole_type_of(type, place, "a vertex index");
    }
    element.properties.push_back(property);
}

void read_format(std::string_view line, const TextPlace& place, PlyHeader& header) {
    using enum PlyHeader::Format;
    const std::string_view format = next_word(line);
    if (header.format != unknown) fail_at_line(place, "a second format");
    if (format == "ascii") header.format = text;
    if (format == "binary_little_endian") header.format = little_endian;
    if (format == "binary_big_endian") header.format = big_endian;
    if (header.format == unknown)
        fail_at_line(place, "unknown PLY format " + shown(format) + ": ascii, binary_little_endian or binary_big_endian");
    const std::string_view version = next_word(line);
    if (version != "1.0") fail_at_line(place, "unknown PLY version " + shown(version) + ": only 1.0 is read");
    check_end(line, place);
}

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
    const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                    [&](const PlyElement& element) { return element.name == name; });
    return found == header.elements.end() ? nullptr : &*found;
}

void read_element(std::string_view line, const TextPlace& place, PlyHeader& header) {
    const std::string_view name = read_name(line, place, "element");
    const long long count = to_integer(next_word(line), place, "element count"), max = std::numeric_limits<int>::max();
    if (count < 0 || count > max)
        fail_at_line(place, "element count " + std::to_string(count) + " is out of range 0 ... " + std::to_string(max));
    check_end(line, place);
    const bool is_known = name == "vertex" || has_corners(name);
    if (is_known && find_element(header, name) != nullptr) fail_at_line(place, "a second element " + shown(name));
    header.elements.push_back({name, place.line, static_cast<std::size_t>(count)});
}

/// Checks that the file has what a mesh needs.
void check_needed(const PlyHeader& header, const std::string& name) {
    const PlyElement *vertex = find_element(header, "vertex"), *face = find_element(header, "face");
    if (vertex == nullptr) throw SceneError(name, "no vertices: the header has no element \"vertex\"");
    for (int axis = 0; axis < 3; ++axis)
        if (!vertex->has_role[axis])
            fail_at_line({name, vertex->line}, std::string("element \"vertex\" has no property \"") + "xyz"[axis] + "\"");
    if (vertex->count == 0) fail_at_line({name, vertex->line}, "no vertices: their count is 0");
    const PlyElement* strips = find_element(header, "tristrips");
    if (face == nullptr && strips == nullptr)
        throw SceneError(name, "no triangles: the header has no element \"face\" or \"tristrips\"");
    std::size_t lists = 0;
    for (const PlyElement* element : {face, strips}) {
        if (element == nullptr) continue;
        lists += element->count;
        if (!element->has_role[0])
            fail_at_line({name, element->line},
                         "element " + shown(element->name) + " has no list \"vertex_indices\" or \"vertex_index\"");
    }
    if (lists == 0) fail_at_line({name, (face != nullptr ? face : strips)->line}, "no triangles: the count of faces is 0");
}

/// The minimum size of an element, bytes: in text a digit and a blank for each number, in binary an empty list takes its length
/// alone.
std::size_t min_bytes(const PlyElement& element, bool text) {
    if (text) return 2 * element.properties.size();
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) bytes += (property.is_list() ? property.length : property.item).bytes;
    return bytes;
}

void check_counts(const PlyHeader& header, const PlyText& text) {
    const bool is_text = header.format == PlyHeader::Format::text;
    std::size_t left = text.rest.size() + (is_text ? 1 : 0);  // the last line may lack its line end
    for (const PlyElement& element : header.elements) {
        const std::size_t each = min_bytes(element, is_text);
        if (each == 0) continue;
        if (element.count > left / each)
            fail_at_line({text.name, element.line}, "the header claims " + std::to_string(element.count) + " elements " +
                                                        shown(element.name) + ", but the file can hold " +
                                                        std::to_string(left / each) + " at most");
        left -= element.count * each;
    }
}

/// False at the header's end.
bool read_header_line(std::string_view line, const TextPlace& place, PlyHeader& header) {
    const std::string_view keyword = next_word(line);
    if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) return true;
    if (keyword == "end_header") return check_end(line, place), false;
    if (keyword == "property") return read_property(line, place, header), true;
    if (keyword == "format") return read_format(line, place, header), true;
    if (keyword == "element") return read_element(line, place, header), true;
    fail_at_line(place, "unknown word in the header of a PLY file: " + shown(keyword));
}

PlyHeader read_header(PlyText& text) {
    text.line = 1;
    std::string_view first = take_line(text.rest);
    const std::string_view magic = next_word(first);
    if (magic != "ply") fail_at_line(text.place(), "not a PLY file: it starts with " + shown(magic));
    check_end(first, text.place());
    PlyHeader header;
    for (bool goes_on = true; goes_on;) {
        if (text.rest.empty()) throw SceneError(text.name, "not a PLY file: its header has no end");
        ++text.line;
        goes_on = read_header_line(take_line(text.rest), text.place(), header);
    }
    if (header.format == PlyHeader::Format::unknown) throw SceneError(text.name, "the header names no format");
    check_needed(header, text.name);
    check_counts(header, text);
    return header;
}

/// What stands behind the header, number by number.
class PlyBody {
public:
    PlyBody(const PlyText& text, PlyHeader::Format format)
        : text_(text), is_text_(format == PlyHeader::Format::text), big_endian_(format == PlyHeader::Format::big_endian) {}

    /// An element with properties; text has a line for it.
    void begin(const PlyElement& element, std::size_t number);
    void end() const;
    double coordinate(PlyType type, const char* what);
    /// The next number of a real type, which may be infinite or NaN.
    double any_number(PlyType type);
    long long whole(PlyType type, const char* what);
    void skip(const PlyProperty& property);
    [[noreturn]] void fail(const std::string& message) const;

private:
    std::uint64_t bits(std::size_t bytes);

    PlyText text_;
    bool is_text_ = false, big_endian_ = false;
    std::string_view words_;  // of the element's line that are still to be read
    std::string_view element_;
    std::size_t number_ = 0;
};

void PlyBody::begin(const PlyElement& element, std::size_t number) {
    element_ = element.name;
    number_ = number;
    words_ = {};
    for (std::string_view look; is_text_ && next_word(look = words_).empty();) {
        if (text_.rest.empty())
            fail("the file ends after " + std::to_string(number) + " of " + std::to_string(element.count) + " elements " +
                 shown(element_));
        words_ = take_line(text_.rest);
        ++text_.line;
    }
}

void PlyBody::end() const {
    std::string_view words = words_;
    const std::string_view word = next_word(words);
    if (!word.empty()) fail("more on this line than the header says of element " + shown(element_) + ": " + shown(word));
}

void PlyBody::fail(const std::string& message) const {
    if (is_text_) fail_at_line(text_.place(), message);
    throw SceneError(text_.name, "element " + shown(element_) + " " + std::to_string(number_) + ": " + message);
}

std::uint64_t PlyBody::bits(std::size_t bytes) {
    if (bytes > text_.rest.size()) fail("the file ends within it");
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < bytes; ++k)
        value = value << 8 | static_cast<unsigned char>(text_.rest[big_endian_ ? k : bytes - 1 - k]);
    text_.rest.remove_prefix(bytes);
    return value;
}

long long PlyBody::whole(PlyType type, const char* what) {
    if (is_text_) return to_integer(next_word(words_), text_.place(), what);
    const std::uint64_t value = bits(type.bytes);
    if (type.kind == PlyType::Kind::unsigned_whole) return static_cast<long long>(value);
    // The sign bit is shifted to the top, and the shift back extends it.
    const std::size_t unused = 64 - 8 * type.bytes;
    return static_cast<std::int64_t>(value << unused) >> unused;
}

double PlyBody::any_number(PlyType type) {
    if (is_text_) {
        const std::string_view word = next_word(words_);
        double number = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (word.empty() || error != std::errc() || end != word.data() + word.size())
            fail("the value of a field is not a number: " + shown(word));
        return number;
    }
    const std::uint64_t value = bits(type.bytes);
    return type.bytes == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(value)) : std::bit_cast<double>(value);
}

double PlyBody::coordinate(PlyType type, const char* what) {
    if (is_text_) return to_double(next_word(words_), text_.place(), what);
    if (type.kind != PlyType::Kind::real) return static_cast<double>(whole(type, what));
    const double number = any_number(type);
    if (!std::isfinite(number)) fail(std::string(what) + " is not finite");
    return number;
}

void PlyBody::skip(const PlyProperty& property) {
    const long long count = property.is_list() ? whole(property.length, "length of a list") : 1;
    if (count < 0) fail("length of a list is " + std::to_string(count));
    if (!is_text_) {
        if (static_cast<std::uint64_t>(count) > text_.rest.size() / property.item.bytes) fail("the file ends within it");
        text_.rest.remove_prefix(static_cast<std::size_t>(count) * property.item.bytes);
        return;
    }
    for (long long k = 0; k < count; ++k)
        if (next_word(words_).empty()) fail("a number is missing");
}

/// `fields`: null, or one for each real property that is no coordinate, in their order.
Vec3 read_vertex(PlyBody& body, const PlyElement& element, std::vector<MeshField>* fields) {
    constexpr const char* names[] = {"coordinate x", "coordinate y", "coordinate z"};
    Vec3 x;
    std::size_t field = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.role != no_role)
            x[property.role] = body.coordinate(property.item, names[property.role]);
        else if (fields != nullptr && property.is_real())
            (*fields)[field++].values.push_back(body.any_number(property.item));
        else
            body.skip(property);
    }
    return x;
}

void name_fields(const PlyElement& vertex, std::vector<MeshField>& fields) {
    fields.clear();
    for (const PlyProperty& property : vertex.properties)
        if (property.role == no_role && property.is_real()) fields.push_back({std::string(property.name), {}});
}

void read_corners(PlyBody& body, const PlyProperty& list, std::size_t vertex_count, PolygonList& polygons) {
    const long long corners = body.whole(list.length, "number of corners");
    if (corners < 3) body.fail("a face needs 3 corners or more, this one has " + std::to_string(corners));
    for (long long k = 0; k < corners; ++k) {
        const long long index = body.whole(list.item, "vertex index");
        if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
            body.fail("vertex index " + std::to_string(index) + " is out of range 0 ... " + std::to_string(vertex_count - 1));
        polygons.add_corner(static_cast<int>(index));
    }
    polygons.end_polygon();
}

/// Triangles of each three indices that follow each other, turned the same way; -1 begins another strip. Those with a vertex
/// twice, by which strips are joined, are left out.
void read_strip(PlyBody& body, const PlyProperty& list, std::size_t vertex_count, PolygonList& polygons) {
    std::array<long long, 3> last = {-1, -1, -1};
    long long in_strip = 0;
    for (long long left = body.whole(list.length, "number of indices"); left > 0; --left) {
        const long long index = body.whole(list.item, "vertex index");
        in_strip = index == -1 ? 0 : in_strip + 1;
        if (index == -1) continue;
        if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
            body.fail("vertex index " + std::to_string(index) + " is out of range 0 ... " + std::to_string(vertex_count - 1) +
                      ", and not -1");
        last = {last[1], last[2], index};
        if (in_strip < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
        const int turned = in_strip % 2 == 0 ? 1 : 0;
        for (const int corner : {turned, 1 - turned, 2}) polygons.add_corner(static_cast<int>(last[corner]));
        polygons.end_polygon();
    }
}

/// What the elements of a file hold, faces perhaps before their vertices.
struct PlyContent {
    std::vector<Vec3> vertices;
    PolygonList faces;
    std::vector<MeshField>* fields = nullptr;
};

void read_elements(PlyBody& body, const PlyElement& element, std::size_t vertex_count, PlyContent& read) {
    for (std::size_t k = 0; k < element.count; ++k) {
        body.begin(element, k);
        if (element.name == "vertex") {
            read.vertices.push_back(read_vertex(body, element, read.fields));
        } else {
            for (const PlyProperty& property : element.properties)
                property.role == no_role      ? body.skip(property)
                : element.name == "tristrips" ? read_strip(body, property, vertex_count, read.faces)
                                              : read_corners(body, property, vertex_count, read.faces);
        }
        body.end();
    }
}

}  // namespace

TriangleMesh read_ply(std::istream& in, const std::string& name, std::vector<MeshField>* fields) {
    const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) throw SceneError(name, "cannot be read");
    PlyText text{name, content};
    const PlyHeader header = read_header(text);
    const std::size_t vertex_count = find_element(header, "vertex")->count;
    PlyContent read;
    read.fields = fields;
    if (fields != nullptr) name_fields(*find_element(header, "vertex"), *fields);
    read.vertices.reserve(vertex_count);
    if (const PlyElement* face = find_element(header, "face")) read.faces.reserve(face->count);
    PlyBody body(text, header.format);
    for (const PlyElement& element : header.elements)
        if (!element.properties.empty()) read_elements(body, element, vertex_count, read);
    TriangleMesh mesh;
    mesh.triangles = triangles_of(read.faces, read.vertices);
    mesh.vertices = std::move(read.vertices);
    return mesh;
}

}  // namespace percale::scenes
