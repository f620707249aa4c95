#include "format/scene_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "format/scene_table.h"

namespace percale::scenes {
namespace {

/// Which table or value is looked at: by its path in scene_keys(), and as `--set` would write it.
struct Spot {
    std::string path;
    std::string shown;

    Spot inside(const std::string& key) const {
        return {path.empty() ? key : path + "." + key, shown.empty() ? key : shown + "." + key};
    }
};

constexpr const char* quaternion_advice =
    "; it is a unit quaternion [w, x, y, z]: a turn by the angle a about the unit vector n is [cos(a/2), sin(a/2) n]";

/// "[0]" of "cloth.0.pose.rotation[0]" goes: what is left is the value as a whole.
bool is_rotation(const std::string& shown) { return shown.substr(0, shown.rfind('[')).ends_with("rotation"); }

[[noreturn]] void fail_kind(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    const std::string unit = key.unit.empty() ? "" : " (" + key.unit + ")";
    const bool one_table = key.kind == KeyKind::table_list && node.kind == TomlKind::table;
    std::string advice = one_table ? "; write [[" + shown + "]]" : "";
    if (is_rotation(shown) && node.kind == TomlKind::list) advice = quaternion_advice;
    if (key.kind == KeyKind::named_tables) advice = "; write [" + shown + ".NAME], once for each";
    if (node.kind == TomlKind::text) advice += number_advice(node.text);
    fail_at(node.place, shown + " must be " + kind_text(key) + unit + ", not " + described(node) + advice);
}

void check_number(const TomlNode& node, const SceneKey& key, const std::string& shown, bool whole = false) {
    if (!node.is_number() || (whole && node.kind != TomlKind::integer)) fail_kind(node, key, shown);
    const std::string unit = key.unit.empty() ? "" : " " + key.unit;
    const std::string value = shown + " = " + number_text(node.number) + unit;
    if (!std::isfinite(node.number)) fail_at(node.place, value + " is not finite");
    if (node.number < key.lowest || node.number > key.highest)
        fail_at(node.place,
                value + " is out of range; allowed: " + range_text(key) + (is_rotation(shown) ? quaternion_advice : ""));
}

void check_numbers(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::list || static_cast<int>(node.items.size()) != key.count) fail_kind(node, key, shown);
    for (std::size_t i = 0; i < node.items.size(); ++i)
        check_number(node.items[i], key, shown + "[" + std::to_string(i) + "]", key.kind == KeyKind::integers);
}

void check_word(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::text) fail_kind(node, key, shown);
    for (const std::string& choice : key.choices)
        if (node.text == choice) return;
    fail_at(node.place, shown + " has no choice '" + node.text + "'" + suggestion(node.text, key.choices));
}

void check_number_or_word(const TomlNode& node, const SceneKey& key, const std::string& shown, const char* word) {
    if (node.kind == TomlKind::text && node.text == word) return;
    check_number(node, key, shown, key.kind == KeyKind::integer_or_auto);
}

void check_box(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::list || node.items.size() != 2) fail_kind(node, key, shown);
    SceneKey corner = key;
    corner.kind = KeyKind::numbers;
    corner.count = 3;
    for (std::size_t i = 0; i < 2; ++i) check_numbers(node.items[i], corner, shown + "[" + std::to_string(i) + "]");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lowest = node.items[0].items[axis].number, highest = node.items[1].items[axis].number;
        if (lowest > highest)
            fail_at(node.place, shown + ": the first corner must not lie above the second; on axis " + std::to_string(axis) +
                                    " " + number_text(lowest) + " > " + number_text(highest));
    }
}

void check_table(const TomlNode& table, const Spot& spot, FaultList& faults);

void check_vertices(const TomlNode& node, const SceneKey& key, const Spot& spot, FaultList& faults) {
    if (node.kind == TomlKind::text && node.text == "boundary") return;
    if (node.kind == TomlKind::table && !node.entries.empty()) return check_table(node, spot, faults);
    if (node.kind != TomlKind::list) fail_kind(node, key, spot.shown);
    SceneKey index = key;
    index.kind = KeyKind::integer;
    index.lowest = 0;
    index.highest = 2147483647;
    for (const TomlNode& item : node.items) check_number(item, index, spot.shown, true);
}

void check_names(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::list || static_cast<int>(node.items.size()) != key.count) fail_kind(node, key, shown);
    for (const TomlNode& item : node.items)
        if (item.kind != TomlKind::text) fail_kind(item, key, shown);
}

