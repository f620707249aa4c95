#include <cstdlib>

#include "tests/scenes/program/run_program.h"
#include "tests/support/catch.h"

namespace percale::program::test::make_data_test {
namespace {

int exit_code_of(const TestFolder& folder, const std::string& arguments) {
    const std::string command =
        quoted(PERCALE_MAKE_DATA) + " " + arguments + " >" + quoted(folder.path("out")) + " 2>" + quoted(folder.path("error"));
    return WEXITSTATUS(std::system(command.c_str()));
}

}  // namespace

TEST_CASE("percale_make_data writes the shipped meshes byte for byte", "[slow]") {
    const TestFolder folder;
    REQUIRE(exit_code_of(folder, quoted(folder.path("new/meshes"))) == 0);
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PERCALE_DATA_DIR "/meshes")) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string stored{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        CHECK(folder.read("new/meshes/" + entry.path().filename().string()) == stored);
        ++files;
    }
    CHECK(files == 7);
    CHECK(folder.file_count() == files + 2);  // and what it printed
    CHECK(folder.read("error").empty());
}

TEST_CASE("percale_make_data refuses wrong use and a folder that cannot be made") {
    const TestFolder folder;
    CHECK(exit_code_of(folder, "") == 2);
    CHECK(folder.read("error") == "usage: percale_make_data OUTDIR\n");
    folder.write("taken", "");
    CHECK(exit_code_of(folder, quoted(folder.path("taken/meshes"))) == 2);
    CHECK(folder.read("error").find("percale_make_data: ") == 0);
    CHECK(line_count(folder.read("error")) == 1);
}

}  // namespace percale::program::test::make_data_test
