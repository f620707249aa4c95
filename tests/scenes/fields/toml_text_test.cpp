#include "scenes/fields/toml_text.h"

#include <cmath>
#include <limits>

#include "percale/error.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::toml_text_test {
namespace {

TomlNode value(const std::string& text) { return parse_toml_value(text, {.file = "t"}); }

TomlNode number(double x) {
    TomlNode node;
    node.kind = TomlKind::number;
    node.number = x;
    return node;
}

TomlNode text_node(const std::string& text) {
    TomlNode node;
    node.kind = TomlKind::text;
    node.text = text;
    return node;
}

bool same(const TomlNode& a, const TomlNode& b) {
    const auto all = [](const std::vector<TomlNode>& x, const std::vector<TomlNode>& y) {
        return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                          [](const TomlNode& one, const TomlNode& other) { return one.key == other.key && same(one, other); });
    };
    return a.kind == b.kind && a.text == b.text && a.integer == b.integer && a.number == b.number && all(a.items, b.items) &&
           all(a.entries, b.entries);
}

}  // namespace

TEST_CASE("numbers written as TOML read back in every bit, and as numbers") {
    for (const double x : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3.0, 123456789.0, 1e22}) {
        const TomlNode back = value(toml_text(number(x)));
        CHECK(back.kind == TomlKind::number);
        CHECK(back.number == x);
        CHECK(std::signbit(back.number) == std::signbit(x));
    }
    CHECK(std::isinf(value(toml_text(number(std::numeric_limits<double>::infinity()))).number));
    CHECK(std::isnan(value(toml_text(number(std::numeric_limits<double>::quiet_NaN()))).number));
}

TEST_CASE("texts written as TOML keep quotes, backslashes, control letters and line breaks") {
    for (const char* text : {"", "plain", "a \"quoted\" \\ one", "two\nlines\r\tand more", "\x01\x1f\x7f", "é", "true", "1.5"}) {
        const TomlNode back = value(toml_text(text_node(text)));
        CHECK(back.kind == TomlKind::text);
        CHECK(back.text == text);
    }
}

TEST_CASE("lists and tables written as TOML are inline and the same") {
    for (const char* text : {"[]", "{}", "[1, 2.5, \"three\", true, [4]]", "{a = 1, \"b c\" = [{d = false}], e = {f = \"g\"}}",
                             "9223372036854775807"}) {
        const TomlNode node = value(text);
        CHECK(same(value(toml_text(node)), node));
        CHECK(toml_text(node).find('\n') == std::string::npos);
    }
}

TEST_CASE("a date, whose value no node holds, cannot be written") {
    CHECK_THROWS_AS(toml_text(value("1979-05-27")), percale::SceneError);
}

}  // namespace percale::scenes::test::toml_text_test
