#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/source_place.h"

namespace percale::scenes {

enum class TomlKind { table, list, text, integer, number, boolean, date };

/// One value of a TOML document with the place it was written at. Which field holds the value depends on `kind`.
struct TomlNode {
    TomlKind kind = TomlKind::table;
    std::string key;        // in its table; "" in a list
    SourcePlace place;      // of the value
    SourcePlace key_place;  // of its key; in a list the same as `place`
    std::string text;       // text; of dates and booleans as written
    std::int64_t integer = 0;
    double number = 0.0;            // also of an integer
    std::vector<TomlNode> items;    // of a list
    std::vector<TomlNode> entries;  // of a table, in the order of the document

    bool is_number() const { return kind == TomlKind::integer || kind == TomlKind::number; }
    /// The entry with this key, or null.
    TomlNode* find(std::string_view wanted);
    const TomlNode* find(std::string_view wanted) const;
};

/// Reads a document. Throws SceneError "name:line:column: what" for text that is not TOML.
TomlNode parse_toml(const std::string& text, const std::string& name);

/// Reads one value written as on the command line: TOML, or a bare word, which is taken as a text. All places become `place`.
/// Throws SceneError at `place` for an empty value, a line break, or something begun like a list, table or quoted text
/// that is not TOML.
TomlNode parse_toml_value(const std::string& text, const SourcePlace& place);

/// For messages: "the number 3", "the text \"abc\"", "a list of 2", "a table".
std::string described(const TomlNode& node);

}  // namespace percale::scenes
