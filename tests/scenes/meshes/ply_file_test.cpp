#include "scenes/meshes/ply_file.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <sstream>

#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::ply_file_test {
namespace {

TriangleMesh parse(const std::string& text) {
    std::istringstream in(text);
    return read_ply(in, "mesh.ply");
}

std::string refusal(const std::string& text) {
    return message_of([&] { parse(text); });
}

const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
const std::string vertex_lines = "property float x\nproperty float y\nproperty float z\n";
const std::string face_line = "property list uchar int vertex_indices\n";

/// Vertices on line 3, faces on line 7, the body from line 10 on.
std::string header(const std::string& format, const std::string& vertices, const std::string& faces) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + vertices + "\n" + vertex_lines + "element face " + faces + "\n" +
           face_line + "end_header\n";
}

std::string ascii(const std::string& body, const std::string& faces = "1") { return header("ascii", "3", faces) + body; }

/// The lowest bytes of a number as they stand in a binary file.
std::string bytes(std::uint64_t bits, int count, bool big_endian) {
    std::string text;
    for (int k = 0; k < count; ++k) text += static_cast<char>(bits >> 8 * (big_endian ? count - 1 - k : k) & 255);
    return text;
}

std::string float_bytes(float number, bool big_endian) { return bytes(std::bit_cast<std::uint32_t>(number), 4, big_endian); }
std::string double_bytes(double number, bool big_endian) { return bytes(std::bit_cast<std::uint64_t>(number), 8, big_endian); }

struct BinaryFormat {
    const char* name;
    bool big_endian;
};

constexpr BinaryFormat binary_formats[] = {{"binary_little_endian", false}, {"binary_big_endian", true}};

struct WholeType {
    const char* names[2];
    int bytes;
    long long lowest, highest;
};

template <typename Number>
WholeType whole_type(const char* old_name, const char* new_name) {
    using Limits = std::numeric_limits<Number>;
    return {{old_name, new_name}, sizeof(Number), Limits::lowest(), Limits::max()};
}

const std::vector<WholeType> whole_types = {
    whole_type<std::int8_t>("char", "int8"),    whole_type<std::uint8_t>("uchar", "uint8"),
    whole_type<std::int16_t>("short", "int16"), whole_type<std::uint16_t>("ushort", "uint16"),
    whole_type<std::int32_t>("int", "int32"),   whole_type<std::uint32_t>("uint", "uint32")};

/// Three vertices (lowest, highest, 7) of the type called `name`.
std::string extreme_vertices(const BinaryFormat& format, const WholeType& type, const std::string& name) {
    const bool big = format.big_endian;
    std::string text = std::string("ply\nformat ") + format.name + " 1.0\nelement vertex 3\n";
    for (const std::string axis : {"x", "y", "z"}) text += "property " + name + " " + axis + "\n";
    text += "element face 1\n" + face_line + "end_header\n";
    for (int k = 0; k < 3; ++k)
        for (const long long number : {type.lowest, type.highest, 7LL})
            text += bytes(static_cast<std::uint64_t>(number), type.bytes, big);
    return text + bytes(3, 1, big) + bytes(0, 4, big) + bytes(1, 4, big) + bytes(2, 4, big);
}

/// The polygon 3 2 1 0.
std::string quad_of(const BinaryFormat& format, const WholeType& length, const WholeType& index) {
    std::string text = std::string("ply\nformat ") + format.name + " 1.0\nelement vertex 4\n" + vertex_lines +
                       "element face 1\nproperty list " + length.names[0] + " " + index.names[1] +
                       " vertex_indices\nend_header\n" + std::string(4 * 12, '\0') + bytes(4, length.bytes, format.big_endian);
    for (const std::uint64_t corner : {3u, 2u, 1u, 0u}) text += bytes(corner, index.bytes, format.big_endian);
    return text;
}

}  // namespace

