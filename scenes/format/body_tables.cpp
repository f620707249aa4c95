#include "format/body_tables.h"

#include <cctype>
#include <initializer_list>

#include "common/length_unit.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "format/motion_keys.h"
#include "format/scene.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

VertexIndices indices_of(const TomlNode& list) {
    VertexIndices indices;
    for (const TomlNode& item : list.items) indices.vertices.push_back(static_cast<int>(item.integer));
    return indices;
}

struct SelectionNode {
    TomlNode operator()(const VertexIndices& s) const {
        TomlNode list;
        list.kind = TomlKind::list;
        for (const int vertex : s.vertices) list.items.push_back(value_node(vertex));
        return list;
    }
    TomlNode operator()(const VertexBox& s) const {
        TomlNode corners, node;
        corners.kind = TomlKind::list;
        corners.key = "box";
        corners.items = {value_node(s.lowest), value_node(s.highest)};
        node.entries.push_back(std::move(corners));
        if (s.to.empty()) return node;
        node.entries.push_back(value_node(s.to));
        node.entries.back().key = "to";
        return node;
    }
    TomlNode operator()(const VertexBoundary&) const { return value_node(std::string("boundary")); }
};

// Names become file names and parts of dotted keys.
bool fits_name(unsigned char letter) { return std::isalnum(letter) || letter == '_' || letter == '-' || letter >= 0x80; }

void check_name(const TomlNode& node, const std::string& list) {
    const std::string& name = node.text;
    const unsigned char first = name.empty() ? '\0' : static_cast<unsigned char>(name.front());
    bool good = std::isalpha(first) || first >= 0x80;
    for (const char letter : name) good = good && fits_name(static_cast<unsigned char>(letter));
    if (!good)
        fail_at(node.place, list + ".name = \"" + name + "\" must begin with a letter and hold only letters, digits, _ and -");
}

template <class Spec>
Field<Spec> name_field(const std::string& list, const std::string& sentence) {
    Field<Spec> field = value_field<Spec>({.path = "name", .sentence = sentence, .required = true}, &Spec::name);
    field.read = [list](const TomlNode& node, Spec& spec, FaultList&) {
        check_name(node, list);
        spec.name = node.text;
    };
    return field;
}

template <class Spec>
Field<Spec> mesh_field(const std::string& sentence) {
    Field<Spec> field = value_field<Spec>({.path = "mesh", .sentence = sentence, .alternative = true}, &Spec::mesh);
    field.write = [](const Spec& spec) { return spec.mesh.empty() ? std::nullopt : std::optional(value_node(spec.mesh)); };
    return field;
}

template <class Spec>
Field<Spec> unit_field() {
    return word_field<Spec>({.path = "unit",
                             .sentence = "What one unit of the mesh file is.",
                             .needs = "mesh",
                             .needs_why = "unit is that of a mesh file"},
                            &Spec::unit, length_unit_words,
                            std::vector<double>(length_unit_metres.begin(), length_unit_metres.end()));
}

template <class Spec>
Field<Spec> part_field() {
    return value_field<Spec>(
        {.path = "part",
         .sentence = "Object or group of an OBJ file, or node or mesh of a glTF, DAE or FBX file, that is taken "
                     "alone; vertices are counted in it.",
         .needs = "mesh",
         .needs_why = "part is one of a mesh file"},
        &Spec::part);
}

template <class Spec>
Field<Spec> weld_field() {
    return value_field<Spec>({.path = "weld",
                              .sentence = "Vertices of the mesh file that are as near as that become one; vertices are "
                                          "counted after it. Not with rest, stitches of the file, or bodies that bend.",
                              .unit = "m",
                              .lowest = 0.0,
                              .highest = max_weld,
                              .needs = "mesh",
                              .needs_why = "weld joins vertices of a mesh file"},
                             &Spec::weld);
}

Field<ClothSpec> pattern_field() {
    Field<ClothSpec> field = value_field<ClothSpec>(
        {.path = "pattern",
         .sentence =
             "Sewing pattern (.toml or GarmentCode's .json), relative to the scene file; instead of grid. Its flat panels "
             "are the rest shape, warp runs along their y; its seams close within 1 s, if no [[seam]] with file = "
             "\"mesh\" says otherwise.",
         .alternative = true},
        &ClothSpec::pattern);
    field.write = [](const ClothSpec& spec) {
        return spec.pattern.empty() ? std::nullopt : std::optional(value_node(spec.pattern));
    };
    return field;
}

