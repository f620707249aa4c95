#include "fields/toml_text.h"

#include <cmath>
#include <cstdio>

#include "common/text.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// A basic string: quotes, backslashes and control letters escaped.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        char escaped[8];
        if (letter == '"' || letter == '\\') {
            out += std::string("\\") + letter;
        } else if (code < 0x20 || code == 0x7f) {
            std::snprintf(escaped, sizeof escaped, "\\u%04X", code);
            out += escaped;
        } else {
            out += letter;
        }
    }
    return out + "\"";
}

/// TOML distinguishes a number from an integer by a point or an exponent.
std::string toml_number(double value) {
    const std::string text = number_text(value);
    const bool whole = std::isfinite(value) && text.find_first_of(".e") == std::string::npos;
    return whole ? text + ".0" : text;
}

std::string list_text(const TomlNode& node) {
    std::vector<std::string> items;
    for (const TomlNode& item : node.items) items.push_back(toml_text(item));
    return "[" + joined(items) + "]";
}

std::string table_text_of(const TomlNode& node) {
    std::vector<std::string> entries;
    for (const TomlNode& entry : node.entries) entries.push_back(quoted(entry.key) + " = " + toml_text(entry));
    return "{" + joined(entries) + "}";
}

}  // namespace

std::string toml_text(const TomlNode& node) {
    switch (node.kind) {
        case TomlKind::table:
            return table_text_of(node);
        case TomlKind::list:
            return list_text(node);
        case TomlKind::text:
            return quoted(node.text);
        case TomlKind::integer:
            return std::to_string(node.integer);
        case TomlKind::number:
            return toml_number(node.number);
        case TomlKind::boolean:
            return node.text;
        case TomlKind::date:
            break;
    }
    throw SceneError("a date or time has no value to write");
}

}  // namespace percale::scenes
