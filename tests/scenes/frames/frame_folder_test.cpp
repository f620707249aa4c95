#include "scenes/frames/frame_folder.h"

#include <fstream>

#include "percale/error.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::frame_folder_test {
namespace {

void put(FrameFolder& folder, const std::string& name, const std::string& text) {
    folder.write(name, [&](const std::string& path) { write_whole_file(path, text); });
}

}  // namespace

TEST_CASE("nothing is there before the first file, and a folder that has become empty goes again") {
    const TestFolder folder;
    {
        FrameFolder files(folder.path());
        CHECK_FALSE(folder.holds("frames"));
        put(files, "frames/a.txt", "a");
        put(files, "obstacles/b.txt", "b");
        CHECK(folder.read("frames/a.txt") == "a");
        files.discard();
        CHECK(folder.file_count() == 0);
        CHECK(folder.holds("frames"));
    }
    CHECK_FALSE(folder.holds("frames"));
    CHECK_FALSE(folder.holds("obstacles"));
}

TEST_CASE("what is kept stays, what is written after that is discarded") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    put(files, "frames/0.txt", "kept");
    files.keep();
    put(files, "frames/1.txt", "not kept");
    files.discard();
    CHECK(folder.read("frames/0.txt") == "kept");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a file that could not be written is not one of the folder's, and an older one of its name stays") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    put(files, "frames/0.txt", "first");
    files.keep();
    const auto fails = [](const std::string&) { throw SceneError("no space"); };
    CHECK_THROWS_WITH(files.write("frames/0.txt", fails), Catch::Contains("no space"));
    files.discard();
    CHECK(folder.read("frames/0.txt") == "first");
}

TEST_CASE("a file grows under its temporary name and is whole at the end") {
    const TestFolder folder;
    {
        FrameFolder files(folder.path());
        files.grown("frames/all.txt") << "one ";
        files.grown("frames/all.txt") << "two";
        files.check();
        CHECK_FALSE(folder.holds("frames/all.txt"));
        files.finish();
        CHECK(folder.read("frames/all.txt") == "one two");
    }
    CHECK(folder.read("frames/all.txt") == "one two");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a file that grows is gone where the run fails, also if it had become whole") {
    const TestFolder folder;
    for (const bool whole : {false, true}) {
        {
            FrameFolder files(folder.path());
            files.grown("frames/all.txt") << "one";
            if (whole) files.finish();
            files.discard();
        }
        CHECK(folder.file_count() == 0);
    }
}

TEST_CASE("scratch is read at the end and goes, but stays under its temporary name for a checkpoint") {
    const TestFolder folder;
    for (const bool checkpoint : {false, true}) {
        {
            FrameFolder files(folder.path());
            files.grown("frames/all.samples") << "one two";
            if (checkpoint) {
                files.sync();
                files.keep();
            }
            const std::string scratch = files.scratch("frames/all.samples");
            CHECK(std::ifstream(scratch).peek() == 'o');
            put(files, "frames/all.txt", "made of it");
            files.finish();
        }
        CHECK(folder.read("frames/all.txt") == "made of it");
        CHECK_FALSE(folder.holds("frames/all.samples"));
        CHECK(folder.holds("frames/all.samples.part") == checkpoint);
    }
}

TEST_CASE("what a checkpoint knows of a file that grows is gone on with, in its folder or another") {
    for (const std::string name : {"left", "new"}) {
        const TestFolder folder;
        std::vector<GrownFile> state;
        {
            FrameFolder files(folder.path("left"));
            files.grown("frames/all.txt") << "-- one ";
            state = files.sync();
            files.keep();
            files.grown("frames/all.txt") << "lost";
            files.discard();
        }
        REQUIRE(state.size() == 1);
        CHECK(state[0].bytes == 7);
        CHECK(folder.read("left/frames/all.txt.part") == "-- one lost");
        {
            FrameFolder files(folder.path(name));
            files.go_on(folder.path("left"), state[0], name == "left");
            files.grown("frames/all.txt") << "two";
            files.grown("frames/all.txt").seekp(0) << "ab";
            CHECK(files.sync()[0].bytes == 10);
            files.grown("frames/all.txt") << "!";
            files.finish();
        }
        CHECK(folder.read(name + "/frames/all.txt") == "ab one two!");
        CHECK(folder.holds("left/frames/all.txt.part") == (name == "new"));
    }
}

TEST_CASE("a run that fails after it was gone on with leaves what the checkpoint needs in its own folder only") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("left/frames"));
    folder.write("left/frames/all.txt", "one two");
    for (const std::string name : {"new", "left"}) {
        FrameFolder files(folder.path(name));
        files.go_on(folder.path("left"), {"frames/all.txt", 3}, name == "left");
        files.grown("frames/all.txt") << " more";
        files.discard();
    }
    CHECK_FALSE(folder.holds("new"));
    CHECK_FALSE(folder.holds("left/frames/all.txt"));
    CHECK(folder.read("left/frames/all.txt.part") == "one more");
}

TEST_CASE("files that are not there or too short are refused by name") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("left/frames"));
    folder.write("left/frames/all.txt", "one");
    FrameFolder files(folder.path("new"));
    CHECK_THROWS_WITH(files.go_on(folder.path("left"), {"frames/all.txt", 4}, false), Catch::Contains("left/frames/all.txt"));
    CHECK_THROWS_WITH(files.go_on(folder.path("left"), {"frames/none.txt", 0}, false), Catch::Contains("left/frames/none.txt"));
    CHECK_THROWS_WITH(files.copy(folder.path("left"), "frames/none.txt"), Catch::Contains("cannot be copied to"));
}

}  // namespace percale::scenes::test::frame_folder_test