void check_words(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind == TomlKind::text) return check_word(node, key, shown);
    if (node.kind != TomlKind::list) fail_kind(node, key, shown);
    for (auto item = node.items.begin(); item != node.items.end(); ++item) {
        check_word(*item, key, shown);
        const auto same = [&](const TomlNode& other) { return other.text == item->text; };
        if (std::any_of(node.items.begin(), item, same)) fail_at(item->place, shown + " has '" + item->text + "' twice");
    }
}

void check_pairs(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::list || node.items.empty()) fail_kind(node, key, shown);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const TomlNode& pair = node.items[i];
        const std::string place = shown + "[" + std::to_string(i) + "]";
        if (pair.kind != TomlKind::list || pair.items.size() != 2) fail_kind(pair, key, place);
        for (std::size_t k = 0; k < 2; ++k) check_number(pair.items[k], key, place + "[" + std::to_string(k) + "]", true);
    }
}

void check_stitches(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind != TomlKind::list || node.items.empty()) fail_kind(node, key, shown);
    const SceneKey share{.path = key.path, .kind = KeyKind::number, .lowest = 0.0, .highest = 1.0};
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const TomlNode& stitch = node.items[i];
        const std::string place = shown + "[" + std::to_string(i) + "]";
        if (stitch.kind != TomlKind::list || stitch.items.size() != 4) fail_kind(stitch, key, place);
        for (std::size_t k = 0; k < 4; ++k) {
            check_number(stitch.items[k], k < 3 ? key : share, place + "[" + std::to_string(k) + "]", k < 3);
        }
    }
}

void check_direction(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    if (node.kind == TomlKind::text && (node.text == "u" || node.text == "v")) return;
    if (node.kind != TomlKind::list || node.items.size() < 2 || node.items.size() > 3) fail_kind(node, key, shown);
    bool zero = true;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        check_number(node.items[i], key, shown + "[" + std::to_string(i) + "]");
        zero = zero && node.items[i].number == 0.0;
    }
    if (zero) fail_at(node.place, shown + " must not be zero in every part");
}

void check_between(const TomlNode& node, const SceneKey& key, const std::string& shown) {
    SceneKey both = key;
    both.kind = KeyKind::numbers;
    both.count = 2;
    check_numbers(node, both, shown);
    const double lowest = node.items[0].number, highest = node.items[1].number;
    if (lowest > highest)
        fail_at(node.place,
                shown + ": the first number must not be above the second; " + number_text(lowest) + " > " + number_text(highest));
}

void check_limit(const TomlNode& node, const SceneKey& key, const Spot& spot) {
    if (node.is_number()) return check_number(node, key, spot.shown);
    if (node.kind != TomlKind::table) fail_kind(node, key, spot.shown);
    const std::string forms[] = {"below", "above", "between"};
    for (const TomlNode& value : node.entries) {
        const std::string& form = value.key;
        if (form == "between") {
            check_between(value, key, spot.shown + "." + form);
        } else if (form == "below" || form == "above") {
            check_number(value, {.path = key.path, .kind = KeyKind::number, .sentence = {}, .unit = key.unit},
                         spot.shown + "." + form);
        } else {
            fail_at(value.key_place, "unknown key '" + form + "' in [" + spot.shown + "]" + suggestion(form, forms));
        }
    }
    if (node.entries.size() != 1)
        fail_at(node.place,
                spot.shown + " must have exactly one of below, above, between, not " + std::to_string(node.entries.size()));
}

void check_table_list(const TomlNode& node, const SceneKey& key, const Spot& spot, FaultList& faults) {
    if (node.kind != TomlKind::list) fail_kind(node, key, spot.shown);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const TomlNode& item = node.items[i];
        faults.attempt([&] {
            if (item.kind != TomlKind::table) fail_kind(item, key, spot.shown + "." + std::to_string(i));
            const TomlNode* name = item.find("name");
            const bool named = name != nullptr && name->kind == TomlKind::text;
            check_table(item, {spot.path, spot.shown + "." + (named ? name->text : std::to_string(i))}, faults);
        });
    }
}

/// Whether what stands under [fabric] is "springs = { structural = 1 }", a key of a fabric, and no fabric of that name.
bool is_meant_for_nameless(const TomlNode& node, const std::string& path) {
    const SceneKey* key = find_scene_key(path + "." + node.key);
    if (key == nullptr || node.kind != TomlKind::table) return key != nullptr;
    const std::vector<std::string> inside = keys_inside(key->path), named = keys_inside(path);
    const auto fits = [&](const TomlNode& entry) {
        return std::ranges::find(inside, entry.key) != inside.end() && std::ranges::find(named, entry.key) == named.end();
    };
    return !node.entries.empty() && std::ranges::all_of(node.entries, fits);
}