TEST_CASE("Strips are triangles that turn the same way, begin anew behind -1, and are joined by flat ones, which are left out") {
    const std::string vertices = "ply\nformat ascii 1.0\nelement vertex 6\n" + vertex_lines;
    const std::string points = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";
    const std::string strip = "element tristrips 1\nproperty list int int vertex_indices\n";
    CHECK(parse(vertices + strip + "end_header\n" + points + "5 0 1 2 3 4\n").triangles ==
          std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}});
    CHECK(parse(vertices + strip + "end_header\n" + points + "8 0 1 2 -1 1 2 3 4\n").triangles ==
          std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}, {3, 2, 4}});
    CHECK(parse(vertices + strip + "end_header\n" + points + "8 0 1 2 2 3 3 4 5\n").triangles ==
          std::vector<Triangle>{{0, 1, 2}, {4, 3, 5}});
    CHECK(parse(vertices + "element face 1\n" + face_line + strip + "end_header\n" + points + "3 0 1 2\n3 3 4 5\n").triangles ==
          std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
    CHECK(refusal(vertices + strip + "end_header\n" + points + "3 0 1 6\n") ==
          "mesh.ply:16: vertex index 6 is out of range 0 ... 5, and not -1");
    CHECK(refusal(vertices + strip + "end_header\n" + points + "3 0 1 -2\n").find("-2 is out of range") != std::string::npos);
    CHECK(refusal(vertices + "element tristrips 0\nproperty list int int vertex_indices\nend_header\n" + points)
              .find("no triangles") != std::string::npos);
    CHECK(refusal(vertices + "element tristrips 1\nproperty list int int other\nend_header\n" + points + "0\n")
              .find("element \"tristrips\" has no list") != std::string::npos);
}

TEST_CASE("a PLY in text is exactly its vertices and faces, in order, doubles included, nothing welded") {
    const TriangleMesh mesh = parse(
        "ply\r\nformat ascii 1.0\r\ncomment \x05 any \xff thing\r\nobj_info end_header\r\n"
        "element vertex 4\r\nproperty double x\r\nproperty float y\r\nproperty float z\r\n\r\n"
        "element face 2\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
        "0.1 0 0\r\n1 0 0\r\n\r\n0 1 0\r\n0 1 0\r\n3 2 0 1\r\n3 3 1 0");
    CHECK(mesh.vertices == std::vector<Vec3>{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{2, 0, 1}, {3, 1, 0}});
}

TEST_CASE("binary coordinates are the bits of the file in both orders of bytes") {
    for (const BinaryFormat& format : binary_formats) {
        INFO(format.name);
        const bool big = format.big_endian;
        std::string text = std::string("ply\nformat ") + format.name +
                           " 1.0\nelement vertex 3\nproperty double x\nproperty float32 y\nproperty float64 z\n"
                           "element face 1\n" +
                           face_line + "end_header\n";
        const std::vector<Vec3> expected = {{0.1, 0.1f, -1e308}, {1.0 / 3.0, -2.5f, 5e-324}, {-0.7, 3e38f, 10.0}};
        for (const Vec3& x : expected)
            text += double_bytes(x[0], big) + float_bytes(static_cast<float>(x[1]), big) + double_bytes(x[2], big);
        text += bytes(3, 1, big) + bytes(2, 4, big) + bytes(0, 4, big) + bytes(1, 4, big);
        const TriangleMesh mesh = parse(text);
        CHECK(mesh.vertices == expected);
        CHECK(mesh.triangles == std::vector<Triangle>{{2, 0, 1}});
    }
}

TEST_CASE("coordinates of every whole type range from its lowest to its highest number") {
    for (const BinaryFormat& format : binary_formats) {
        for (const WholeType& type : whole_types) {
            INFO(format.name << " " << type.names[0]);
            const Vec3 x(static_cast<double>(type.lowest), static_cast<double>(type.highest), 7.0);
            for (const char* name : type.names)
                CHECK(parse(extreme_vertices(format, type, name)).vertices == std::vector<Vec3>{x, x, x});
        }
    }
}

TEST_CASE("faces may be lists of any whole types") {
    for (const BinaryFormat& format : binary_formats) {
        for (const WholeType& length : whole_types) {
            INFO(format.name << " list " << length.names[0]);
            for (const WholeType& index : whole_types)
                CHECK(parse(quad_of(format, length, index)).triangles == std::vector<Triangle>{{3, 2, 1}, {3, 1, 0}});
        }
    }
}

