#include "whole_file.h"

#include <filesystem>
#include "percale/error.h"
#include "tests/scenes/test_folder.h"

#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;
using percale::scenes::test::TestFolder;

TEST_CASE("a device is refused and not replaced") {
    if (!std::filesystem::is_character_file("/dev/full")) return;
    CHECK_THROWS_WITH(WholeFile("/dev/full"), Catch::Contains("not a regular file"));
    CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("a whole file appears at once, when it is committed") {
    const TestFolder folder;
    WholeFile file(folder.path("a.txt"));
    file.out() << "one\n";
    CHECK_FALSE(folder.holds("a.txt"));
    file.commit();
    CHECK(folder.read("a.txt") == "one\n");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a whole file that is given up leaves nothing, and an older one as it was") {
    const TestFolder folder;
    folder.write("a.txt", "old");
    { WholeFile(folder.path("a.txt")).out() << "new"; }
    { WholeFile(folder.path("b.txt")).out() << "new"; }
    CHECK(folder.read("a.txt") == "old");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a whole file replaces an older one") {
    const TestFolder folder;
    folder.write("a.txt", "something longer than the new text");
    write_whole_file(folder.path("a.txt"), "new");
    CHECK(folder.read("a.txt") == "new");
}

TEST_CASE("a file that cannot be written is named with the reason") {
    const TestFolder folder;
    CHECK_THROWS_AS(WholeFile(folder.path("absent/a.txt")), SceneError);
    CHECK_THROWS_WITH(WholeFile(folder.path("absent/a.txt")), Catch::Contains("absent/a.txt") && Catch::Contains("No such file"));
}

TEST_CASE("what could not be written is told while writing, not only at the end") {
    if (!std::filesystem::exists("/dev/full")) return;
    const TestFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.path("a.txt.part"));
    WholeFile file(folder.path("a.txt"));
    CHECK_NOTHROW(file.check());
    file.out() << std::string(1 << 20, 'x');
    CHECK_THROWS_WITH(file.check(), Catch::Contains("a.txt") && Catch::Contains("No space left"));
}

TEST_CASE("a full disk is an error, not a short file") {
    if (!std::filesystem::exists("/dev/full")) return;
    const TestFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.path("a.txt.part"));
    WholeFile file(folder.path("a.txt"));
    file.out() << "text";
    CHECK_THROWS_WITH(file.commit(), Catch::Contains("a.txt"));
    CHECK_FALSE(folder.holds("a.txt"));
}
