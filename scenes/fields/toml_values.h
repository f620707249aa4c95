#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fields/scene_keys.h"
#include "fields/toml_document.h"
#include "percale/mesh.h"
#include "percale/stitch.h"

// Values of a document that check_document() has found in order, as plain data and back.
namespace percale::scenes {

/// The value at a dotted key, or null.
const TomlNode* find_value(const TomlNode& table, std::string_view dotted_key);

void read_value(const TomlNode& node, std::string& value);
void read_value(const TomlNode& node, double& value);
void read_value(const TomlNode& node, int& value);
void read_value(const TomlNode& node, bool& value);
void read_value(const TomlNode& node, Vec3& value);
void read_value(const TomlNode& node, std::array<double, 2>& value);
void read_value(const TomlNode& node, std::array<int, 2>& value);
void read_value(const TomlNode& node, std::array<std::string, 2>& value);
void read_value(const TomlNode& node, std::vector<std::string>& value);
void read_value(const TomlNode& node, std::vector<std::array<int, 2>>& value);
void read_value(const TomlNode& node, std::vector<Stitch>& value);
template <class Value>
void read_value(const TomlNode& node, std::optional<Value>& value) {
    read_value(node, value.emplace());
}

/// The rotation, normalised. Throws SceneFileError naming the key as `shown` if the length is not 1 to within 0.001.
Rotation read_rotation(const TomlNode& node, const std::string& shown);

/// What read_value() reads back as the same value; an empty optional is nothing.
TomlNode value_node(const std::string& value);
TomlNode value_node(double value);
TomlNode value_node(int value);
TomlNode value_node(bool value);
TomlNode value_node(const Vec3& value);
TomlNode value_node(const Rotation& value);
TomlNode value_node(const std::array<double, 2>& value);
TomlNode value_node(const std::array<int, 2>& value);
TomlNode value_node(const std::array<std::string, 2>& value);
TomlNode value_node(const std::vector<std::string>& value);
TomlNode value_node(const std::vector<std::array<int, 2>>& value);
TomlNode value_node(const std::vector<Stitch>& value);
template <class Value>
std::optional<TomlNode> value_node(const std::optional<Value>& value) {
    return value ? std::optional(value_node(*value)) : std::nullopt;
}

/// What kind of key each type is the value of.
struct ValueKind {
    KeyKind kind = KeyKind::text;
    int count = 0;
};
template <class Value>
inline constexpr ValueKind value_kind = {};
template <>
inline constexpr ValueKind value_kind<double> = {KeyKind::number};
template <>
inline constexpr ValueKind value_kind<int> = {KeyKind::integer};
template <>
inline constexpr ValueKind value_kind<bool> = {KeyKind::flag};
template <>
inline constexpr ValueKind value_kind<Vec3> = {KeyKind::numbers, 3};
template <>
inline constexpr ValueKind value_kind<Rotation> = {KeyKind::numbers, 4};
template <>
inline constexpr ValueKind value_kind<std::array<double, 2>> = {KeyKind::numbers, 2};
template <>
inline constexpr ValueKind value_kind<std::array<int, 2>> = {KeyKind::integers, 2};
template <>
inline constexpr ValueKind value_kind<std::array<std::string, 2>> = {KeyKind::names, 2};
template <>
inline constexpr ValueKind value_kind<std::vector<std::string>> = {KeyKind::words};
template <>
inline constexpr ValueKind value_kind<std::vector<std::array<int, 2>>> = {KeyKind::pairs};
template <>
inline constexpr ValueKind value_kind<std::vector<Stitch>> = {KeyKind::stitches};
template <class Value>
inline constexpr ValueKind value_kind<std::optional<Value>> = value_kind<Value>;

/// The default of a key, as messages and tables show it: texts in quotes, words bare.
std::string value_text(KeyKind kind, const TomlNode& node);

/// The one key of `keys` that the table holds. Throws SceneFileError at the table if it holds none of them or several.
std::string only_key(const TomlNode& table, const std::vector<std::string>& keys, const std::string& shown);

}  // namespace percale::scenes