TEST_CASE("other elements and properties are passed over by their types, in any order") {
    const std::string head =
        " 1.0\nelement material 2\nproperty list uint8 double weights\nproperty short id\nelement nothing 5\n"
        "element face 1\nproperty uchar red\nproperty list int16 uint16 vertex_index\nproperty list uchar float texcoord\n"
        "element vertex 3\nproperty float nx\nproperty double z\nproperty list int char tags\nproperty double x\n"
        "property double y\nelement edge 1\nproperty int vertex1\nend_header\n";
    const std::vector<Vec3> expected = {{1, 2, 3}, {4, 5, 6}, {7, 8, 0.1}};
    const std::vector<Triangle> triangle = {{0, 2, 1}};
    const TriangleMesh text = parse("ply\nformat ascii" + head +
                                    "2 0.5 0.5 -1\n0 7\n255 3 0 2 1 2 0.5 0.5\n"
                                    "0 3 0 1 2\n0 6 2 -1 -2 4 5\n0 0.1 1 9 7 8\n12\n");
    CHECK(text.vertices == expected);
    CHECK(text.triangles == triangle);
    for (const BinaryFormat& format : binary_formats) {
        const bool big = format.big_endian;
        std::string body = bytes(2, 1, big) + std::string(16, 'w') + "id" + bytes(0, 1, big) + "id" + "r" + bytes(3, 2, big) +
                           bytes(0, 2, big) + bytes(2, 2, big) + bytes(1, 2, big) + bytes(2, 1, big) + std::string(8, 't');
        for (const Vec3& x : expected)
            body += std::string("norm") + double_bytes(x[2], big) + bytes(2, 4, big) + "tg" + double_bytes(x[0], big) +
                    double_bytes(x[1], big);
        const TriangleMesh mesh = parse(std::string("ply\nformat ") + format.name + head + body + "edge");
        CHECK(mesh.vertices == expected);
        CHECK(mesh.triangles == triangle);
    }
}

TEST_CASE("a PLY header that cannot be understood is refused with its line") {
    const auto in_header = [](const std::string& line) { return refusal("ply\nformat ascii 1.0\n" + line + "\nend_header\n"); };
    CHECK(refusal("") == "mesh.ply:1: not a PLY file: it starts with \"\"");
    CHECK(refusal("OFF\n") == "mesh.ply:1: not a PLY file: it starts with \"OFF\"");
    CHECK(refusal("ply 2\n") == "mesh.ply:1: more than belongs on this line of a PLY header: \"2\"");
    CHECK(refusal("ply\nformat ascii 1.0\nelement vertex 3\n") == "mesh.ply: not a PLY file: its header has no end");
    CHECK(refusal("ply\nformat binary 1.0\n") ==
          "mesh.ply:2: unknown PLY format \"binary\": ascii, binary_little_endian or binary_big_endian");
    CHECK(refusal("ply\nformat ascii 2.0\n") == "mesh.ply:2: unknown PLY version \"2.0\": only 1.0 is read");
    CHECK(refusal("ply\nelement vertex 3\nend_header\n") == "mesh.ply: the header names no format");
    CHECK(in_header("format ascii 1.0") == "mesh.ply:3: a second format");
    CHECK(in_header("prortey float x") == "mesh.ply:3: unknown word in the header of a PLY file: \"prortey\"");
    CHECK(in_header("property float x") == "mesh.ply:3: a property before the first element");
    CHECK(in_header("element") == "mesh.ply:3: the element has no name");
    CHECK(in_header("element vertex") == "mesh.ply:3: element count is missing");
    CHECK(in_header("element vertex 3 4") == "mesh.ply:3: more than belongs on this line of a PLY header: \"4\"");
    CHECK(in_header("element vertex -3") == "mesh.ply:3: element count -3 is out of range 0 ... 2147483647");
    CHECK(in_header("element vertex 2147483648") == "mesh.ply:3: element count 2147483648 is out of range 0 ... 2147483647");
    CHECK(in_header("element vertex 18446744073709551617").find("mesh.ply:3: element count is not a whole number") == 0);
    CHECK(in_header("element vertex 3\nelement vertex 3") == "mesh.ply:4: a second element \"vertex\"");
    CHECK(in_header("element vertex 3\nproperty half x") == "mesh.ply:4: unknown PLY type \"half\"");
    CHECK(in_header("element vertex 3\nproperty float") == "mesh.ply:4: the property has no name");
    CHECK(in_header("element vertex 3\nproperty float x y") ==
          "mesh.ply:4: more than belongs on this line of a PLY header: \"y\"");
    CHECK(in_header("element vertex 3\nproperty float x\nproperty double x") == "mesh.ply:5: a second property \"x\"");
    CHECK(in_header("element vertex 3\nproperty list uchar float x") ==
          "mesh.ply:4: property \"x\" must be a number, not a list");
    CHECK(in_header("element face 3\nproperty int vertex_index") == "mesh.ply:4: property \"vertex_index\" must be a list");
    CHECK(in_header("element face 3\n" + face_line + "property list uchar int vertex_index") ==
          "mesh.ply:5: a second property \"vertex_index\"");
    CHECK(in_header("element face 3\nproperty list uchar float vertex_index") ==
          "mesh.ply:4: a vertex index must be of a whole type, not \"float\"");
    CHECK(in_header("element tristrips 3\nproperty list double int x") ==
          "mesh.ply:4: the length of a list must be of a whole type, not \"double\"");
}

