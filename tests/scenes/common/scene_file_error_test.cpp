#include "scenes/common/scene_file_error.h"

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_file_error_test {

TEST_CASE("a place is file, line and column, without what is unknown") {
    CHECK(place_text({.file = "a.toml", .line = 3, .column = 7}) == "a.toml:3:7");
    CHECK(place_text({.file = "a.obj", .line = 3}) == "a.obj:3");
    CHECK(place_text({.file = "a.toml"}) == "a.toml");
    CHECK(place_text({}).empty());
}

TEST_CASE("an error at a place begins with the place, and has no colon where there is none") {
    CHECK(error_of([] { fail_at({.file = "a.toml", .line = 3, .column = 7}, "is wrong"); }) == "a.toml:3:7: is wrong");
    CHECK(error_of([] { fail_at({}, "is wrong"); }) == "is wrong");
}

TEST_CASE("an error at a place says it as data, too") {
    try {
        fail_at({.file = "a.toml", .line = 3, .column = 7}, "is wrong: very");
        FAIL("nothing was thrown");
    } catch (const SceneFileError& error) {
        CHECK(error.place().file == "a.toml");
        CHECK(error.place().line == 3);
        CHECK(error.place().column == 7);
        CHECK(error.subject() == "a.toml:3:7");
        CHECK(error.reason() == "is wrong: very");
    }
}

TEST_CASE("what is wrong with a named thing gets a place, and what is not wrong passes") {
    const SourcePlace place{.file = "a.toml", .line = 3, .column = 7};
    CHECK(at_place(place, "pin: ", [] { return 5; }) == 5);
    CHECK(error_of([&] { at_place(place, "pin: ", [] { throw SceneError("flag", "torn"); }); }) == "a.toml:3:7: pin: flag: torn");
    CHECK(error_of([&] { at_place(place, "", [] { throw SceneError("torn"); }); }) == "a.toml:3:7: torn");
    CHECK_THROWS_AS(at_place(place, "", [] { throw std::runtime_error("not the scene"); }), std::runtime_error);
}

}  // namespace percale::scenes::test::scene_file_error_test
