#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/fault_list.h"
#include "fields/scene_keys.h"
#include "fields/toml_document.h"
#include "fields/toml_values.h"

// The fields of a spec of a scene file, a row each. From the rows come its keys (checks, `percale explain`,
// scenes/scene_keys.md), its reading and its writing (settings in report.json, identity of a checkpoint). The tables are in
// format/.
namespace percale::scenes {

/// One field: what its key is, and how the key's value gets into a spec and out again.
template <class Spec>
struct Field {
    SceneKey key;
    std::function<void(const TomlNode& value, Spec& spec, FaultList& faults)> read;
    std::function<std::optional<TomlNode>(const Spec& spec)> write;  // nothing: the spec does not have it
};

/// What the keys of a table have to do with each other. Of keys that are alternatives (SceneKey) there must be exactly one.
struct TableRules {
    std::string (*shown)(const TomlNode& table) = nullptr;          // how messages name a table
    std::vector<std::string> at_least_one = {};                     // of these keys
    std::string at_least_one_why = {};                              // what a table without lacks
    std::vector<std::pair<std::string, std::string>> exclude = {};  // dotted keys that exclude each other
};

template <class Spec>
struct FieldTable {
    std::vector<Field<Spec>> fields;
    TableRules rules = {};
    void (*finish)(const TomlNode& table, Spec& spec) = nullptr;  // after reading: what several keys say together
};

/// Throw SceneFileError where a table breaks its rules, or has a value that means nothing without another key.
void check_rules(const TomlNode& table, const TableRules& rules);
void check_needs(const TomlNode& table, const TomlNode& value, const SceneKey& key);

template <class Spec>
std::vector<SceneKey> keys_of(const FieldTable<Spec>& table) {
    std::vector<SceneKey> keys;
    for (const Field<Spec>& field : table.fields) keys.push_back(field.key);
    return keys;
}

/// Calls `act` with every field in order, alternatives all where the first of them stands.
template <class Spec, class Act>
void each_field(const FieldTable<Spec>& table, Act act) {
    bool first = true;
    for (const Field<Spec>& field : table.fields) {
        if (!field.key.alternative) act(field);
        if (!field.key.alternative || !std::exchange(first, false)) continue;
        for (const Field<Spec>& other : table.fields)
            if (other.key.alternative) act(other);
    }
}

/// Reads a table of a checked document into a spec. Throws SceneFileError for what the keys say together; faults of lists of
/// tables go to `faults`.
template <class Spec>
void read_fields(const TomlNode& node, const FieldTable<Spec>& table, Spec& spec, FaultList& faults) {
    check_rules(node, table.rules);
    std::vector<std::string> alternatives;
    for (const Field<Spec>& field : table.fields)
        if (field.key.alternative) alternatives.push_back(field.key.path);
    bool chosen = alternatives.empty();
    each_field(table, [&](const Field<Spec>& field) {
        if (field.key.alternative && !std::exchange(chosen, true)) only_key(node, alternatives, table.rules.shown(node));
        const TomlNode* value = node.find(field.key.path);
        if (value == nullptr) return;
        check_needs(node, *value, field.key);
        field.read(*value, spec, faults);
    });
    if (table.finish != nullptr) table.finish(node, spec);
}

/// Reads a table into a new spec. Throws SceneFileError for the first fault.
template <class Spec>
Spec read_spec(const TomlNode& node, const FieldTable<Spec>& table) {
    Spec spec;
    if constexpr (requires { spec.place; }) spec.place = node.place;
    FaultList first(false);
    read_fields(node, table, spec, first);
    return spec;
}

/// A spec as a table: all that it has, defaults included.
template <class Spec>
TomlNode spec_node(const FieldTable<Spec>& table, const Spec& spec) {
    TomlNode node;
    each_field(table, [&](const Field<Spec>& field) {
        std::optional<TomlNode> value = field.write(spec);
        if (!value) return;
        value->key = field.key.path;
        node.entries.push_back(std::move(*value));
    });
    return node;
}

/// Access to a spec whose rows work on it as a whole.
inline constexpr auto itself = [](auto& spec) -> auto& { return spec; };

// Rows. `access` is a pointer to a member, or a function from a spec to a reference to the field.

/// The row with the default of its key, which is the value of a default-constructed spec.
template <class Spec>
Field<Spec> with_default(Field<Spec> row) {
    if (row.key.required || row.key.alternative) return row;
    const Spec defaults;
    const std::optional<TomlNode> value = row.write(defaults);
    if (value) row.key.default_text = value_text(row.key.kind, *value);
    return row;
}

/// A value; its kind follows from the type of the field. A text with choices is a word.
template <class Spec, class Access>
Field<Spec> value_field(SceneKey key, Access access) {
    using Value = std::remove_cvref_t<std::invoke_result_t<Access, Spec&>>;
    key.kind = key.choices.empty() || value_kind<Value>.kind == KeyKind::words ? value_kind<Value>.kind : KeyKind::word;
    key.count = value_kind<Value>.count;
    return with_default<Spec>(
        {.key = std::move(key),
         .read = [access](const TomlNode& node, Spec& spec, FaultList&) { read_value(node, std::invoke(access, spec)); },
         .write = [access](const Spec& spec) -> std::optional<TomlNode> { return value_node(std::invoke(access, spec)); }});
}

/// A unit quaternion; `shown` is how messages name the key.
template <class Spec, class Access>
Field<Spec> rotation_field(SceneKey key, const std::string& shown, Access access) {
    key.kind = value_kind<Rotation>.kind;
    key.count = value_kind<Rotation>.count;
    return with_default<Spec>(
        {.key = std::move(key),
         .read = [access, shown](const TomlNode& node, Spec& spec,
                                 FaultList&) { std::invoke(access, spec) = read_rotation(node, shown); },
         .write = [access](const Spec& spec) -> std::optional<TomlNode> { return value_node(std::invoke(access, spec)); }});
}

/// An enumeration, or a number that words stand for: `values` in the order of `words`.
template <class Spec, class Access, class Value>
Field<Spec> word_field(SceneKey key, Access access, std::span<const std::string_view> words, std::vector<Value> values) {
    key.kind = KeyKind::word;
    key.choices.assign(words.begin(), words.end());
    const std::vector<std::string> choices = key.choices;
    const auto read = [=](const TomlNode& node, Spec& spec, FaultList&) {
        for (std::size_t i = 0; i < choices.size(); ++i)
            if (choices[i] == node.text) std::invoke(access, spec) = values[i];
    };
    const auto write = [=](const Spec& spec) -> std::optional<TomlNode> {
        for (std::size_t i = 0; i < choices.size(); ++i)
            if (values[i] == std::invoke(access, spec)) return value_node(choices[i]);
        return std::nullopt;
    };
    return with_default<Spec>({.key = std::move(key), .read = read, .write = write});
}

/// A table inside: a member that has a table of its own, or an optional of one.
template <class Spec, class Inner, class Access>
Field<Spec> table_field(SceneKey key, Access access, const FieldTable<Inner>& inner) {
    key.kind = KeyKind::table;
    key.inside = keys_of(inner);
    return {.key = std::move(key),
            .read =
                [=](const TomlNode& node, Spec& spec, FaultList& faults) {
                    auto& field = std::invoke(access, spec);
                    if constexpr (requires { field.emplace(); }) {
                        read_fields(node, inner, field.emplace(), faults);
                    } else {
                        read_fields(node, inner, field, faults);
                    }
                },
            .write = [=](const Spec& spec) -> std::optional<TomlNode> {
                const auto& field = std::invoke(access, spec);
                if constexpr (requires { field.has_value(); }) {
                    return field ? std::optional(spec_node(inner, *field)) : std::nullopt;
                } else {
                    TomlNode node = spec_node(inner, field);
                    return node.entries.empty() ? std::nullopt : std::optional(std::move(node));
                }
            }};
}

/// A list of tables, one for each item of a std::vector.
template <class Spec, class Item>
Field<Spec> list_field(SceneKey key, std::vector<Item> Spec::*list, const FieldTable<Item>& inner) {
    key.kind = KeyKind::table_list;
    key.inside = keys_of(inner);
    return {.key = std::move(key),
            .read =
                [=](const TomlNode& node, Spec& spec, FaultList& faults) {
                    for (const TomlNode& item : node.items)
                        faults.attempt([&] { (spec.*list).push_back(read_spec(item, inner)); });
                },
            .write = [=](const Spec& spec) -> std::optional<TomlNode> {
                TomlNode node;
                node.kind = TomlKind::list;
                for (const Item& item : spec.*list) node.items.push_back(spec_node(inner, item));
                return node;
            }};
}

/// One alternative of a std::variant, written as a table.
template <class Alternative, class Spec, class Access>
Field<Spec> variant_table(SceneKey key, Access access, const FieldTable<Alternative>& inner) {
    key.kind = KeyKind::table;
    key.alternative = true;
    key.inside = keys_of(inner);
    return {.key = std::move(key),
            .read =
                [=](const TomlNode& node, Spec& spec, FaultList& faults) {
                    Alternative alternative;
                    read_fields(node, inner, alternative, faults);
                    std::invoke(access, spec) = std::move(alternative);
                },
            .write = [=](const Spec& spec) -> std::optional<TomlNode> {
                const auto* alternative = std::get_if<Alternative>(&std::invoke(access, spec));
                return alternative != nullptr ? std::optional(spec_node(inner, *alternative)) : std::nullopt;
            }};
}

/// One alternative of a std::variant, written as the value of its only member.
template <class Alternative, class Spec, class Access, class Value>
Field<Spec> variant_value(SceneKey key, Access access, Value Alternative::*value) {
    key.kind = value_kind<Value>.kind;
    key.count = value_kind<Value>.count;
    key.alternative = true;
    return {.key = std::move(key),
            .read =
                [=](const TomlNode& node, Spec& spec, FaultList&) {
                    Alternative alternative;
                    read_value(node, alternative.*value);
                    std::invoke(access, spec) = std::move(alternative);
                },
            .write = [=](const Spec& spec) -> std::optional<TomlNode> {
                const auto* alternative = std::get_if<Alternative>(&std::invoke(access, spec));
                return alternative != nullptr ? std::optional(value_node(alternative->*value)) : std::nullopt;
            }};
}

}  // namespace percale::scenes