TEST_CASE("a PLY without coordinates or faces says what is missing") {
    const std::string start = "ply\nformat ascii 1.0\n", vertex = "element vertex 3\n" + vertex_lines, end = "end_header\n";
    CHECK(refusal(start + end) == "mesh.ply: no vertices: the header has no element \"vertex\"");
    for (const std::string axis : {"x", "y", "z"}) {
        std::string without = start + vertex + "element face 1\n" + face_line + end + corners + "3 0 1 2\n";
        without.replace(without.find("float " + axis), 7, "float other");
        CHECK(refusal(without) == "mesh.ply:3: element \"vertex\" has no property \"" + axis + "\"");
    }
    CHECK(refusal(start + vertex + end + corners) ==
          "mesh.ply: no triangles: the header has no element \"face\" or \"tristrips\"");
    CHECK(refusal(start + vertex + "element face 1\nproperty list uchar int corners\n" + end + corners + "3 0 1 2\n") ==
          "mesh.ply:7: element \"face\" has no list \"vertex_indices\" or \"vertex_index\"");
    CHECK(refusal(header("ascii", "0", "1") + "3 0 1 2\n") == "mesh.ply:3: no vertices: their count is 0");
    CHECK(refusal(header("ascii", "3", "0") + corners) == "mesh.ply:7: no triangles: the count of faces is 0");
}

