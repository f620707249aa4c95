#include "format/toml_values.h"

#include <cmath>

#include "common/text.h"

namespace percale::scenes {

const TomlNode* find_value(const TomlNode& table, std::string_view dotted_key) {
    const TomlNode* node = &table;
    while (node != nullptr) {
        const std::size_t dot = dotted_key.find('.');
        node = node->find(dotted_key.substr(0, dot));
        if (dot == std::string_view::npos) break;
        dotted_key.remove_prefix(dot + 1);
    }
    return node;
}

void read_value(const TomlNode& table, std::string_view key, std::string& value) {
    if (const TomlNode* node = find_value(table, key)) value = node->text;
}

void read_value(const TomlNode& table, std::string_view key, double& value) {
    if (const TomlNode* node = find_value(table, key)) value = node->number;
}

void read_value(const TomlNode& table, std::string_view key, int& value) {
    if (const TomlNode* node = find_value(table, key)) value = static_cast<int>(node->integer);
}

void read_value(const TomlNode& table, std::string_view key, Vec3& value) {
    if (const TomlNode* node = find_value(table, key)) value = vector_of(*node);
}

void read_value(const TomlNode& table, std::string_view key, Rotation& value) {
    const TomlNode* node = find_value(table, key);
    if (node == nullptr) return;
    const auto part = [&](std::size_t i) { return node->items[i].number; };
    const double length = std::sqrt(part(0) * part(0) + part(1) * part(1) + part(2) * part(2) + part(3) * part(3));
    if (!(std::abs(length - 1.0) <= 1e-3))
        fail_at(node->place, std::string(key) + " must be a unit quaternion [w, x, y, z]; its length is " + number_text(length) +
                                 ", allowed: 0.999 ... 1.001");
    value = {part(0) / length, part(1) / length, part(2) / length, part(3) / length};
}

Vec3 vector_of(const TomlNode& list) { return {list.items[0].number, list.items[1].number, list.items[2].number}; }

std::string only_key(const TomlNode& table, const std::vector<std::string>& keys, const std::string& shown) {
    std::vector<std::string> held;
    for (const std::string& key : keys)
        if (table.find(key) != nullptr) held.push_back(key);
    if (held.size() == 1) return held.front();
    fail_at(table.place,
            shown + " must have exactly one of " + joined(keys) + "; it has " + (held.empty() ? "none" : joined(held)));
}

}  // namespace percale::scenes
