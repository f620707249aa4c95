#include <nlohmann/json.hpp>

#include "scenes/common/scene_file_error.h"
#include "scenes/export/run_settings.h"
#include "scenes/format/scene_check.h"
#include "scenes/format/scene_file.h"
#include "scenes/format/scene_table.h"
#include "tests/scenes/generated_scene.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::field_laws_test {

// Laws of the tables of fields, for every key that there is: nothing here names one of them but where it means more than its
// value.
using nlohmann::ordered_json;
using test::GeneratedScene;

namespace {

bool is_table(KeyKind kind) {
    return kind == KeyKind::table || kind == KeyKind::table_or_list || kind == KeyKind::table_list ||
           kind == KeyKind::named_tables;
}

bool same_value(const TomlNode& a, const TomlNode& b) {
    if (a.is_number() && b.is_number()) return a.number == b.number;
    return a.kind == b.kind && a.text == b.text;
}

/// Checks that all that `said` says is in `held`, too.
void check_held(const TomlNode& said, const TomlNode& held, const std::string& path) {
    CAPTURE(path);
    REQUIRE(said.items.size() == held.items.size());
    for (std::size_t i = 0; i < said.items.size(); ++i) check_held(said.items[i], held.items[i], path);
    for (const TomlNode& entry : said.entries) {
        if (entry.key == "preset" || entry.key == "axis") continue;  // a preset becomes what it stands for, an axis a unit vector
        INFO(entry.key);
        const TomlNode* other = held.find(entry.key);
        REQUIRE(other != nullptr);
        check_held(entry, *other, path + "." + entry.key);
    }
    if (said.items.empty() && said.entries.empty()) CHECK((said.kind == TomlKind::table || same_value(said, held)));
}

std::string toml_of(const ordered_json& json) {
    if (!json.is_structured()) return json.dump();
    std::string text;
    for (const auto& [key, value] : json.items())
        text += (text.empty() ? "" : ", ") + (json.is_object() ? key + " = " : "") + toml_of(value);
    return json.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

/// Drops what means nothing without another key, and lists of tables without a table.
void drop_unneeded(const std::vector<SceneKey>& keys, ordered_json& tables) {
    for (ordered_json& table : tables) {
        for (const SceneKey& key : keys) {
            const bool idle = !key.needs.empty() && !table.contains(key.needs);
            const bool empty = key.kind == KeyKind::table_list && table.contains(key.path) && table.at(key.path).empty();
            if (idle || empty) table.erase(key.path);
        }
    }
}

/// Settings as a scene file may say them: of what excludes each other, what is in force.
std::string file_of(ordered_json settings) {
    for (ordered_json& fabric : settings.at("fabric")) {
        for (const auto& [first, second] : fabric_table().rules.exclude) {
            std::string path = "/" + first;
            for (char& letter : path) letter = letter == '.' ? '/' : letter;
            if (!fabric.contains(second) || !fabric.contains(ordered_json::json_pointer(path))) continue;
            const ordered_json::json_pointer at(path);
            fabric.at(at.parent_pointer()).erase(at.back());
        }
    }
    for (const SceneKey& key : keys_of(scene_table()))
        if (key.kind == KeyKind::table_list) drop_unneeded(key.inside, settings.at(key.path));
    std::string text;
    for (const auto& [key, value] : settings.items()) text += key + " = " + toml_of(value) + "\n";
    return text;
}

/// The fault of a document with one in it, and the text that begins at its place.
struct Fault {
    std::string message, at;
};

Fault fault_of(const std::string& text) {
    try {
        FaultList first(false);
        check_document(parse_toml(text, "t"), first);
    } catch (const SceneFileError& error) {
        std::size_t begin = 0;
        for (int line = 1; line < error.place().line; ++line) begin = text.find('\n', begin) + 1;
        return {error.what(), text.substr(begin + static_cast<std::size_t>(error.place().column) - 1)};
    }
    return {"nothing was thrown", ""};
}

std::vector<std::string> wrong_kinds(const SceneKey& key) {
    switch (key.kind) {
        case KeyKind::text:
            return {"7", "[]", "{}", "1979-05-27"};
        case KeyKind::word:
            return {"7", "\"no_such_word\"", "true"};
        case KeyKind::flag:
            return {"\"true\"", "1"};
        case KeyKind::number:
        case KeyKind::number_or_auto:
        case KeyKind::number_or_rest:
            return {"\"many\"", "true", "[1]"};
        case KeyKind::integer:
        case KeyKind::integer_or_auto:
            return {"\"many\"", "2.5", "[2]"};
        case KeyKind::numbers:
        case KeyKind::integers:
        case KeyKind::names:
        case KeyKind::box:
            return {"7", "\"many\"", "[]", "[7]"};
        case KeyKind::vertices:
            return {"7", "\"edges\""};
        case KeyKind::words:
            return {"7", "\"text\"", "{}"};
        case KeyKind::pairs:
            return {"7", "[]"};
        case KeyKind::stitches:
            return {"7", "[]"};
        case KeyKind::direction:
            return {"7", "\"w\"", "[1]", "[1, 2, 3, 4]"};
        case KeyKind::limit:
            return {"\"small\"", "true", "[1, 2]"};
        case KeyKind::table:
        case KeyKind::table_or_list:
        case KeyKind::table_list:
        case KeyKind::named_tables:
            break;
    }
    return {"7", "\"text\""};
}

/// A value of the key with one number in it.
std::string with_number(const SceneKey& key, const std::string& number, const std::string& good) {
    std::string rest;
    for (int i = 1; i < key.count; ++i) rest += ", " + good;
    if (key.kind == KeyKind::pairs) return "[[" + good + ", " + number + "]]";
    if (key.kind == KeyKind::stitches) return "[[" + good + ", " + number + ", " + good + ", 0.5]]";
    if (key.kind == KeyKind::box) return "[[" + number + ", 0, 0], [1, 1, 1]]";
    return key.count > 0 ? "[" + number + rest + "]" : number;
}

bool holds_numbers(const SceneKey& key) {
    const std::set<KeyKind> kinds = {
        KeyKind::number,   KeyKind::integer, KeyKind::number_or_auto, KeyKind::integer_or_auto, KeyKind::numbers,
        KeyKind::integers, KeyKind::box,     KeyKind::pairs,          KeyKind::stitches,        KeyKind::number_or_rest};
    return kinds.contains(key.kind);
}

bool is_whole(const SceneKey& key) {
    return key.kind == KeyKind::integer || key.kind == KeyKind::integer_or_auto || key.kind == KeyKind::integers ||
           key.kind == KeyKind::pairs || key.kind == KeyKind::stitches;
}

std::vector<std::string> out_of_range(const SceneKey& key) {
    const bool whole = is_whole(key);
    const auto next = [&](double end, double towards) {
        if (std::isinf(end)) return std::string();
        return whole ? std::to_string(static_cast<long>(end) + (towards > end ? 1 : -1))
                     : number_text(std::nextafter(end, towards));
    };
    std::vector<std::string> numbers = {next(key.lowest, -1e300), next(key.highest, 1e300)};
    if (!whole) numbers.insert(numbers.end(), {"nan", "inf", "-inf"});
    std::erase(numbers, "");
    return numbers;
}

}  // namespace

TEST_CASE("every value of a scene file is read into its own field, and is written again") {
    for (unsigned seed = 1; seed <= 300; ++seed) {
        const std::string text = GeneratedScene(seed, 0.5).text();
        INFO(text);
        const Scene scene = parse_scene(text, "t");
        check_held(parse_toml(text, "t"), spec_node(scene_table(), scene), "");
    }
}

TEST_CASE("settings read as a scene file are the same settings") {
    for (unsigned seed = 1; seed <= 300; ++seed) {
        const std::string text = GeneratedScene(seed, 0.5).text();
        INFO(text);
        const std::string settings = settings_text(parse_scene(text, "t"));
        const std::string again = file_of(ordered_json::parse(settings));
        INFO(again);
        CHECK(settings_text(parse_scene(again, "t")) == settings);
    }
}

TEST_CASE("every key that a run depends on changes its settings, and no other does") {
    for (const SceneKey& key : scene_keys()) {
        if (is_table(key.kind)) continue;
        CAPTURE(key.path);
        const auto settings_with = [&](const std::string& value) {
            GeneratedScene scene(7);
            scene.wanted = key.path;
            scene.value = value;
            const std::string text = scene.text();
            INFO(text);
            return settings_text(parse_scene(text, "t"));
        };
        GeneratedScene values(11);
        const std::string one = values.value_of(key, key.path);
        std::string other = one;
        if (key.path.ends_with(".name")) other = "\"renamed\"";
        if (key.path == "cloth.rest") other = "\"flat.obj\"";
        while (other == one) other = values.value_of(key, key.path);
        const SceneKey& top = *find_scene_key(key.path.substr(0, key.path.find('.')));
        CHECK((settings_with(one) != settings_with(other)) == top.setting);
    }
}

TEST_CASE("a value of a wrong kind is refused at its place, for every key") {
    for (const SceneKey& key : scene_keys()) {
        for (const std::string& wrong : wrong_kinds(key)) {
            GeneratedScene scene(3);
            scene.wanted = key.path;
            scene.value = wrong;
            const std::string text = scene.text();
            CAPTURE(key.path, wrong, text);
            const Fault fault = fault_of(text);
            CAPTURE(fault.message);
            CHECK(fault.at.starts_with(wrong));
            CHECK((fault.message.find(" must be ") != std::string::npos ||
                   fault.message.find("has no choice") != std::string::npos));
        }
    }
}

TEST_CASE("a number out of range is refused at its place, for every key") {
    int count = 0;
    for (const SceneKey& key : scene_keys()) {
        if (!holds_numbers(key)) continue;
        const std::string good = number_text(std::ceil(std::isinf(key.lowest) ? 0.0 : key.lowest));
        for (const std::string& bad : out_of_range(key)) {
            GeneratedScene scene(3);
            scene.wanted = key.path;
            scene.value = with_number(key, bad, good);
            const std::string text = scene.text();
            CAPTURE(key.path, bad, text);
            const Fault fault = fault_of(text);
            CAPTURE(fault.message);
            CHECK(fault.at.starts_with(bad));
            CHECK((fault.message.find("out of range; allowed: " + range_text(key)) != std::string::npos ||
                   fault.message.find("is not finite") != std::string::npos));
            ++count;
        }
    }
    CHECK(count > 200);
}

TEST_CASE("both ends of every range are allowed") {
    for (const SceneKey& key : scene_keys()) {
        if (!holds_numbers(key) || std::isinf(key.lowest) || std::isinf(key.highest) || key.kind == KeyKind::box) continue;
        for (const double end : {key.lowest, key.highest}) {
            const std::string number = is_whole(key) ? std::to_string(static_cast<long>(end)) : number_text(end);
            GeneratedScene scene(3);
            scene.wanted = key.path;
            scene.value = with_number(key, number, number);
            const std::string text = scene.text();
            CAPTURE(text);
            CHECK(fault_of(text).message == "nothing was thrown");
        }
    }
}

TEST_CASE("a slip in a key is refused at its place with the key that was meant, for every key") {
    for (const SceneKey& key : scene_keys()) {
        GeneratedScene scene(3);
        scene.wanted = key.path;
        scene.ending = "q";
        const std::string text = scene.text();
        const std::string name = key.path.substr(key.path.rfind('.') + 1), slip = name + "q";
        CAPTURE(key.path, text);
        const Fault fault = fault_of(text);
        CHECK(fault.at.starts_with(slip));
        INFO(fault.message);
        CHECK(fault.message.find("unknown key '" + slip + "' in ") != std::string::npos);
        CHECK(fault.message.find("; did you mean '" + name + "'? valid: ") != std::string::npos);
    }
}

TEST_CASE("a required key is missed in its table, for every one") {
    for (const SceneKey& key : scene_keys()) {
        if (!key.required) continue;
        GeneratedScene scene(3);
        scene.wanted = key.path;
        const std::string whole = scene.text();
        const std::string name = key.path.substr(key.path.rfind('.') + 1);
        CAPTURE(key.path, whole);
        CHECK(fault_of(whole).message == "nothing was thrown");
        scene.ending = "q";
        FaultList all(true);
        check_document(parse_toml(scene.text(), "t"), all);
        REQUIRE(all.found.size() >= 2);
        bool missed = false;
        for (const SceneFileError& fault : all.found)
            missed = missed || fault.reason().find(" lacks '" + name + "': " + key.sentence) != std::string::npos;
        CHECK(missed);
    }
}

}  // namespace percale::scenes::test::field_laws_test