/// A length that says how panels are made; written with a pattern alone.
Field<ClothSpec> panel_field(SceneKey key, double ClothSpec::*length) {
    key.unit = "m";
    key.needs = "pattern";
    Field<ClothSpec> field = value_field<ClothSpec>(std::move(key), length);
    field.write = [length](const ClothSpec& spec) {
        return spec.pattern.empty() ? std::nullopt : std::optional(value_node(spec.*length));
    };
    return field;
}

Field<ClothSpec> edge_length_field() {
    return panel_field({.path = "edge_length",
                        .sentence = "How long the edges of a pattern's mesh are.",
                        .lowest = 1e-4,
                        .highest = 1.0,
                        .needs_why = "edge_length is that of a pattern's mesh"},
                       &ClothSpec::edge_length);
}

Field<ClothSpec> panel_offset_field() {
    return panel_field({.path = "panel_offset",
                        .sentence = "How much farther out the panels of a pattern start than its layer has them, each along its "
                                    "normal: room for what is worn below.",
                        .lowest = 0.0,
                        .highest = 10.0,
                        .needs_why = "panel_offset moves a pattern's panels"},
                       &ClothSpec::panel_offset);
}

Field<ClothSpec> rest_field() {
    Field<ClothSpec> field =
        value_field<ClothSpec>({.path = "rest",
                                .sentence = "Where it has no strain: a mesh file of the same triangles, or \"uv\" for the vt of "
                                            "the mesh (OBJ); without it as it starts.",
                                .needs = "mesh",
                                .needs_why = "grids and patterns are their own rest shape"},
                               &ClothSpec::rest);
    field.key.default_text.clear();
    field.write = [](const ClothSpec& spec) { return spec.rest.empty() ? std::nullopt : std::optional(value_node(spec.rest)); };
    return field;
}

Field<ClothSpec> uv_scale_field() {
    Field<ClothSpec> field =
        value_field<ClothSpec>({.path = "uv_scale",
                                .sentence = "How long one unit of the vt is without strain; with rest = \"uv\".",
                                .unit = "m",
                                .lowest = 1e-6,
                                .highest = 1e6,
                                .needs = "mesh",
                                .needs_why = "uv_scale is that of a mesh file's vt"},
                               &ClothSpec::uv_scale);
    field.write = [](const ClothSpec& spec) {
        return spec.rest == "uv" ? std::optional(value_node(spec.uv_scale)) : std::nullopt;
    };
    return field;
}

const FieldTable<Pose>& pose_table() {
    static const FieldTable<Pose> table = {
        .fields = {
            value_field<Pose>({.path = "translation",
                               .sentence = "Where the mesh's origin comes to lie.",
                               .unit = "m",
                               .lowest = -max_coordinate,
                               .highest = max_coordinate},
                              &Pose::translation),
            rotation_field<Pose>({.path = "rotation",
                                  .sentence = "Unit quaternion w, x, y, z (length 1 to within 0.001).",
                                  .lowest = -1.001,
                                  .highest = 1.001},
                                 "pose.rotation", &Pose::rotation),
            value_field<Pose>({.path = "scale", .sentence = "Factor on the mesh's size.", .lowest = 1e-6, .highest = 1e6},
                              &Pose::scale),
        }};
    return table;
}

template <class Spec>
Field<Spec> pose_field() {
    return table_field<Spec>({.path = "pose", .sentence = "Where the mesh stands: x -> translation + rotation (scale x)."},
                             &Spec::pose, pose_table());
}

const FieldTable<GridSpec>& grid_table() {
    static const FieldTable<GridSpec> table = {
        .fields = {
            value_field<GridSpec>({.path = "size",
                                   .sentence = "Width along x and depth along z.",
                                   .unit = "m",
                                   .lowest = 1e-4,
                                   .highest = 1e3,
                                   .required = true},
                                  &GridSpec::size),
            value_field<GridSpec>(
                {.path = "vertices", .sentence = "Vertices along x and along z.", .lowest = 2, .highest = 4096, .required = true},
                &GridSpec::vertices),
        }};
    return table;
}

/// uv are two numbers, and there are none without rest = "uv".
void check_warp(const TomlNode& table, const ClothSpec& cloth) {
    if (!cloth.warp || cloth.warp->in_uv == (cloth.rest == "uv")) return;
    fail_at(table.find("warp")->place, cloth.warp->in_uv ? "warp in uv (\"u\", \"v\" or two numbers) needs rest = \"uv\""
                                                         : "with rest = \"uv\" warp is \"u\", \"v\" or two numbers");
}