void check_named_tables(const TomlNode& node, const SceneKey& key, const Spot& spot, FaultList& faults) {
    if (node.kind != TomlKind::table) fail_kind(node, key, spot.shown);
    bool reported = false;  // reported once for all keys
    for (const TomlNode& table : node.entries) {
        const bool nameless = is_meant_for_nameless(table, spot.path);
        if (nameless && std::exchange(reported, true)) continue;
        faults.attempt([&] {
            const std::string& name = table.key;
            if (nameless)
                fail_at(table.key_place, "[" + spot.shown + "] lacks a name; write [" + spot.shown + ".NAME], not [" +
                                             spot.shown + "], above '" + name + "'");
            if (table.kind != TomlKind::table)
                fail_at(table.place,
                        spot.shown + "." + name + " must be a table [" + spot.shown + ".NAME], not " + described(table));
            check_table(table, {spot.path, spot.shown + "." + name}, faults);
        });
    }
}

void check_value(const TomlNode& node, const SceneKey& key, const Spot& spot, FaultList& faults) {
    switch (key.kind) {
        case KeyKind::text:
            if (node.kind != TomlKind::text) fail_kind(node, key, spot.shown);
            return;
        case KeyKind::word:
            return check_word(node, key, spot.shown);
        case KeyKind::flag:
            if (node.kind != TomlKind::boolean) fail_kind(node, key, spot.shown);
            return;
        case KeyKind::number:
            return check_number(node, key, spot.shown);
        case KeyKind::integer:
            return check_number(node, key, spot.shown, true);
        case KeyKind::number_or_auto:
        case KeyKind::integer_or_auto:
            return check_number_or_word(node, key, spot.shown, "auto");
        case KeyKind::number_or_rest:
            return check_number_or_word(node, key, spot.shown, "rest");
        case KeyKind::numbers:
        case KeyKind::integers:
            return check_numbers(node, key, spot.shown);
        case KeyKind::box:
            return check_box(node, key, spot.shown);
        case KeyKind::vertices:
            return check_vertices(node, key, spot, faults);
        case KeyKind::names:
            return check_names(node, key, spot.shown);
        case KeyKind::words:
            return check_words(node, key, spot.shown);
        case KeyKind::pairs:
            return check_pairs(node, key, spot.shown);
        case KeyKind::stitches:
            return check_stitches(node, key, spot.shown);
        case KeyKind::direction:
            return check_direction(node, key, spot.shown);
        case KeyKind::limit:
            return check_limit(node, key, spot);
        case KeyKind::table:
            if (node.kind != TomlKind::table) fail_kind(node, key, spot.shown);
            return check_table(node, spot, faults);
        case KeyKind::table_or_list:
            if (node.kind == TomlKind::table) return check_table(node, spot, faults);
            return check_table_list(node, key, spot, faults);
        case KeyKind::table_list:
            return check_table_list(node, key, spot, faults);
        case KeyKind::named_tables:
            return check_named_tables(node, key, spot, faults);
    }
}

std::string table_text(const Spot& spot) { return spot.shown.empty() ? "the scene" : "[" + spot.shown + "]"; }

void check_entry(const TomlNode& node, const Spot& table, const std::vector<std::string>& valid, FaultList& faults) {
    const std::string& name = node.key;
    const Spot entry = table.inside(name);
    const SceneKey* key = name.find('.') == std::string::npos ? find_scene_key(entry.path) : nullptr;
    if (key == nullptr) fail_at(node.key_place, "unknown key '" + name + "' in " + table_text(table) + suggestion(name, valid));
    check_value(node, *key, entry, faults);
}

void check_table(const TomlNode& table, const Spot& spot, FaultList& faults) {
    const std::vector<std::string> valid = keys_inside(spot.path);
    for (const TomlNode& node : table.entries) faults.attempt([&] { check_entry(node, spot, valid, faults); });
    for (const std::string& name : valid) {
        const SceneKey& key = *find_scene_key(spot.inside(name).path);
        if (!key.required || table.find(name) != nullptr) continue;
        faults.attempt([&] { fail_at(table.place, table_text(spot) + " lacks '" + name + "': " + key.sentence); });
    }
}

}  // namespace

void check_document(const TomlNode& document, FaultList& faults) { check_table(document, {}, faults); }

void check_part(const TomlNode& table, const std::string& path, FaultList& faults) { check_table(table, {path, path}, faults); }

}  // namespace percale::scenes
