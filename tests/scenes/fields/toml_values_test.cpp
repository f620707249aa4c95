#include "scenes/fields/toml_values.h"

#include <cmath>

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::toml_values_test {

TEST_CASE("a dotted key finds a value inside tables, and nothing where one is missing") {
    const TomlNode document = parse_toml("a = { b = { c = 3 } }\n", "t");
    CHECK(find_value(document, "a.b.c")->integer == 3);
    CHECK(find_value(document, "a.b") == document.find("a")->find("b"));
    CHECK(find_value(document, "a.x.c") == nullptr);
    CHECK(find_value(document, "a.b.c.d") == nullptr);
    CHECK(find_value(document, "") == nullptr);
}

namespace {

TomlNode parsed(const std::string& value) { return parse_toml("x = " + value + "\n", "t").entries.at(0); }

template <class Value>
Value read(const std::string& text) {
    Value value{};
    read_value(parsed(text), value);
    return value;
}

}  // namespace

TEST_CASE("values are read from what a document says") {
    CHECK(read<std::string>("\"text\"") == "text");
    CHECK(read<double>("2") == 2.0);
    CHECK(read<int>("7") == 7);
    CHECK(read<bool>("true"));
    CHECK_FALSE(read<bool>("false"));
    CHECK(read<Vec3>("[1, 2.5, 3]") == Vec3(1.0, 2.5, 3.0));
    CHECK(read<std::array<double, 2>>("[1, 2.5]") == std::array{1.0, 2.5});
    CHECK(read<std::array<int, 2>>("[3, 4]") == std::array{3, 4});
    CHECK(read<std::array<std::string, 2>>("[\"a\", \"b\"]") == std::array<std::string, 2>{"a", "b"});
    CHECK(read<std::vector<std::array<int, 2>>>("[[1, 2], [3, 4]]") == std::vector<std::array<int, 2>>{{1, 2}, {3, 4}});
    CHECK(read<std::vector<std::string>>("[\"a\", \"b\", \"c\"]") == std::vector<std::string>{"a", "b", "c"});
    CHECK(read<std::optional<double>>("2.5") == 2.5);
}

TEST_CASE("a value that is written is read as the same") {
    const auto again = [](const auto& value) {
        std::remove_cvref_t<decltype(value)> read{};
        read_value(value_node(value), read);
        return read;
    };
    for (const double number : {0.1, -0.0, 1e-300, 12345678.9}) CHECK(again(number) == number);
    CHECK(again(-7) == -7);
    CHECK(again(true));
    CHECK(again(std::string("a \"b\"")) == "a \"b\"");
    CHECK(again(Vec3(1.0, -2.0, 0.1)) == Vec3(1.0, -2.0, 0.1));
    CHECK(again(std::vector<std::string>{"x", "y"}) == std::vector<std::string>{"x", "y"});
    CHECK(again(std::array{3, 4}) == std::array{3, 4});
    CHECK_FALSE(value_node(std::optional<double>()).has_value());
}

TEST_CASE("defaults are shown as a scene file writes them, words without quotes") {
    CHECK(value_text(KeyKind::text, value_node(std::string("abc"))) == "\"abc\"");
    CHECK(value_text(KeyKind::word, value_node(std::string("abc"))) == "abc");
    CHECK(value_text(KeyKind::number, value_node(1e-6)) == "1e-6");
    CHECK(value_text(KeyKind::numbers, value_node(Vec3(0.0, -9.81, 0.0))) == "[0, -9.81, 0]");
    CHECK(value_text(KeyKind::flag, value_node(true)) == "true");
}

TEST_CASE("a rounded rotation becomes a unit quaternion") {
    const Rotation r = read_rotation(parsed("[0.7071, 0.0, 0.7071, 0.0]"), "r");
    CHECK(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z == Approx(1.0).epsilon(1e-15));
    CHECK(r.w == r.y);
}

TEST_CASE("a rotation of another length is an error that names the length") {
    for (const char* list : {"[1, 1, 0, 0]", "[0, 0, 0, 0]", "[0.5, 0, 0, 0]"})
        CHECK(error_of([&] { read_rotation(parsed(list), "r"); }).starts_with("t:1:5: r must be a unit quaternion"));
    CHECK(error_of([&] { read_rotation(parsed("[0.5, 0, 0, 0]"), "r"); }).find("its length is 0.5") != std::string::npos);
}

TEST_CASE("of several keys exactly one must be there") {
    const TomlNode none = parse_toml("x = 1\n", "t"), one = parse_toml("a = 1\nx = 1\n", "t"),
                   both = parse_toml("a = 1\nb = 1\n", "t");
    CHECK(only_key(one, {"a", "b"}, "thing") == "a");
    CHECK(error_of([&] { only_key(none, {"a", "b"}, "thing"); }).ends_with("thing must have exactly one of a, b; it has none"));
    CHECK(error_of([&] { only_key(both, {"a", "b"}, "thing"); }).ends_with("thing must have exactly one of a, b; it has a, b"));
}

}  // namespace percale::scenes::test::toml_values_test