TEST_CASE("a PLY header that claims more than the file holds is refused at once") {
    CHECK(refusal(header("ascii", "2000000000", "1") + corners) ==
          "mesh.ply:3: the header claims 2000000000 elements \"vertex\", but the file can hold 3 at most");
    CHECK(refusal(ascii(corners, "2000000000")) ==
          "mesh.ply:7: the header claims 2000000000 elements \"face\", but the file can hold 0 at most");
    CHECK(parse(ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1 2")).triangles.size() == 1);
    for (const BinaryFormat& format : binary_formats) {
        const std::string vertices(3 * 12, '\0');
        CHECK(refusal(header(format.name, "2000000000", "1") + vertices) ==
              "mesh.ply:3: the header claims 2000000000 elements \"vertex\", but the file can hold 3 at most");
        CHECK(refusal(header(format.name, "3", "2000000000") + vertices + std::string(13, '\0')) ==
              "mesh.ply:7: the header claims 2000000000 elements \"face\", but the file can hold 13 at most");
    }
}

TEST_CASE("what is wrong in a PLY in text is said with its line") {
    CHECK(refusal(ascii(corners + "3 0 1 3\n")) == "mesh.ply:13: vertex index 3 is out of range 0 ... 2");
    CHECK(refusal(ascii(corners + "3 0 1 -1\n")) == "mesh.ply:13: vertex index -1 is out of range 0 ... 2");
    CHECK(refusal(ascii(corners + "3 0 1\n")) == "mesh.ply:13: vertex index is missing");
    CHECK(refusal(ascii(corners + "9000000000 0 1 2\n")) == "mesh.ply:13: vertex index is missing");
    CHECK(refusal(ascii(corners + "3 0 1 2 7\n")) ==
          "mesh.ply:13: more on this line than the header says of element \"face\": \"7\"");
    CHECK(refusal(ascii(corners + "2 0 1\n")) == "mesh.ply:13: a face needs 3 corners or more, this one has 2");
    CHECK(refusal(ascii(corners + "-3 0 1\n")) == "mesh.ply:13: a face needs 3 corners or more, this one has -3");
    CHECK(refusal(ascii("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")) == "mesh.ply:11: coordinate y is not finite: \"nan\"");
    CHECK(refusal(ascii("0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2\n")) == "mesh.ply:11: coordinate z is not finite: \"-inf\"");
    CHECK(refusal(ascii("0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n")) == "mesh.ply:11: coordinate y is not a number: \"x\"");
    CHECK(refusal(ascii("0 0 0\n1 0                            \n0 1 0\n")) == "mesh.ply:11: coordinate z is missing");
    CHECK(refusal(ascii("0 0 0\n1 0 0                          \n")) ==
          "mesh.ply:11: the file ends after 2 of 3 elements \"vertex\"");
}

TEST_CASE("a list that is passed over must be whole") {
    std::string text = ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1 2");
    text.insert(text.find("end_header"), "property list int float texcoord\n");
    CHECK(parse(text + " 2 0.5 0.5\n").triangles.size() == 1);
    CHECK(refusal(text + " 2 0.5\n") == "mesh.ply:14: a number is missing");
    CHECK(refusal(text + " 9000000000 0.5\n") == "mesh.ply:14: a number is missing");
    CHECK(refusal(text + " -1\n") == "mesh.ply:14: length of a list is -1");
    for (const BinaryFormat& format : binary_formats) {
        const bool big = format.big_endian;
        std::string binary = header(format.name, "3", "1") + std::string(36, '\0') + '\3';
        for (const std::uint64_t corner : {0u, 1u, 2u}) binary += bytes(corner, 4, big);
        binary.insert(binary.find("end_header"), "property list int float texcoord\n");
        CHECK(parse(binary + bytes(2, 4, big) + std::string(8, '\0')).triangles.size() == 1);
        CHECK(refusal(binary + bytes(2, 4, big) + std::string(7, '\0')) ==
              "mesh.ply: element \"face\" 0: the file ends within it");
        CHECK(refusal(binary + bytes(0xffffffff, 4, big)) == "mesh.ply: element \"face\" 0: length of a list is -1");
    }
}

TEST_CASE("what is wrong in a binary PLY is said with its element") {
    for (const BinaryFormat& format : binary_formats) {
        const bool big = format.big_endian;
        const auto with_face = [&](std::uint64_t corners_claimed, std::uint64_t last) {
            return header(format.name, "3", "1") + std::string(36, '\0') + bytes(corners_claimed, 1, big) + bytes(0, 4, big) +
                   bytes(1, 4, big) + bytes(last, 4, big);
        };
        CHECK(parse(with_face(3, 2)).triangles.size() == 1);
        CHECK(refusal(with_face(3, 3)) == "mesh.ply: element \"face\" 0: vertex index 3 is out of range 0 ... 2");
        CHECK(refusal(with_face(3, 0xffffffff)) == "mesh.ply: element \"face\" 0: vertex index -1 is out of range 0 ... 2");
        CHECK(refusal(with_face(2, 2)) == "mesh.ply: element \"face\" 0: a face needs 3 corners or more, this one has 2");
        CHECK(refusal(with_face(4, 2)) == "mesh.ply: element \"face\" 0: the file ends within it");
        for (const float number : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            std::string text = with_face(3, 2);
            text.replace(text.find("end_header\n") + 11 + 12 + 4, 4, float_bytes(number, big));
            CHECK(refusal(text) == "mesh.ply: element \"vertex\" 1: coordinate y is not finite");
        }
    }
}

TEST_CASE("a PLY cut off anywhere is refused or, behind its last number, whole") {
    for (const BinaryFormat& format : binary_formats) {
        std::string text = header(format.name, "3", "1") + std::string(36, '\0') + '\3';
        for (const std::uint64_t corner : {0u, 1u, 2u}) text += bytes(corner, 4, format.big_endian);
        for (std::size_t length = 0; length < text.size(); ++length) {
            INFO(length);
            CHECK(refusal(text.substr(0, length)).starts_with("mesh.ply:"));
        }
        CHECK(parse(text).triangles.size() == 1);
    }
}

}  // namespace percale::scenes::test::ply_file_test
