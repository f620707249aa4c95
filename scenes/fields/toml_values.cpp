#include "fields/toml_values.h"

#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

template <class Values>
TomlNode list_of(const Values& values) {
    TomlNode node;
    node.kind = TomlKind::list;
    for (const auto& value : values) node.items.push_back(value_node(value));
    return node;
}

}  // namespace

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

void read_value(const TomlNode& node, std::string& value) { value = node.text; }
void read_value(const TomlNode& node, double& value) { value = node.number; }
void read_value(const TomlNode& node, int& value) { value = static_cast<int>(node.integer); }
void read_value(const TomlNode& node, bool& value) { value = node.text == "true"; }

void read_value(const TomlNode& node, Vec3& value) { value = {node.items[0].number, node.items[1].number, node.items[2].number}; }

void read_value(const TomlNode& node, std::array<double, 2>& value) { value = {node.items[0].number, node.items[1].number}; }

void read_value(const TomlNode& node, std::array<int, 2>& value) {
    value = {static_cast<int>(node.items[0].integer), static_cast<int>(node.items[1].integer)};
}

void read_value(const TomlNode& node, std::array<std::string, 2>& value) { value = {node.items[0].text, node.items[1].text}; }

void read_value(const TomlNode& node, std::vector<std::string>& value) {
    value.clear();
    if (node.kind == TomlKind::text) value.push_back(node.text);
    for (const TomlNode& item : node.items) value.push_back(item.text);
}

void read_value(const TomlNode& node, std::vector<std::array<int, 2>>& value) {
    value.resize(node.items.size());
    for (std::size_t i = 0; i < value.size(); ++i) read_value(node.items[i], value[i]);
}

void read_value(const TomlNode& node, std::vector<Stitch>& value) {
    value.clear();
    for (const TomlNode& item : node.items) {
        Stitch& stitch = value.emplace_back();
        read_value(item.items[0], stitch.vertex);
        read_value(item.items[1], stitch.from);
        read_value(item.items[2], stitch.to);
        read_value(item.items[3], stitch.share);
    }
}

Rotation read_rotation(const TomlNode& node, const std::string& shown) {
    const auto part = [&](std::size_t i) { return node.items[i].number; };
    const double length = std::sqrt(part(0) * part(0) + part(1) * part(1) + part(2) * part(2) + part(3) * part(3));
    if (!(std::abs(length - 1.0) <= 1e-3))
        fail_at(node.place, shown + " must be a unit quaternion [w, x, y, z]; its length is " + number_text(length) +
                                ", allowed: 0.999 ... 1.001");
    return {part(0) / length, part(1) / length, part(2) / length, part(3) / length};
}

TomlNode value_node(const std::string& value) {
    TomlNode node;
    node.kind = TomlKind::text;
    node.text = value;
    return node;
}

TomlNode value_node(double value) {
    TomlNode node;
    node.kind = TomlKind::number;
    node.number = value;
    return node;
}

TomlNode value_node(int value) {
    TomlNode node;
    node.kind = TomlKind::integer;
    node.integer = value;
    node.number = value;
    return node;
}

TomlNode value_node(bool value) {
    TomlNode node;
    node.kind = TomlKind::boolean;
    node.text = value ? "true" : "false";
    return node;
}

TomlNode value_node(const Vec3& value) { return list_of(std::array{value.x(), value.y(), value.z()}); }
TomlNode value_node(const Rotation& value) { return list_of(std::array{value.w, value.x, value.y, value.z}); }
TomlNode value_node(const std::array<double, 2>& value) { return list_of(value); }
TomlNode value_node(const std::array<int, 2>& value) { return list_of(value); }
TomlNode value_node(const std::array<std::string, 2>& value) { return list_of(value); }
TomlNode value_node(const std::vector<std::string>& value) { return list_of(value); }
TomlNode value_node(const std::vector<std::array<int, 2>>& value) { return list_of(value); }

TomlNode value_node(const std::vector<Stitch>& value) {
    TomlNode node;
    node.kind = TomlKind::list;
    for (const Stitch& stitch : value) {
        TomlNode& item = node.items.emplace_back();
        item.kind = TomlKind::list;
        for (const int vertex : {stitch.vertex, stitch.from, stitch.to}) item.items.push_back(value_node(vertex));
        item.items.push_back(value_node(stitch.share));
    }
    return node;
}

std::string value_text(KeyKind kind, const TomlNode& node) {
    if (node.is_number()) return number_text(node.number);
    if (node.kind != TomlKind::list) return kind == KeyKind::text ? "\"" + node.text + "\"" : node.text;
    std::vector<std::string> items;
    for (const TomlNode& item : node.items) items.push_back(value_text(kind, item));
    return "[" + joined(items) + "]";
}

std::string only_key(const TomlNode& table, const std::vector<std::string>& keys, const std::string& shown) {
    std::vector<std::string> held;
    for (const std::string& key : keys)
        if (table.find(key) != nullptr) held.push_back(key);
    if (held.size() == 1) return held.front();
    fail_at(table.place,
            shown + " must have exactly one of " + joined(keys) + "; it has " + (held.empty() ? "none" : joined(held)));
}

}  // namespace percale::scenes
