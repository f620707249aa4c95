#include "scenes/meshes/stl_header.h"

#include <cstdint>

#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::stl_header_test {
namespace {

std::string refusal_of(const std::string& content) {
    const TestFolder folder;
    const std::string file = folder.write("mesh.stl", content);
    const std::string message = message_of([&] { check_stl_header(file); });
    return message.starts_with(file) ? message.substr(file.size()) : message;
}

std::string binary_stl(std::uint32_t claimed, std::size_t held, const std::string& title = "made by a test") {
    std::string text = title + std::string(80 - title.size(), ' ');
    for (int k = 0; k < 4; ++k) text += static_cast<char>(claimed >> (8 * k) & 255);
    return text + std::string(50 * held, '\0');
}

}  // namespace

TEST_CASE("a binary STL needs 50 bytes a triangle") {
    CHECK(refusal_of(binary_stl(2, 2)).empty());
    CHECK(refusal_of(binary_stl(1, 2)).empty());
    CHECK(refusal_of(binary_stl(3, 2)) == ": the header claims 3 triangles, but the file can hold 2 at most");
    CHECK(refusal_of(binary_stl(0xffffffffu, 1)) == ": the header claims 4294967295 triangles, but the file can hold 1 at most");
    CHECK(refusal_of("short") == ": not an STL file: 5 bytes are less than its header");
}

TEST_CASE("a text STL in wide characters is refused by name") {
    for (const int first : {0, 1}) {
        for (const std::string mark : {"", first == 0 ? "\xFF\xFE" : "\xFE\xFF"}) {
            std::string wide = mark;
            for (const char letter : std::string("solid x\nfacet normal 0 0 1\n"))
                wide += first == 0 ? std::string{letter, 0} : std::string{0, letter};
            CHECK(refusal_of(wide) == ": is UTF-16 or UTF-32 text; save it as UTF-8");
        }
    }
    CHECK(refusal_of(binary_stl(1, 1, std::string("s\0o\0", 4))).empty());
    CHECK(refusal_of(binary_stl(1, 1, std::string("solid\0", 6) + std::string(20, '\0'))).empty());
}

TEST_CASE("a text STL has no counts") {
    CHECK(refusal_of("solid x\nendsolid x\n").empty());
    std::string text = "solid x\n";
    for (int k = 0; k < 10; ++k) text += "facet normal 0 0 1\n";
    CHECK(refusal_of(text).empty());
}

TEST_CASE("an STL file that is gone is refused with the system's reason") {
    CHECK(message_of([] { check_stl_header("no such.stl"); }) == "no such.stl: cannot be read: No such file or directory");
}

}  // namespace percale::scenes::test::stl_header_test
