#include "common/whole_file.h"

#include <filesystem>

#include "common/input_file.h"
#include "percale/error.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::whole_file_test {

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

TEST_CASE("what could not be written is reported while writing, not only at the end") {
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

TEST_CASE("of files committed together none appears where one could not be written") {
    const TestFolder folder;
    {
        WholeFile one(folder.path() + "/one"), other(folder.path() + "/other");
        one.out() << "text";
        other.out().setstate(std::ios::badbit);
        CHECK_THROWS_AS(commit_together({&one, &other}), SceneError);
    }
    CHECK(folder.file_count() == 0);
    WholeFile one(folder.path() + "/one"), other(folder.path() + "/other");
    one.out() << "text";
    commit_together({&one, &other});
    CHECK(folder.read("one") == "text");
    CHECK(folder.holds("other"));
}

TEST_CASE("of a table and its diagram nothing is left, nor of their folder, where one could not be written") {
    const TestFolder folder;
    { TableFiles unfinished(folder.path("new"), "a"); }
    CHECK_FALSE(folder.holds("new"));
    TableFiles whole(folder.path("new"), "a");
    whole.table.out() << "1,2";
    whole.diagram.out() << "<svg/>";
    whole.commit();
    CHECK(folder.read("new/a.csv") == "1,2");
    CHECK(folder.read("new/a.svg") == "<svg/>");
    if (!std::filesystem::exists("/dev/full")) return;
    std::filesystem::create_symlink("/dev/full", folder.path("new/b.svg.part"));
    {
        TableFiles full(folder.path("new"), "b");
        full.table.out() << "1,2";
        full.diagram.out() << "<svg/>";
        CHECK_THROWS_WITH(full.commit(), Catch::Contains("b.svg: cannot be written: No space left on device"));
    }
    CHECK(folder.file_count() == 2);
}

TEST_CASE("a new output folder with nothing in it goes again, others stay") {
    const TestFolder folder;
    { const OutputFolder output(folder.path() + "/a/b/"); }
    CHECK_FALSE(folder.holds("a"));
    { const OutputFolder output(folder.path() + "/a/../c/b"); }
    CHECK_THROWS_AS(OutputFolder(folder.path() + "/a/b/" + std::string(300, 'x')), SceneError);
    CHECK_FALSE(folder.holds("a"));
    CHECK_FALSE(folder.holds("c"));
    {
        const OutputFolder output(folder.path() + "/a/b");
        write_whole_file(folder.path() + "/a/file", "text");
    }
    CHECK(folder.holds("a"));
    CHECK_FALSE(folder.holds("a/b"));
    { const OutputFolder output(folder.path() + "/a"); }
    CHECK(folder.read("a/file") == "text");
    CHECK_THROWS_AS(OutputFolder(folder.path() + "/a/file"), SceneError);
    CHECK(folder.read("a/file") == "text");
}

TEST_CASE("a file that is left unfinished goes on from as many bytes as are wanted") {
    const TestFolder folder;
    const std::string name = folder.path("a.txt");
    {
        WholeFile file(name);
        file.out() << "one\n";
        CHECK(file.sync() == 4);
        CHECK(folder.read("a.txt.part") == "one\n");
        file.out() << "half a li";
        file.leave();
    }
    CHECK_FALSE(folder.holds("a.txt"));
    WholeFile file(name, name + part_suffix, 4);
    file.out() << "two\n";
    CHECK(file.sync() == 8);
    file.commit();
    CHECK(folder.read("a.txt") == "one\ntwo\n");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a file goes on from another one, which stays") {
    const TestFolder folder;
    folder.write("old.txt", "one\ntwo\nthree\n");
    WholeFile file(folder.path("new.txt"), folder.path("old.txt"), 8);
    file.out() << "four\n";
    file.commit();
    CHECK(folder.read("new.txt") == "one\ntwo\nfour\n");
    CHECK(folder.read("old.txt") == "one\ntwo\nthree\n");
    CHECK_THROWS_WITH(WholeFile(folder.path("a.txt"), folder.path("old.txt"), 99), Catch::Contains("old.txt: has 14"));
    CHECK_THROWS_WITH(WholeFile(folder.path("a.txt"), folder.path("absent"), 1), Catch::Contains("absent: cannot be read"));
    CHECK(folder.file_count() == 2);
}

TEST_CASE("bytes come back from a durable file") {
    const TestFolder folder;
    const std::vector<std::byte> bytes = {std::byte{0}, std::byte{255}, std::byte{10}};
    write_durable_file(folder.path("a"), bytes);
    CHECK(read_bytes(folder.path("a")) == bytes);
    CHECK(folder.file_count() == 1);
    CHECK_THROWS_WITH(read_bytes(folder.path("b")), Catch::Contains("b: cannot be read: No such file"));
}

}  // namespace percale::scenes::test::whole_file_test
