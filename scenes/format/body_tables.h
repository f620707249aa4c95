#pragma once

#include "fields/field_table.h"
#include "format/scene.h"

// The fields of what a scene is made of: [[cloth]] and [[obstacle]].
namespace percale::scenes {

const FieldTable<ClothSpec>& cloth_table();
const FieldTable<ObstacleSpec>& obstacle_table();

/// The same as in toml_values.h for values of other types.
void read_value(const TomlNode& node, VertexSelection& value);
TomlNode value_node(const VertexSelection& value);
void read_value(const TomlNode& node, Warp& value);
TomlNode value_node(const Warp& value);
template <>
inline constexpr ValueKind value_kind<Warp> = {KeyKind::direction};

template <>
inline constexpr ValueKind value_kind<VertexSelection> = {KeyKind::vertices};

/// A row that says which vertices of a cloth are meant.
template <class Spec, class Access>
Field<Spec> selection_field(SceneKey key, Access access) {
    Field<Spec> field = value_field<Spec>(std::move(key), access);
    field.key.inside.push_back({.path = "box",
                                .kind = KeyKind::box,
                                .sentence = "Vertices inside a box whose corners are given in "
                                            "fractions of the bounding box of the cloth as it starts.",
                                .lowest = -1.0,
                                .highest = 2.0,
                                .required = true});
    return field;
}

}  // namespace percale::scenes