void finish_cloth(const TomlNode& table, ClothSpec& cloth) {
    check_warp(table, cloth);
    if (table.find("uv_scale") != nullptr && cloth.rest != "uv")
        fail_at(table.find("uv_scale")->place, "uv_scale needs rest = \"uv\"");
    const TomlNode* pin = table.find("pin");
    const TomlNode* box = pin != nullptr ? pin->find("box") : nullptr;
    cloth.pin_place = box != nullptr ? box->place : pin != nullptr ? pin->place : cloth.place;
}

/// A length of a shape.
template <class Spec>
Field<Spec> length_field(const std::string& key, double lowest, const std::string& sentence, double Spec::*length) {
    return value_field<Spec>({.path = key, .sentence = sentence, .unit = "m", .lowest = lowest, .highest = 1e4, .required = true},
                             length);
}

template <class Alternative>
Field<Shape> shape_field(const std::string& key, const std::string& sentence, std::vector<Field<Alternative>> fields) {
    return variant_table<Alternative, Shape>({.path = key, .sentence = sentence}, itself, {.fields = std::move(fields)});
}

const FieldTable<Shape>& shape_table() {
    static const FieldTable<Shape> table = {
        .fields = {shape_field<SphereShape>("sphere", "A sphere of 5120 triangles.",
                                            {length_field("radius", 1e-6, "Radius.", &SphereShape::radius)}),
                   shape_field<BoxShape>("box", "A box along the axes.",
                                         {value_field<BoxShape>({.path = "size",
                                                                 .sentence = "Edge lengths.",
                                                                 .unit = "m",
                                                                 .lowest = 1e-6,
                                                                 .highest = 1e4,
                                                                 .required = true},
                                                                &BoxShape::size)}),
                   shape_field<CapsuleShape>(
                       "capsule", "A capsule about the y axis, 48 segments around.",
                       {length_field("radius", 1e-6, "Radius.", &CapsuleShape::radius),
                        length_field("height", 0.0, "Length between the centres of its half spheres.", &CapsuleShape::height)}),
                   shape_field<CylinderShape>("cylinder", "A closed cylinder about the y axis, 48 segments around.",
                                              {length_field("radius", 1e-6, "Radius.", &CylinderShape::radius),
                                               length_field("height", 1e-6, "Height.", &CylinderShape::height)}),
                   shape_field<PlaneShape>(
                       "plane", "A horizontal square at y = 0, facing up.",
                       {value_field<PlaneShape>(
                           {.path = "half_size", .sentence = "Half of an edge.", .unit = "m", .lowest = 1e-6, .highest = 1e4},
                           &PlaneShape::half_size)})},
        .rules = {.shown = [](const TomlNode&) -> std::string { return "shape"; }}};
    return table;
}

/// Lists of rows, one after the other.
template <class Spec>
std::vector<Field<Spec>> in_turn(std::initializer_list<std::vector<Field<Spec>>> lists) {
    std::vector<Field<Spec>> fields;
    for (const std::vector<Field<Spec>>& list : lists) fields.insert(fields.end(), list.begin(), list.end());
    return fields;
}

std::string cloth_shown(const TomlNode& table) { return "cloth '" + table.find("name")->text + "'"; }
std::string obstacle_shown(const TomlNode& table) { return "obstacle '" + table.find("name")->text + "'"; }

}  // namespace

void read_value(const TomlNode& node, Warp& value) {
    value.in_uv = node.kind == TomlKind::text || node.items.size() == 2;
    if (node.kind == TomlKind::text) {
        value.direction = node.text == "u" ? Vec3::UnitX() : Vec3::UnitY();
        return;
    }
    value.direction = Vec3::Zero();
    for (std::size_t i = 0; i < node.items.size(); ++i) value.direction[static_cast<int>(i)] = node.items[i].number;
}

TomlNode value_node(const Warp& value) {
    if (value.in_uv && value.direction == Vec3::UnitX()) return value_node(std::string("u"));
    if (value.in_uv && value.direction == Vec3::UnitY()) return value_node(std::string("v"));
    return value.in_uv ? value_node(std::array{value.direction.x(), value.direction.y()}) : value_node(value.direction);
}

