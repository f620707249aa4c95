#pragma once

#include <algorithm>

#include "fields/field_table.h"
#include "percale/options.h"

// The engine's lists of options (percale/options.h) as rows of a table of a scene file.
namespace percale::scenes {

template <class Owner>
KeyKind option_kind(const Option<Owner>& option) {
    if (option.number) return option.automatic ? KeyKind::number_or_auto : KeyKind::number;
    if (option.integer) return option.zero_is_auto ? KeyKind::integer_or_auto : KeyKind::integer;
    if (option.flag) return KeyKind::flag;
    if (option.number_or_auto) return KeyKind::number_or_auto;
    if (option.optional_number) return KeyKind::number;
    return option.optional_pair ? KeyKind::numbers : KeyKind::word;
}

template <class Owner>
void read_option(const TomlNode& node, const Option<Owner>& option, Owner& owner) {
    if (option.number) {
        if (node.is_number()) *option.number(owner) = node.number;
        if (option.automatic) *option.automatic(owner) = !node.is_number();
    } else if (option.integer) {
        // A word is "auto" here, of which node.integer is 0.
        read_value(node, *option.integer(owner));
    } else if (option.flag) {
        read_value(node, *option.flag(owner));
    } else if (option.number_or_auto) {
        *option.number_or_auto(owner) = node.is_number() ? std::optional(node.number) : std::nullopt;
    } else if (option.optional_number) {
        read_value(node, *option.optional_number(owner));
    } else if (option.optional_pair) {
        read_value(node, *option.optional_pair(owner));
    } else {
        const auto found = std::find(option.choices.begin(), option.choices.end(), node.text);
        option.set_choice(owner, static_cast<int>(found - option.choices.begin()));
    }
}

template <class Owner>
std::optional<TomlNode> option_node(const Option<Owner>& option, Owner owner) {
    const std::string automatic = "auto";
    if (option.automatic && *option.automatic(owner)) return value_node(automatic);
    if (option.number) return value_node(*option.number(owner));
    if (option.zero_is_auto && *option.integer(owner) == 0) return value_node(automatic);
    if (option.integer) return value_node(*option.integer(owner));
    if (option.flag) return value_node(*option.flag(owner));
    if (option.optional_number) return value_node(*option.optional_number(owner));
    if (option.optional_pair) return value_node(*option.optional_pair(owner));
    if (option.get_choice) return value_node(std::string(option.choices[static_cast<std::size_t>(option.get_choice(owner))]));
    const std::optional<TomlNode> number = value_node(*option.number_or_auto(owner));
    return number ? number : value_node(automatic);
}

/// `access` leads from a spec to the owner of the option.
template <class Spec, class Owner, class Access>
Field<Spec> option_field(const Option<Owner>& option, Access access) {
    SceneKey key{.path = std::string(option.key),
                 .kind = option_kind(option),
                 .sentence = std::string(option.sentence),
                 .unit = std::string(option.unit),
                 .lowest = option.lowest,
                 .highest = option.highest,
                 .count = option.optional_pair ? 2 : 0,
                 .choices = {option.choices.begin(), option.choices.end()}};
    key.required = option.required;
    key.former = std::string(option.former);
    return with_default<Spec>(
        {.key = std::move(key),
         .read = [=](const TomlNode& node, Spec& spec, FaultList&) { read_option(node, option, std::invoke(access, spec)); },
         .write = [=](const Spec& spec) { return option_node(option, std::invoke(access, spec)); }});
}

/// All options of a list. Those with a dotted key go into the table inside that `group` describes.
template <class Spec, class Owner, class Access>
std::vector<Field<Spec>> option_fields(std::span<const Option<Owner>> options, Access access, const SceneKey& group = {}) {
    std::vector<Field<Spec>> fields;
    FieldTable<Spec> inner;
    std::size_t at = 0;
    const std::string prefix = group.path + ".";
    for (const Option<Owner>& option : options) {
        Field<Spec> field = option_field<Spec>(option, access);
        if (!field.key.path.starts_with(prefix)) {
            fields.push_back(std::move(field));
            continue;
        }
        if (inner.fields.empty()) at = fields.size();
        field.key.path.erase(0, prefix.size());
        inner.fields.push_back(std::move(field));
    }
    if (inner.fields.empty()) return fields;
    fields.insert(fields.begin() + static_cast<long>(at), table_field<Spec>(group, itself, inner));
    return fields;
}

}  // namespace percale::scenes
