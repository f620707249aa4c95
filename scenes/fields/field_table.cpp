#include "fields/field_table.h"

#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

/// "'a', 'b' or 'c'"
std::string either(const std::vector<std::string>& keys) {
    std::string text;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i > 0) text += i + 1 < keys.size() ? ", " : " or ";
        text += "'" + keys[i] + "'";
    }
    return text;
}

}  // namespace

void check_rules(const TomlNode& table, const TableRules& rules) {
    bool one = rules.at_least_one.empty();
    for (const std::string& key : rules.at_least_one) one = one || table.find(key) != nullptr;
    if (!one) fail_at(table.place, rules.shown(table) + " lacks " + either(rules.at_least_one) + ": " + rules.at_least_one_why);
    for (const auto& [first, second] : rules.exclude) {
        const TomlNode* other = find_value(table, second);
        if (find_value(table, first) != nullptr && other != nullptr)
            fail_at(other->key_place, rules.shown(table) + ": " + first + " and " + second + " exclude each other");
    }
}

void check_needs(const TomlNode& table, const TomlNode& value, const SceneKey& key) {
    if (key.needs.empty() || table.find(key.needs) != nullptr) return;
    fail_at(value.place, key.needs_why + "; without " + key.needs + " it means nothing");
}

}  // namespace percale::scenes