void read_value(const TomlNode& node, VertexSelection& value) {
    if (node.kind == TomlKind::text) {
        value = VertexBoundary{};
    } else if (const TomlNode* box = node.find("box")) {
        VertexBox& corners = value.emplace<VertexBox>();
        read_value(box->items[0], corners.lowest);
        read_value(box->items[1], corners.highest);
        if (const TomlNode* to = node.find("to")) read_value(*to, corners.to);
    } else {
        value = indices_of(node);
    }
}

TomlNode value_node(const VertexSelection& value) { return std::visit(SelectionNode{}, value); }

Field<ClothSpec> pin_field() {
    Field<ClothSpec> field =
        selection_field<ClothSpec>({.path = "pin", .sentence = "Vertices held where they start."}, &ClothSpec::pin);
    field.key.inside.push_back({.path = "to",
                                .kind = KeyKind::text,
                                .sentence = "NAME of an obstacle: they keep their place on it as it moves, instead of in the "
                                            "world."});
    return field;
}

const FieldTable<ClothSpec>& cloth_table() {
    static const FieldTable<ClothSpec> table = {
        .fields = {name_field<ClothSpec>("cloth", "Its name in events, messages and file names; must begin with a letter."),
                   value_field<ClothSpec>({.path = "fabric", .sentence = "NAME of a [fabric.NAME].", .required = true},
                                          &ClothSpec::fabric),
                   table_field<ClothSpec>({.path = "grid",
                                           .sentence = "A flat regular grid in the plane y = 0, centred; instead of mesh.",
                                           .alternative = true},
                                          &ClothSpec::grid, grid_table()),
                   mesh_field<ClothSpec>("Mesh file, relative to the scene file; instead of grid."), unit_field<ClothSpec>(),
                   part_field<ClothSpec>(), weld_field<ClothSpec>(), pattern_field(), edge_length_field(), panel_offset_field(),
                   rest_field(), uv_scale_field(),
                   value_field<ClothSpec>({.path = "warp",
                                           .sentence = "Where warp runs, of any length: in uv, then v if not said, or in the "
                                                       "axes of the mesh without strain; weft is across.",
                                           .lowest = -max_coordinate,
                                           .highest = max_coordinate,
                                           .needs = "mesh",
                                           .needs_why = "warp of a grid runs along x, of a pattern as its panels say"},
                                          &ClothSpec::warp),
                   value_field<ClothSpec>({.path = "layer",
                                           .sentence = "Where it is worn, from the inside out: panels of a pattern start 0.04 m "
                                                       "farther out for each layer above 0; of cloths with self_contact that "
                                                       "start through each other the one of the higher layer is moved outside.",
                                           .lowest = -1000.0,
                                           .highest = 1000.0},
                                          &ClothSpec::layer),
                   pose_field<ClothSpec>(), pin_field()},
        .rules = {.shown = cloth_shown},
        .finish = finish_cloth};
    return table;
}

const FieldTable<ObstacleSpec>& obstacle_table() {
    static const FieldTable<ObstacleSpec> table = {
        .fields = in_turn<ObstacleSpec>(
            {{name_field<ObstacleSpec>("obstacle", "Its name in messages and file names; must begin with a letter."),
              mesh_field<ObstacleSpec>("Mesh file, relative to the scene file; instead of shape."), unit_field<ObstacleSpec>(),
              part_field<ObstacleSpec>(), weld_field<ObstacleSpec>()},
             bend_fields(),
             {table_field<ObstacleSpec>({.path = "shape",
                                         .sentence = "Exactly one of the shapes below, centred at its origin; instead of mesh.",
                                         .alternative = true},
                                        &ObstacleSpec::shape, shape_table()),
              value_field<ObstacleSpec>(
                  {.path = "friction", .sentence = "Coulomb coefficient against cloth.", .lowest = 0.0, .highest = 10.0},
                  &ObstacleSpec::friction),
              value_field<ObstacleSpec>({.path = "restitution",
                                         .sentence = "Share of its normal speed with which cloth that hits it leaves; slower "
                                                     "than gravity makes it in a step, it stays.",
                                         .lowest = 0.0,
                                         .highest = 1.0},
                                        &ObstacleSpec::restitution),
              pose_field<ObstacleSpec>(), motion_field(), spin_field(), pinch_field()}}),
        .rules = {.shown = obstacle_shown}};
    return table;
}

}  // namespace percale::scenes
