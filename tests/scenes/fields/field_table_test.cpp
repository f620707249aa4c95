#include "scenes/fields/field_table.h"

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::field_table_test {
namespace {

struct Square {
    double side = 1.0;
};
struct Circle {
    double radius = 1.0;
};
struct Inner {
    int count = 4;
};
struct Thing {
    std::string label = "thing";
    std::variant<std::monostate, Square, Circle> form;
    Inner inner;
    std::optional<Inner> extra;
    std::vector<Inner> list;
    std::optional<double> weight;
    int unit = 10;
};

constexpr std::string_view units[] = {"one", "ten"};

FieldTable<Inner> inner_table() {
    return {.fields = {value_field<Inner>({.path = "count", .sentence = "How many.", .lowest = 0, .highest = 9}, &Inner::count)},
            .finish = [](const TomlNode& node, Inner& inner) {
                if (inner.count == 7) throw SceneFileError(node.place, "not seven");
            }};
}

FieldTable<Thing> thing_table() {
    const FieldTable<Square> square = {.fields = {value_field<Square>({.path = "side", .sentence = "Side."}, &Square::side)}};
    return {
        .fields = {value_field<Thing>({.path = "label", .sentence = "Label."}, &Thing::label),
                   variant_table<Square, Thing>({.path = "square", .sentence = "A square."}, &Thing::form, square),
                   word_field<Thing>({.path = "unit", .sentence = "Unit.", .needs = "square", .needs_why = "unit is of squares"},
                                     &Thing::unit, units, std::vector{1, 10}),
                   variant_value<Circle, Thing>({.path = "circle", .sentence = "Radius."}, &Thing::form, &Circle::radius),
                   table_field<Thing>({.path = "inner", .sentence = "Inside."}, &Thing::inner, inner_table()),
                   table_field<Thing>({.path = "extra", .sentence = "Inside, too."}, &Thing::extra, inner_table()),
                   list_field<Thing>({.path = "list", .sentence = "Many."}, &Thing::list, inner_table()),
                   value_field<Thing>({.path = "weight", .sentence = "Weight."}, &Thing::weight)},
        .rules = {.shown = [](const TomlNode&) -> std::string { return "thing"; },
                  .at_least_one = {"label", "weight", "unit"},
                  .at_least_one_why = "what it is",
                  .exclude = {{"weight", "inner.count"}}}};
}

Thing thing(const std::string& text) { return read_spec(parse_toml(text, "t"), thing_table()); }
std::string fault(const std::string& text) {
    return error_of([&] { thing(text); });
}

std::vector<std::string> keys_written(const Thing& thing) {
    std::vector<std::string> keys;
    for (const TomlNode& entry : spec_node(thing_table(), thing).entries) keys.push_back(entry.key);
    return keys;
}

}  // namespace

TEST_CASE("rows read what is said and leave the rest") {
    const Thing read = thing("label = \"a\"\nsquare = { side = 3 }\nunit = \"one\"\ninner = {}\nlist = [{ count = 1 }, {}]\n");
    CHECK(read.label == "a");
    CHECK(std::get<Square>(read.form).side == 3.0);
    CHECK(read.unit == 1);
    CHECK(read.inner.count == 4);
    CHECK_FALSE(read.extra.has_value());
    REQUIRE(read.list.size() == 2);
    CHECK(read.list[0].count == 1);
    CHECK_FALSE(read.weight.has_value());
    CHECK(std::get<Circle>(thing("weight = 2\ncircle = 5\nextra = {}\n").form).radius == 5.0);
    CHECK(thing("weight = 2\ncircle = 5\nextra = {}\n").extra->count == 4);
}

TEST_CASE("what is chosen is written where the first alternative stands, and nothing is written of what is not there") {
    Thing one;
    one.form = Circle{2.0};
    CHECK(keys_written(one) == std::vector<std::string>{"label", "circle", "unit", "inner", "list"});
    one.form = Square{};
    one.weight = 3.0;
    one.extra.emplace();
    CHECK(keys_written(one) == std::vector<std::string>{"label", "square", "unit", "inner", "extra", "list", "weight"});
}

TEST_CASE("kind, count and default follow from the field") {
    const std::vector<SceneKey> keys = keys_of(thing_table());
    const auto key = [&](const std::string& path) {
        for (const SceneKey& one : keys)
            if (one.path == path) return one;
        return SceneKey{};
    };
    CHECK(key("label").kind == KeyKind::text);
    CHECK(key("label").default_text == "\"thing\"");
    CHECK(key("unit").kind == KeyKind::word);
    CHECK(key("unit").default_text == "ten");
    CHECK(key("circle").kind == KeyKind::number);
    CHECK(key("circle").alternative);
    CHECK(key("circle").default_text.empty());
    CHECK(key("weight").default_text.empty());
    CHECK(key("list").kind == KeyKind::table_list);
    REQUIRE(key("list").inside.size() == 1);
    CHECK(key("list").inside[0].default_text == "4");
}

TEST_CASE("faults against the rules of a table are reported at their places") {
    const std::string form = "circle = 5\n";
    CHECK(fault(form) == "t:1:1: thing lacks 'label', 'weight' or 'unit': what it is");
    CHECK(fault(form + "weight = 1\ninner = { count = 3 }\n") == "t:3:11: thing: weight and inner.count exclude each other");
    CHECK(fault("weight = 1\n") == "t:1:1: thing must have exactly one of square, circle; it has none");
    CHECK(fault("weight = 1\nsquare = {}\ncircle = 5\n") ==
          "t:1:1: thing must have exactly one of square, circle; it has square, circle");
    CHECK(fault(form + "unit = \"one\"\n") == "t:2:8: unit is of squares; without square it means nothing");
    CHECK(fault(form + "weight = 1\nextra = { count = 7 }\n") == "t:3:9: not seven");
}

TEST_CASE("faults of a list go to the list of faults, one an item, and the others are read") {
    Thing read;
    FaultList all(true);
    read_fields(parse_toml("label = \"a\"\ncircle = 1\nlist = [{ count = 7 }, { count = 2 }, { count = 7 }]\n", "t"),
                thing_table(), read, all);
    CHECK(all.found.size() == 2);
    REQUIRE(read.list.size() == 1);
    CHECK(read.list[0].count == 2);
}

}  // namespace percale::scenes::test::field_table_test
