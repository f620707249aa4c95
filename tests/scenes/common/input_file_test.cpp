#include "common/input_file.h"

#include <sys/stat.h>

#include "percale/error.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::input_file_test {

TEST_CASE("a file is read as bytes and as a text, whatever they are; a mark of UTF-8 is no part of the text") {
    const TestFolder folder;
    const std::string text("a\0\r\n\xff", 5);
    const std::string file = folder.write("some.bin", text);
    CHECK(read_text(file) == text);
    CHECK(read_bytes(file).size() == 5);
    CHECK(message_of([&] { read_text(folder.path("none")); }) ==
          folder.path("none") + ": cannot be read: No such file or directory");
    CHECK(read_text(folder.write("marked", "\xEF\xBB\xBFtext")) == "text");
    CHECK(read_bytes(folder.path("marked")).size() == 7);
    CHECK(read_text(folder.write("empty", "")).empty());
}

TEST_CASE("text in wide characters is refused by name") {
    const TestFolder folder;
    for (const std::string& mark :
         {std::string("\xFF\xFE"), std::string("\xFE\xFF"), std::string("\0\0\xFE\xFF", 4), std::string("\xFF\xFE\0\0", 4)}) {
        const std::string file = folder.write("wide", mark + std::string("a\0", 2));
        CHECK(message_of([&] { read_text(file); }) == file + ": is UTF-16 or UTF-32 text; save it as UTF-8");
    }
    for (const std::string& unmarked : {std::string("O\0F\0F\0", 6), std::string("\0O\0F\0F", 6)}) {
        const std::string file = folder.write("unmarked", unmarked);
        CHECK(message_of([&] { read_text(file); }) == file + ": is UTF-16 or UTF-32 text; save it as UTF-8");
    }
    CHECK(read_text(folder.write("zero", std::string("a\0bc", 4))).size() == 4);
}

TEST_CASE("what may give bytes for ever, or none, is refused at once") {
    const TestFolder folder;
    const std::string pipe = folder.path("pipe");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const std::string& file : {pipe, std::string("/dev/zero"), std::string("/dev/null")}) {
        for (const auto& read :
             {+[](const std::string& name) { read_bytes(name); }, +[](const std::string& name) { open_input(name); }})
            CHECK(message_of([&] { read(file); }) == file + ": cannot be read: it is a device or a pipe, not a file");
    }
    CHECK(message_of([&] { open_input(folder.path()); }) == folder.path() + ": cannot be read: it is a folder");
    CHECK_FALSE(open_input(folder.path("none")));
}

}  // namespace percale::scenes::test::input_file_test
