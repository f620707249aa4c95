#include "scenes/format/scene_table.h"

#include <algorithm>
#include <set>

#include "percale/options.h"
#include "scenes/common/text.h"
#include "scenes/format/expectations.h"
#include "scenes/format/scene_file.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_table_test {
namespace {

bool is_table(const SceneKey& key) {
    return key.kind == KeyKind::table || key.kind == KeyKind::table_or_list || key.kind == KeyKind::table_list ||
           key.kind == KeyKind::named_tables;
}

std::string parent_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

}  // namespace

TEST_CASE("every key has its own path, lies in a table listed before it, and has a sentence") {
    std::set<std::string> seen;
    for (const SceneKey& key : scene_keys()) {
        CAPTURE(key.path);
        CHECK(key.sentence.size() > 4);
        CHECK(key.sentence.back() == '.');
        if (key.path.find('.') != std::string::npos) {
            const SceneKey* parent = find_scene_key(parent_of(key.path));
            REQUIRE(parent != nullptr);
            CHECK((is_table(*parent) || parent->kind == KeyKind::vertices));
            CHECK(seen.contains(parent->path));
        }
        CHECK(seen.insert(key.path).second);
    }
}

TEST_CASE("every number has a range, every word its choices, every list its count") {
    for (const SceneKey& key : scene_keys()) {
        CAPTURE(key.path);
        const bool number = key.kind == KeyKind::number || key.kind == KeyKind::integer || key.kind == KeyKind::number_or_auto ||
                            key.kind == KeyKind::integer_or_auto;
        const bool list = key.kind == KeyKind::numbers || key.kind == KeyKind::integers;
        if (number || list || key.kind == KeyKind::box) CHECK(key.lowest <= key.highest);
        if (number || list) CHECK_FALSE(range_text(key).empty());
        CHECK((key.count > 0) == (list || key.kind == KeyKind::names));
        CHECK((!key.choices.empty()) == (key.kind == KeyKind::word || key.kind == KeyKind::words));
    }
}

TEST_CASE("a required key has no default, and a default word is one of the choices") {
    for (const SceneKey& key : scene_keys()) {
        CAPTURE(key.path);
        if (key.required) CHECK(key.default_text.empty());
        if (key.kind == KeyKind::word && !key.default_text.empty())
            CHECK(std::count(key.choices.begin(), key.choices.end(), key.default_text) == 1);
    }
}

TEST_CASE("every option of fabrics and steps is a key with the same range, unit and sentence") {
    const auto compare = [](const std::string& table, const auto& option) {
        const SceneKey* key = find_scene_key(table + "." + std::string(option.key));
        CAPTURE(option.key);
        REQUIRE(key != nullptr);
        CHECK(key->lowest == option.lowest);
        CHECK(key->highest == option.highest);
        CHECK(key->unit == option.unit);
        CHECK(key->sentence == option.sentence);
        CHECK(key->choices.size() == option.choices.size());
    };
    for (const auto& option : fabric_options()) compare("fabric", option);
    for (const auto& option : step_options()) compare("step", option);
}

TEST_CASE("defaults are those of the structs") {
    CHECK(find_scene_key("fabric.area_density")->default_text == number_text(Fabric{}.area_density));
    CHECK(find_scene_key("fabric.springs.bend")->default_text == number_text(Fabric{}.springs.bend));
    CHECK(find_scene_key("step.time_step")->default_text == number_text(StepSettings{}.time_step));
    CHECK(find_scene_key("step.newton_tolerance")->default_text == "auto");
    CHECK(find_scene_key("step.scheme")->default_text == "backward_euler");
    CHECK(find_scene_key("step.detector")->default_text == "fcl");
    CHECK(find_scene_key("duration")->default_text == number_text(Scene{}.duration));
    CHECK(find_scene_key("max_duration")->default_text == number_text(Scene{}.max_duration));
    CHECK(find_scene_key("gravity")->default_text == "[0, -9.81, 0]");
    CHECK(find_scene_key("obstacle.friction")->default_text == number_text(ObstacleSpec{}.friction));
    CHECK(find_scene_key("output.fps")->default_text == number_text(OutputSpec{}.fps));
}

TEST_CASE("a scene that says every default aloud is the scene that says nothing") {
    std::string text = "title = \"\"\n";
    for (const SceneKey& key : scene_keys()) {
        const bool at_top = key.path == "duration" || key.path == "gravity";
        if (at_top) text += key.path + " = " + key.default_text + "\n";
    }
    const Scene said = parse_scene(text + small_scene(), "t");
    std::vector<Override> overrides;
    for (const SceneKey& key : scene_keys())
        if ((key.path.starts_with("step.") || key.path.starts_with("output.")) && !key.default_text.empty())
            overrides.push_back({key.path, key.default_text});
    const Scene set = parse_scene(small_scene(), "t", overrides);
    const Scene silent = parse_scene(small_scene(), "t");
    CHECK(said.duration == silent.duration);
    CHECK(said.step.gravity == silent.step.gravity);
    CHECK(set.step.time_step == silent.step.time_step);
    CHECK(set.step.scheme == silent.step.scheme);
    CHECK(set.step.newton_tolerance == silent.step.newton_tolerance);
    CHECK(set.step.newton_iterations == silent.step.newton_iterations);
    CHECK(set.detector == silent.detector);
    CHECK(set.output.frames == silent.output.frames);
    CHECK(set.output.fps == silent.output.fps);
}

TEST_CASE("keys inside a table are named without its path") {
    const std::vector<std::string> springs = keys_inside("fabric.springs");
    CHECK(springs == std::vector<std::string>{"structural", "shear", "bend"});
    const std::vector<std::string> top = keys_inside("");
    CHECK(std::count(top.begin(), top.end(), "step") == 1);
    CHECK(std::count(top.begin(), top.end(), "time_step") == 0);
    CHECK(keys_inside("fabric.thickness").empty());
    CHECK(find_scene_key("fabric.stiffness") == nullptr);
}

TEST_CASE("every measure may be expected") {
    for (const MeasureDescription& measure : measure_descriptions()) {
        REQUIRE(find_scene_key("expect." + measure.name) != nullptr);
        CHECK(find_scene_key("expect." + measure.name)->kind == KeyKind::limit);
    }
    CHECK(find_scene_key("expect.matches.file") != nullptr);
}

}  // namespace percale::scenes::test::scene_table_test
