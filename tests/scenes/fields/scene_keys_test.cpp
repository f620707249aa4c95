#include "scenes/fields/scene_keys.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::scene_keys_test {

TEST_CASE("what a value must be is said in words, with its count or its choices") {
    CHECK(kind_text({.path = "x", .kind = KeyKind::number}) == "a number");
    CHECK(kind_text({.path = "x", .kind = KeyKind::numbers, .count = 3}) == "a list of 3 numbers");
    CHECK(kind_text({.path = "x", .kind = KeyKind::word, .choices = {"mm", "cm"}}) == "one of mm, cm");
    CHECK(kind_text({.path = "x", .kind = KeyKind::named_tables}) == "a table of named tables");
}

TEST_CASE("ranges are written with both ends and the unit") {
    SceneKey key{.path = "x", .kind = KeyKind::number, .sentence = "X."};
    CHECK(range_text(key).empty());
    key.lowest = 0.0;
    CHECK(range_text(key) == ">= 0");
    key.highest = 10.0;
    key.unit = "m";
    CHECK(range_text(key) == "0 ... 10 m");
    key.lowest = -std::numeric_limits<double>::infinity();
    CHECK(range_text(key) == "<= 10 m");
}

}  // namespace percale::scenes::test::scene_keys_test
