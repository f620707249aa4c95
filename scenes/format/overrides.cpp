#include "format/overrides.h"

#include <algorithm>
#include <charconv>

#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

std::vector<std::string> key_parts(const std::string& key, const SourcePlace& place) {
    std::vector<std::string> parts(1);
    for (const char letter : key) {
        if (letter == '.') {
            parts.emplace_back();
        } else {
            parts.back() += letter;
        }
    }
    for (const std::string& part : parts)
        if (part.empty()) fail_at(place, "'" + key + "' is not a dotted key of a scene file");
    return parts;
}

std::vector<std::string> item_names(const TomlNode& list) {
    std::vector<std::string> names;
    for (const TomlNode& item : list.items) {
        const TomlNode* name = item.find("name");
        names.push_back(name != nullptr ? name->text : "");
    }
    return names;
}

[[noreturn]] void fail_item(const TomlNode& list, const std::string& part, const SourcePlace& place) {
    std::vector<std::string> names = item_names(list);
    std::erase(names, "");
    const std::string what = (list.key.empty() ? "the list" : list.key) + " has no item '" + part + "'";
    if (list.items.empty()) fail_at(place, what + "; it is empty");
    const bool is_number = part.find_first_not_of("-0123456789") == std::string::npos;
    if (!names.empty() && !is_number) fail_at(place, what + suggestion(part, names));
    fail_at(place, what + "; allowed: 0 ... " + std::to_string(list.items.size() - 1));
}

TomlNode& list_item(TomlNode& list, const std::string& part, const SourcePlace& place) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool is_index = error == std::errc() && end == part.data() + part.size();
    if (is_index && index < list.items.size()) return list.items[index];
    const std::vector<std::string> names = item_names(list);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == part) return list.items[i];
    fail_item(list, part, place);
}

TomlNode& table_entry(TomlNode& table, const std::string& part, const SourcePlace& place) {
    if (TomlNode* entry = table.find(part)) return *entry;
    TomlNode made;
    made.key = part;
    made.place = made.key_place = place;
    table.entries.push_back(std::move(made));
    return table.entries.back();
}

// A fabric that no cloth could have meant would be made by a slip of the pen and used by nobody.
void check_fabric_name(const TomlNode& fabrics, const std::string& name, const SourcePlace& place) {
    std::vector<std::string> names;
    for (const TomlNode& fabric : fabrics.entries) names.push_back(fabric.key);
    if (std::find(names.begin(), names.end(), name) == names.end())
        fail_at(place, "no fabric '" + name + "'" + suggestion(name, names));
}

TomlNode& child(TomlNode& node, const std::string& part, const SourcePlace& place) {
    if (node.kind == TomlKind::list) return list_item(node, part, place);
    if (node.kind == TomlKind::table) return table_entry(node, part, place);
    fail_at(place, "nothing to set inside " + described(node) + " ('" + part + "')");
}

}  // namespace

void apply_override(TomlNode& document, const Override& override) {
    const SourcePlace place{.file = override.option.empty() ? "--set " + override.key : override.option};
    const std::vector<std::string> parts = key_parts(override.key, place);
    TomlNode* node = &document;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i == 1 && parts[0] == "fabric" && node->kind == TomlKind::table) check_fabric_name(*node, parts[1], place);
        node = &child(*node, parts[i], place);
    }
    TomlNode value = parse_toml_value(override.value, place);
    value.key = node->key;
    *node = std::move(value);
}

}  // namespace percale::scenes
