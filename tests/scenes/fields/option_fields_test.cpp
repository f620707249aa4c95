#include "scenes/fields/option_fields.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::option_fields_test {
namespace {

FieldTable<Fabric> table() {
    return {.fields = option_fields<Fabric>(fabric_options(), itself, {.path = "springs", .sentence = "Springs."})};
}

}  // namespace

TEST_CASE("options with a dotted key make a table inside, where the first of them stands") {
    std::vector<std::string> keys;
    for (const SceneKey& key : keys_of(table())) keys.push_back(key.path);
    std::vector<std::string> expected;
    for (const auto& option : fabric_options()) {
        const std::string first(option.key.substr(0, option.key.find('.')));
        if (expected.empty() || expected.back() != first) expected.push_back(first);
    }
    CHECK(keys == expected);
}

TEST_CASE("options that are not set are not written, and are empty again after reading") {
    Fabric fabric;
    TomlNode node = spec_node(table(), fabric);
    CHECK(node.find("bend_stiffness") == nullptr);
    CHECK(node.find("springs")->find("shear") != nullptr);
    fabric.bend_stiffness = 1e-5;
    fabric.membrane = Membrane::van_gelder;
    node = spec_node(table(), fabric);
    const Fabric read = read_spec(node, table());
    CHECK(read.bend_stiffness == 1e-5);
    CHECK(read.membrane == Membrane::van_gelder);
    CHECK_FALSE(read.shear_stiffness.has_value());
}

TEST_CASE("the word auto sets what is automatic and leaves the number") {
    const FieldTable<StepSettings> steps = {.fields = option_fields<StepSettings>(step_options(), itself)};
    StepSettings settings;
    settings.adaptive = true;
    settings.newton_tolerance = 1e-3;
    TomlNode node = spec_node(steps, settings);
    CHECK(node.find("time_step")->text == "auto");
    const StepSettings read = read_spec(node, steps);
    CHECK(read.adaptive);
    CHECK(read.time_step == StepSettings{}.time_step);
    CHECK(read.newton_tolerance == 1e-3);
    settings.newton_tolerance.reset();
    CHECK_FALSE(read_spec(spec_node(steps, settings), steps).newton_tolerance.has_value());
}

}  // namespace percale::scenes::test::option_fields_test
