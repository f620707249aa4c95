#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/toml_document.h"

// Values out of tables that check_document() has found in order. What a table does not hold is left as it was.
namespace percale::scenes {

/// The value at a dotted key, or null.
const TomlNode* find_value(const TomlNode& table, std::string_view dotted_key);

void read_value(const TomlNode& table, std::string_view key, std::string& value);
void read_value(const TomlNode& table, std::string_view key, double& value);
void read_value(const TomlNode& table, std::string_view key, int& value);
void read_value(const TomlNode& table, std::string_view key, Vec3& value);
/// Normalised. Throws SceneError if the length is not 1 to within 0.001.
void read_value(const TomlNode& table, std::string_view key, Rotation& value);

template <class Value>
void read_value(const TomlNode& table, std::string_view key, std::optional<Value>& value) {
    if (find_value(table, key) == nullptr) return;
    value.emplace();
    read_value(table, key, *value);
}

/// A list of three numbers.
Vec3 vector_of(const TomlNode& list);

/// The one key of `keys` that the table holds. Throws SceneError at the table if it holds none of them or several.
std::string only_key(const TomlNode& table, const std::vector<std::string>& keys, const std::string& shown);

}  // namespace percale::scenes
