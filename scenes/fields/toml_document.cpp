#include "fields/toml_document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

/// Dots of a key. Each takes a call inside a call: without a limit a hostile file would exhaust the stack.
constexpr int deepest_key = 256;

SourcePlace place_of(const toml::source_region& region, const std::string& name) {
    return {name, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

TomlNode converted(const toml::node& source, const std::string& name);

void convert_table(const toml::table& source, const std::string& name, TomlNode& node) {
    node.kind = TomlKind::table;
    for (const auto& [key, value] : source) {
        node.entries.push_back(converted(value, name));
        node.entries.back().key = key.str();
        node.entries.back().key_place = place_of(key.source(), name);
    }
    const auto order = [](const TomlNode& entry) { return std::tie(entry.key_place.line, entry.key_place.column); };
    std::stable_sort(node.entries.begin(), node.entries.end(),
                     [&](const TomlNode& a, const TomlNode& b) { return order(a) < order(b); });
}

void convert_list(const toml::array& source, const std::string& name, TomlNode& node) {
    node.kind = TomlKind::list;
    for (const toml::node& item : source) node.items.push_back(converted(item, name));
}

void convert_scalar(const toml::node& source, TomlNode& node) {
    if (const auto* text = source.as_string()) {
        node.kind = TomlKind::text;
        node.text = text->get();
    } else if (const auto* integer = source.as_integer()) {
        node.kind = TomlKind::integer;
        node.integer = integer->get();
        node.number = static_cast<double>(node.integer);
    } else if (const auto* number = source.as_floating_point()) {
        node.kind = TomlKind::number;
        node.number = number->get();
    } else if (const auto* boolean = source.as_boolean()) {
        node.kind = TomlKind::boolean;
        node.text = boolean->get() ? "true" : "false";
    } else {
        node.kind = TomlKind::date;
    }
}

TomlNode converted(const toml::node& source, const std::string& name) {
    TomlNode node;
    node.place = node.key_place = place_of(source.source(), name);
    if (const toml::table* table = source.as_table()) {
        convert_table(*table, name, node);
    } else if (const toml::array* list = source.as_array()) {
        convert_list(*list, name, node);
    } else {
        convert_scalar(source, node);
    }
    return node;
}

void move_to(TomlNode& node, const SourcePlace& place) {
    node.place = node.key_place = place;
    for (TomlNode& item : node.items) move_to(item, place);
    for (TomlNode& entry : node.entries) move_to(entry, place);
}

// A key like a.a.a... makes a table inside a table for each dot, and reading and removing these takes a call inside a call:
// without a limit a hostile file would exhaust the stack.
void check_depth(const std::string& text, const std::string& name) {
    int line = 1, dots = 0;
    bool comment = false;
    for (const char letter : text) {
        if (letter == '\n') {
            ++line;
            comment = false;
        }
        comment = comment || letter == '#';
        if (std::string_view(",=[]{}\n#").find(letter) != std::string_view::npos) dots = 0;
        if (letter == '.' && !comment && ++dots > deepest_key)
            fail_at({name, line, 1}, "a key with more than " + std::to_string(deepest_key) + " dots");
    }
}

// A value that begins like this was meant as TOML; anything else that is not TOML is a bare word.
bool begins_like_toml(char first) { return first == '[' || first == '{' || first == '"' || first == '\''; }

/// Advice on the number that is the value of a line's last key, if that is why the line is not TOML.
std::string advice_on_line(const std::string& text, int line) {
    std::istringstream lines(text);
    std::string words;
    for (int number = 1; number <= line; ++number) std::getline(lines, words);
    const std::string value = words.substr(words.rfind('=') + 1);
    return number_advice(value.substr(0, value.find('#')));
}

}  // namespace

TomlNode* TomlNode::find(std::string_view wanted) {
    for (TomlNode& entry : entries)
        if (entry.key == wanted) return &entry;
    return nullptr;
}

const TomlNode* TomlNode::find(std::string_view wanted) const { return const_cast<TomlNode*>(this)->find(wanted); }

TomlNode parse_toml(const std::string& text, const std::string& name) {
    check_depth(text, name);
    try {
        return converted(toml::parse(text, name), name);
    } catch (const toml::parse_error& error) {
        const SourcePlace place = place_of(error.source(), name);
        fail_at(place, "not valid TOML: " + std::string(error.description()) + advice_on_line(text, place.line));
    }
}

TomlNode parse_toml_value(const std::string& text, const SourcePlace& place) {
    if (text.find_first_not_of(" \t") == std::string::npos) fail_at(place, "the value is empty");
    if (text.find_first_of("\r\n") != std::string::npos) fail_at(place, "the value must be on one line");
    check_depth(text, place.file);
    TomlNode node;
    try {
        node = converted(*toml::parse("value = " + text).get("value"), "");
    } catch (const toml::parse_error& error) {
        if (begins_like_toml(text.front())) fail_at(place, "not a valid TOML value: " + std::string(error.description()));
        node.kind = TomlKind::text;
        node.text = text;
    }
    move_to(node, place);
    return node;
}

std::string described(const TomlNode& node) {
    switch (node.kind) {
        case TomlKind::table:
            return "a table";
        case TomlKind::list:
            return "a list of " + std::to_string(node.items.size());
        case TomlKind::text:
            return "the text \"" + node.text + "\"";
        case TomlKind::integer:
            return "the number " + std::to_string(node.integer);
        case TomlKind::number:
            return "the number " + number_text(node.number);
        case TomlKind::boolean:
            return node.text;
        case TomlKind::date:
            break;
    }
    return "a date or time";
}

}  // namespace percale::scenes
