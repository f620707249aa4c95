#include "scenes/format/toml_values.h"

#include <cmath>

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;

TEST_CASE("a dotted key finds a value inside tables, and nothing where one is missing") {
    const TomlNode document = parse_toml("a = { b = { c = 3 } }\n", "t");
    CHECK(find_value(document, "a.b.c")->integer == 3);
    CHECK(find_value(document, "a.b") == document.find("a")->find("b"));
    CHECK(find_value(document, "a.x.c") == nullptr);
    CHECK(find_value(document, "a.b.c.d") == nullptr);
    CHECK(find_value(document, "") == nullptr);
}

TEST_CASE("values are read and what is missing stays") {
    const TomlNode document = parse_toml("text = \"x\"\nnumber = 2\nvector = [1, 2.5, 3]\n", "t");
    std::string text = "old", missing_text = "old";
    double number = 7.0, missing_number = 7.0;
    int integer = 7;
    Vec3 vector = Vec3::Zero();
    read_value(document, "text", text);
    read_value(document, "none", missing_text);
    read_value(document, "number", number);
    read_value(document, "none", missing_number);
    read_value(document, "number", integer);
    read_value(document, "vector", vector);
    CHECK(text == "x");
    CHECK(missing_text == "old");
    CHECK(number == 2.0);
    CHECK(missing_number == 7.0);
    CHECK(integer == 2);
    CHECK(vector == Vec3(1.0, 2.5, 3.0));
}

TEST_CASE("an optional value is empty only where the key is missing") {
    const TomlNode document = parse_toml("a = [0, 0, 0]\n", "t");
    std::optional<Vec3> a, b;
    read_value(document, "a", a);
    read_value(document, "b", b);
    CHECK(a.has_value());
    CHECK_FALSE(b.has_value());
}

TEST_CASE("a rounded rotation becomes a unit quaternion") {
    const TomlNode document = parse_toml("r = [0.7071, 0.0, 0.7071, 0.0]\n", "t");
    Rotation r;
    read_value(document, "r", r);
    CHECK(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z == Approx(1.0).epsilon(1e-15));
    CHECK(r.w == r.y);
}

TEST_CASE("a rotation of another length is an error that names the length") {
    for (const char* list : {"[1, 1, 0, 0]", "[0, 0, 0, 0]", "[0.5, 0, 0, 0]"}) {
        const TomlNode document = parse_toml(std::string("r = ") + list, "t");
        Rotation r;
        CHECK(error_of([&] { read_value(document, "r", r); }).starts_with("t:1:5: r must be a unit quaternion"));
    }
    const TomlNode document = parse_toml("r = [0.5, 0, 0, 0]\n", "t");
    Rotation r;
    CHECK(error_of([&] { read_value(document, "r", r); }).find("its length is 0.5") != std::string::npos);
}

TEST_CASE("of several keys exactly one must be there") {
    const TomlNode none = parse_toml("x = 1\n", "t"), one = parse_toml("a = 1\nx = 1\n", "t"),
                   both = parse_toml("a = 1\nb = 1\n", "t");
    CHECK(only_key(one, {"a", "b"}, "thing") == "a");
    CHECK(error_of([&] { only_key(none, {"a", "b"}, "thing"); }).ends_with("thing must have exactly one of a, b; it has none"));
    CHECK(error_of([&] { only_key(both, {"a", "b"}, "thing"); }).ends_with("thing must have exactly one of a, b; it has a, b"));
}
