#include "scenes/mesh_header.h"

#include <cstdint>

#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

using namespace percale::scenes;
using percale::scenes::test::message_of;
using percale::scenes::test::TestFolder;

namespace {

std::string refusal_of(const std::string& extension, const std::string& content) {
    const TestFolder folder;
    const std::string file = folder.write("mesh" + extension, content);
    const std::string message = message_of([&] { check_mesh_header(file, extension); });
    return message.substr(message.find("mesh" + extension) == std::string::npos ? 0 : file.size());
}

std::string ply_header(const std::string& format, const std::string& vertices, const std::string& faces) {
    return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty double z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_stl(std::uint32_t claimed, std::size_t held, const std::string& title = "made by a test") {
    std::string text = title + std::string(80 - title.size(), ' ');
    for (int k = 0; k < 4; ++k) text += static_cast<char>(claimed >> (8 * k) & 255);
    return text + std::string(50 * held, '\0');
}

}  // namespace

TEST_CASE("a text PLY needs a line for every element") {
    CHECK(refusal_of(".ply", ply_header("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").empty());
    CHECK(refusal_of(".ply", ply_header("ascii", "3", "1") + "0 0 0\r\n1 0 0\r\n\r\n0 1 0\r\n3 0 1 2").empty());
    CHECK(refusal_of(".ply", ply_header("ascii", "536870912", "1") + "0 0 0\n") ==
          ": the header claims 536870912 elements \"vertex\", but the file can hold 1 at most");
    CHECK(refusal_of(".ply", ply_header("ascii", "3", "2") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") ==
          ": the header claims 2 elements \"face\", but the file can hold 1 at most");
}

TEST_CASE("a binary PLY needs the bytes of every element") {
    const std::string format = GENERATE("binary_little_endian", "binary_big_endian");
    const std::string vertices(3 * 16, '\0'), face(13, '\0');
    CHECK(refusal_of(".ply", ply_header(format, "3", "1") + vertices + face).empty());
    CHECK(refusal_of(".ply", ply_header(format, "4", "0") + vertices + face) ==
          ": the header claims 4 elements \"vertex\", but the file can hold 3 at most");
    CHECK(refusal_of(".ply", ply_header(format, "3", "14") + vertices + face) ==
          ": the header claims 14 elements \"face\", but the file can hold 13 at most");
}

TEST_CASE("the counts of a PLY cannot be made to wrap around") {
    const std::string format = GENERATE("binary_little_endian", "ascii");
    CHECK(refusal_of(".ply", ply_header(format, "1152921504606846977", "1") + std::string(64, '0')).find("the header claims") ==
          2);
    CHECK(refusal_of(".ply", ply_header(format, "18446744073709551617", "1")).find(":4: element count is not a whole number") ==
          0);
    CHECK(refusal_of(".ply", ply_header(format, "-3", "1")) == ":4: element count is -3");
}

TEST_CASE("the lists of a PLY must end within the file") {
    const std::string text = ply_header("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n";
    CHECK(refusal_of(".ply", text + "2000000000 0 1 2\n") == ": the file ends within element \"face\" 0");
    CHECK(refusal_of(".ply", text + "-3 0 1 2\n") == ": the file ends within element \"face\" 0");
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
        const std::string vertices(48, '\0'), indices(12, '\0');
        CHECK(refusal_of(".ply", ply_header(format, "3", "1") + vertices + '\3' + indices).empty());
        CHECK(refusal_of(".ply", ply_header(format, "3", "1") + vertices + '\4' + indices) ==
              ": the file ends within element \"face\" 0");
    }
}

TEST_CASE("a PLY header that cannot be understood is refused") {
    CHECK(refusal_of(".ply", "OFF\n") == ":1: not a PLY file: it starts with \"OFF\"");
    CHECK(refusal_of(".ply", "ply\nformat ascii 1.0\nelement vertex 3\n") == ": not a PLY file: its header has no end");
    CHECK(refusal_of(".ply", "ply\nproperty float x\n") == ":2: a property before the first element");
    CHECK(refusal_of(".ply", "ply\nelement vertex 3\nproperty half x\n") == ":3: unknown PLY type \"half\"");
    CHECK(refusal_of(".ply", "ply\nformat binary\n") == ":2: unknown PLY format \"binary\"");
    CHECK(refusal_of(".ply", "ply\nformat ascii 1.0\nformat ascii 1.0\n") == ":3: a second format");
    CHECK(refusal_of(".ply", "ply\ncomment a \x05 b\n") == ":2: a character in the header of a PLY file that is no text: code 5");
    CHECK(refusal_of(".ply", "ply\nend_header\v\n") == ":2: a character in the header of a PLY file that is no text: code 11");
    CHECK(refusal_of(".ply", "ply\nelement 1vertex 3\n") == ":2: a name must begin with a letter, not \"1vertex\"");
    CHECK(refusal_of(".ply", "ply\nelement vertex 3 4\n") == ":2: more than belongs on this line of a PLY header: \"4\"");
    CHECK(refusal_of(".ply", "ply\nelement v\xff 3\n") ==
          ":2: a character in the header of a PLY file that is no text: code 255");
    CHECK(refusal_of(".ply", "ply\nelement vertex 3\nprortey float x\n") ==
          ":3: unknown word in the header of a PLY file: \"prortey\"");
    CHECK(refusal_of(".ply", "ply\nelement face 3\nproperty list float int x\n") ==
          ":3: the length of a list must be a whole number, not a \"float\"");
}

TEST_CASE("a binary STL needs 50 bytes a triangle") {
    CHECK(refusal_of(".stl", binary_stl(2, 2)).empty());
    CHECK(refusal_of(".stl", binary_stl(1, 2)).empty());
    CHECK(refusal_of(".stl", binary_stl(3, 2)) == ": the header claims 3 triangles, but the file can hold 2 at most");
    CHECK(refusal_of(".stl", binary_stl(0xffffffffu, 1)) ==
          ": the header claims 4294967295 triangles, but the file can hold 1 at most");
    CHECK(refusal_of(".stl", "short") == ": not an STL file: 5 bytes are less than its header");
}

TEST_CASE("a text STL has no counts") {
    CHECK(refusal_of(".stl", "solid x\nendsolid x\n").empty());
    std::string text = "solid x\n";
    for (int k = 0; k < 10; ++k) text += "facet normal 0 0 1\n";
    CHECK(refusal_of(".stl", text).empty());
}

TEST_CASE("a file that is gone is refused with the system's reason, other formats are not opened") {
    CHECK(message_of([] { check_mesh_header("no such.ply", ".ply"); }) ==
          "no such.ply: cannot be read: No such file or directory");
    CHECK_NOTHROW(check_mesh_header("no such.dae", ".dae"));
}
