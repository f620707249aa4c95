#include "scenes/meshes/stitch_file.h"

#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::stitch_file_test {
namespace {

std::string file_of(const TestFolder& folder, const std::string& text) {
    folder.write("stitches.txt", text);
    return folder.path("stitches.txt");
}

}  // namespace

TEST_CASE("a line is a pair of vertices, or a vertex and a point of an edge, as other programs write it") {
    const TestFolder folder;
    const std::vector<Stitch> stitches =
        read_stitch_file(file_of(folder, "# seam\n1 2\n\n  3 4 5 5.263158e-002  # hem\r\n6 7 8 1\n"));
    CHECK(stitches == std::vector<Stitch>{{1, 2, 2, 0.0}, {3, 4, 5, 0.05263158}, {6, 7, 8, 1.0}});
}

TEST_CASE("an OBJ file's stitches are its lines of that keyword") {
    const TestFolder folder;
    const std::string file = file_of(folder, "v 0 0 0\nf 1 2 3\nstitch 0 2 1 0.25\n# stitch 9 9\nstitch 1 2\n");
    CHECK(read_obj_stitches(file) == std::vector<Stitch>{{0, 2, 1, 0.25}, {1, 2, 2, 0.0}});
    CHECK(find_obj_stitches(file) == read_obj_stitches(file));
    const std::string none = file_of(folder, "v 0 0 0\n# stitch 0 1\n");
    CHECK(find_obj_stitches(none).empty());
    CHECK_THROWS_AS(read_obj_stitches(none), SceneError);
}

TEST_CASE("what is no stitch is reported with its line") {
    const TestFolder folder;
    const auto message = [&](const std::string& text) {
        const std::string file = file_of(folder, text);
        return message_of([&] { read_stitch_file(file); }).substr(file.size());
    };
    CHECK(message("0 1\n0\n") == ":2: vertex is missing");
    CHECK(message("0 -1\n") == ":1: vertex -1: vertices are counted from 0");
    CHECK(message("0 1 2\n") == ":1: share t is missing");
    CHECK(message("0 1 2 1.5\n") == ":1: share t = 1.500000 is outside the allowed range 0 ... 1");
    CHECK(message("0 1 2 0.5 6\n") == ":1: a stitch is two vertices i j, or i j k t, without \"6\"");
    CHECK(message("0 one\n") == ":1: vertex is not a whole number: \"one\"");
    CHECK(message("# nothing\n") == ": no stitches");
    CHECK(message_of([&] { read_obj_stitches(folder.path("not_there.obj")); }).find("cannot be read") != std::string::npos);
}

}  // namespace percale::scenes::test::stitch_file_test
