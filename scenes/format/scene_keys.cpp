#include "format/scene_keys.h"

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "format/expectations.h"
#include "frames/frame_formats.h"
#include "percale/fabric_presets.h"
#include "percale/options.h"

namespace percale::scenes {
namespace {

using Keys = std::vector<SceneKey>;

std::string list_text(std::span<const double> values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "[" : ", ") + number_text(value);
    return text + "]";
}

std::string list_text(const Vec3& v) { return list_text(std::span<const double>(v.data(), 3)); }

template <class Owner>
SceneKey option_key(const std::string& table, const Option<Owner>& option, Owner defaults = {}) {
    SceneKey key{.path = table + "." + std::string(option.key), .sentence = std::string(option.sentence)};
    key.unit = option.unit;
    key.lowest = option.lowest;
    key.highest = option.highest;
    key.choices.assign(option.choices.begin(), option.choices.end());
    if (option.number) {
        key.kind = option.automatic ? KeyKind::number_or_auto : KeyKind::number;
        key.default_text = number_text(*option.number(defaults));
    } else if (option.integer) {
        key.kind = KeyKind::integer;
        key.default_text = std::to_string(*option.integer(defaults));
    } else if (option.flag) {
        key.kind = KeyKind::flag;
        key.default_text = *option.flag(defaults) ? "true" : "false";
    } else if (option.number_or_auto) {
        key.kind = KeyKind::number_or_auto;
        const std::optional<double>& value = *option.number_or_auto(defaults);
        key.default_text = value ? number_text(*value) : "auto";
    } else if (option.optional_number) {
        key.kind = KeyKind::number;
    } else if (option.optional_pair) {
        key.kind = KeyKind::numbers;
        key.count = 2;
    } else {
        key.kind = KeyKind::word;
        key.default_text = key.choices.at(static_cast<std::size_t>(option.get_choice(defaults)));
    }
    return key;
}

SceneKey table_key(const std::string& path, const std::string& sentence, KeyKind kind = KeyKind::table) {
    return {.path = path, .kind = kind, .sentence = sentence};
}

SceneKey number_key(const std::string& path, const std::string& unit, double lowest, double highest,
                    const std::string& sentence) {
    return {.path = path, .kind = KeyKind::number, .sentence = sentence, .unit = unit, .lowest = lowest, .highest = highest};
}

SceneKey numbers_key(const std::string& path, int count, const std::string& unit, double limit, const std::string& sentence) {
    SceneKey key{.path = path, .kind = KeyKind::numbers, .sentence = sentence, .unit = unit};
    key.lowest = -limit;
    key.highest = limit;
    key.count = count;
    return key;
}

SceneKey text_key(const std::string& path, const std::string& sentence) {
    return {.path = path, .kind = KeyKind::text, .sentence = sentence};
}

SceneKey word_key(const std::string& path, std::vector<std::string> choices, const std::string& sentence) {
    return {.path = path, .kind = KeyKind::word, .sentence = sentence, .choices = std::move(choices)};
}

SceneKey with_default(SceneKey key, const std::string& default_text) {
    key.default_text = default_text;
    return key;
}

SceneKey required(SceneKey key) {
    key.required = true;
    return key;
}

constexpr double farthest = 1e6;  // m
constexpr double longest = 1e6;   // s

void add_top(Keys& keys) {
    const Scene defaults;
    keys.push_back(with_default(text_key("title", "What the scene shows."), "\"\""));
    keys.push_back(
        with_default(number_key("duration", "s", 1e-6, longest, "How long to simulate."), number_text(defaults.duration)));
    keys.push_back(with_default(numbers_key("gravity", 3, "m/s^2", 1e4, "Acceleration of free fall; y is up."),
                                list_text(defaults.step.gravity)));
}

void add_step(Keys& keys) {
    const Scene defaults;
    keys.push_back(table_key("step", "How the simulation steps."));
    for (const auto& option : step_options()) keys.push_back(option_key("step", option, defaults.step));
    SceneKey detector = word_key("step.detector", {detector_words.begin(), detector_words.end()},
                                 "Which tree finds obstacle triangles near the cloth; all find the same contacts; none refuses "
                                 "obstacles.");
    detector.default_text = word_of(defaults.detector);
    keys.push_back(std::move(detector));
}

void add_fabric(Keys& keys) {
    keys.push_back(table_key("fabric", "What cloth is made of; one table [fabric.NAME] for each fabric.", KeyKind::named_tables));
    std::vector<std::string> presets;
    for (const FabricPreset& preset : fabric_presets()) presets.emplace_back(preset.name);
    keys.push_back(
        word_key("fabric.preset", std::move(presets),
                 "A fabric to start from, which single keys override; instead of springs. percale explain presets lists "
                 "them with their numbers."));
    for (const auto& option : fabric_options()) {
        SceneKey key = option_key("fabric", option);
        if (key.path.starts_with("fabric.springs.") && keys.back().path.find(".springs") == std::string::npos)
            keys.push_back(table_key("fabric.springs",
                                     "Constants of the springs, whatever their length; or stretch_stiffness, or a preset."));
        if (key.path == "fabric.springs.structural") key = required(with_default(std::move(key), ""));
        keys.push_back(std::move(key));
    }
}

void add_pose(Keys& keys, const std::string& table) {
    const std::string path = table + ".pose";
    const Pose defaults;
    const Rotation& r = defaults.rotation;
    keys.push_back(table_key(path, "Where the mesh stands: x -> translation + rotation (scale x)."));
    keys.push_back(with_default(numbers_key(path + ".translation", 3, "m", farthest, "Where the mesh's origin comes to lie."),
                                list_text(defaults.translation)));
    keys.push_back(
        with_default(numbers_key(path + ".rotation", 4, "", 1.001, "Unit quaternion w, x, y, z (length 1 to within 0.001)."),
                     list_text(std::array{r.w, r.x, r.y, r.z})));
    keys.push_back(
        with_default(number_key(path + ".scale", "", 1e-6, 1e6, "Factor on the mesh's size."), number_text(defaults.scale)));
}

void add_mesh(Keys& keys, const std::string& table, const std::string& sentence) {
    keys.push_back(text_key(table + ".mesh", sentence));
    keys.push_back(with_default(word_key(table + ".unit", {"mm", "cm", "m"}, "What one unit of the mesh file is."), "m"));
}

void add_selection(Keys& keys, SceneKey key) {
    key.kind = KeyKind::vertices;
    SceneKey box{.path = key.path + ".box",
                 .kind = KeyKind::box,
                 .sentence =
                     "Vertices inside a box whose corners are given in "
                     "fractions of the bounding box of the cloth's rest shape."};
    box.lowest = -1.0;
    box.highest = 2.0;
    keys.push_back(std::move(key));
    keys.push_back(std::move(box));
}

void add_cloth(Keys& keys) {
    keys.push_back(required(table_key("cloth", "One piece of cloth; [[cloth]] once for each.", KeyKind::table_list)));
    keys.push_back(required(text_key("cloth.name", "Its name in events, messages and file names; must begin with a letter.")));
    keys.push_back(required(text_key("cloth.fabric", "NAME of a [fabric.NAME].")));
    keys.push_back(table_key("cloth.grid", "A flat regular grid in the plane y = 0, centred; instead of mesh."));
    SceneKey size = required(numbers_key("cloth.grid.size", 2, "m", 1e3, "Width along x and depth along z."));
    size.lowest = 1e-4;
    keys.push_back(std::move(size));
    SceneKey vertices = required(numbers_key("cloth.grid.vertices", 2, "", 4096, "Vertices along x and along z."));
    vertices.kind = KeyKind::integers;
    vertices.lowest = 2;
    keys.push_back(std::move(vertices));
    add_mesh(keys, "cloth", "Mesh file, relative to the scene file; instead of grid.");
    add_pose(keys, "cloth");
    add_selection(keys, with_default(text_key("cloth.pin", "Vertices held where they start."), "[]"));
}

void add_shapes(Keys& keys) {
    const std::string path = "obstacle.shape";
    const auto length = [&](const std::string& key, double lowest, const std::string& sentence) {
        keys.push_back(required(number_key(path + key, "m", lowest, 1e4, sentence)));
    };
    keys.push_back(table_key(path, "Exactly one of the shapes below, centred at its origin; instead of mesh."));
    keys.push_back(table_key(path + ".sphere", "A sphere of 5120 triangles."));
    length(".sphere.radius", 1e-6, "Radius.");
    keys.push_back(table_key(path + ".box", "A box along the axes."));
    SceneKey size = required(numbers_key(path + ".box.size", 3, "m", 1e4, "Edge lengths."));
    size.lowest = 1e-6;
    keys.push_back(std::move(size));
    keys.push_back(table_key(path + ".capsule", "A capsule about the y axis, 48 segments around."));
    length(".capsule.radius", 1e-6, "Radius.");
    length(".capsule.height", 0.0, "Length between the centres of its half spheres.");
    keys.push_back(table_key(path + ".cylinder", "A closed cylinder about the y axis, 48 segments around."));
    length(".cylinder.radius", 1e-6, "Radius.");
    length(".cylinder.height", 1e-6, "Height.");
    keys.push_back(table_key(path + ".plane", "A horizontal square at y = 0, facing up."));
    keys.push_back(with_default(number_key(path + ".plane.half_size", "m", 1e-6, 1e4, "Half of an edge."),
                                number_text(PlaneShape{}.half_size)));
}

void add_motion(Keys& keys) {
    const Spin spin;
    keys.push_back(table_key("obstacle.motion",
                             "Keyframes, ascending in time: they replace the pose's translation and rotation, linear and the "
                             "shortest way in between, constant outside.",
                             KeyKind::table_list));
    keys.push_back(required(number_key("obstacle.motion.time", "s", 0.0, longest, "When.")));
    keys.push_back(numbers_key("obstacle.motion.translation", 3, "m", farthest, "Where; without it as in the keyframe before."));
    keys.push_back(numbers_key("obstacle.motion.rotation", 4, "", 1.001,
                               "Unit quaternion w, x, y, z; without it as in the keyframe before."));
    keys.push_back(
        table_key("obstacle.spin", "A steady turn about an axis through the mesh's origin, on top of pose and motion."));
    SceneKey axis =
        with_default(numbers_key("obstacle.spin.axis", 3, "", farthest, "Direction of the axis in the world, of any length."),
                     list_text(spin.axis));
    keys.push_back(std::move(axis));
    keys.push_back(
        required(number_key("obstacle.spin.turns_per_s", "1/s", -1e3, 1e3, "Counter-clockwise seen against the axis.")));
    keys.push_back(with_default(number_key("obstacle.spin.from", "s", 0.0, longest, "When it begins."), number_text(spin.from)));
}

void add_obstacle(Keys& keys) {
    const ObstacleSpec defaults;
    keys.push_back(table_key("obstacle", "A body that cloth cannot enter; [[obstacle]] once for each.", KeyKind::table_list));
    keys.push_back(required(text_key("obstacle.name", "Its name in messages and file names; must begin with a letter.")));
    add_mesh(keys, "obstacle", "Mesh file, relative to the scene file; instead of shape.");
    add_shapes(keys);
    keys.push_back(with_default(number_key("obstacle.friction", "", 0.0, 10.0, "Coulomb coefficient against cloth."),
                                number_text(defaults.friction)));
    add_pose(keys, "obstacle");
    add_motion(keys);
}

void add_pin_event(Keys& keys, const std::string& path, const std::string& sentence) {
    keys.push_back(table_key(path, sentence));
    keys.push_back(required(text_key(path + ".cloth", "NAME of a cloth.")));
    add_selection(keys, required(text_key(path + ".vertices", "Which of its vertices.")));
}

void add_event(Keys& keys) {
    keys.push_back(table_key("event",
                             "Something that happens once, before the first step at or after its time: exactly one of pin, "
                             "unpin, move, gravity, wind.",
                             KeyKind::table_list));
    keys.push_back(required(number_key("event.time", "s", 0.0, longest, "When; after the end of the scene it does not happen.")));
    add_pin_event(keys, "event.pin", "Holds vertices where they are then.");
    add_pin_event(keys, "event.unpin", "Lets vertices go.");
    add_pin_event(keys, "event.move", "Moves pinned vertices along a straight line.");
    keys.push_back(required(numbers_key("event.move.to", 3, "m", farthest, "How far from where they are then.")));
    keys.push_back(required(number_key("event.move.over", "s", 1e-6, longest, "How long it takes.")));
    keys.push_back(numbers_key("event.gravity", 3, "m/s^2", 1e4, "Gravity from then on."));
    keys.push_back(
        numbers_key("event.wind", 3, "m/s", 1e3,
                    "Velocity of the air from then on. Before the first wind there is no air; [0, 0, 0] stands still."));
}

void add_seam(Keys& keys) {
    const SeamSpec defaults;
    keys.push_back(table_key("seam", "Sews vertices together, pair by pair; [[seam]] once for each.", KeyKind::table_list));
    SceneKey cloths{
        .path = "seam.cloths", .kind = KeyKind::names, .sentence = "NAMEs of the two cloths; twice the same is one with itself."};
    cloths.count = 2;
    keys.push_back(required(std::move(cloths)));
    SceneKey pairs{.path = "seam.vertices",
                   .kind = KeyKind::pairs,
                   .sentence = "Pairs [i, j], i a vertex of the first cloth, j one of the second."};
    pairs.lowest = 0;
    pairs.highest = 2147483647;
    keys.push_back(required(std::move(pairs)));
    keys.push_back(
        with_default(number_key("seam.over", "s", 0.0, longest, "How long closing takes, from the start of the scene on."),
                     number_text(defaults.over)));
    keys.push_back(with_default(
        number_key("seam.stiffness", "N/m", 1e-3, 1e9, "Constant of the spring that draws a pair together and then holds it."),
        number_text(defaults.stiffness)));
}

void add_expect(Keys& keys) {
    keys.push_back(table_key("expect", "What makes the scene a test."));
    for (const MeasureDescription& measure : measure_descriptions())
        keys.push_back(
            {.path = "expect." + measure.name, .kind = KeyKind::limit, .sentence = measure.sentence, .unit = measure.unit});
    keys.push_back(table_key("expect.matches", "Compares the vertices at the end with a mesh, in the same order."));
    keys.push_back(required(text_key("expect.matches.file", "The mesh file, relative to the scene file.")));
    keys.push_back(required(number_key("expect.matches.within", "m", 0.0, farthest, "Largest distance of a vertex allowed.")));
}

void add_output(Keys& keys) {
    const OutputSpec defaults;
    keys.push_back(table_key("output", "What is written."));
    SceneKey frames = word_key("output.frames", frame_words(), "Format of the frames; " + frame_words_meaning() + ".");
    frames.default_text = defaults.frames;
    keys.push_back(std::move(frames));
    keys.push_back(with_default(number_key("output.fps", "1/s", 0.01, 1e5, "Frames per second of simulated time."),
                                number_text(defaults.fps)));
}

Keys all_keys() {
    Keys keys;
    add_top(keys);
    add_step(keys);
    add_fabric(keys);
    add_cloth(keys);
    add_obstacle(keys);
    add_seam(keys);
    add_event(keys);
    add_expect(keys);
    add_output(keys);
    return keys;
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
    static const Keys keys = all_keys();
    return keys;
}

const SceneKey* find_scene_key(std::string_view path) {
    for (const SceneKey& key : scene_keys())
        if (key.path == path) return &key;
    return nullptr;
}

std::vector<std::string> keys_inside(std::string_view path) {
    const std::string prefix = path.empty() ? "" : std::string(path) + ".";
    std::vector<std::string> names;
    for (const SceneKey& key : scene_keys()) {
        if (!key.path.starts_with(prefix)) continue;
        const std::string rest = key.path.substr(prefix.size());
        if (!rest.empty() && rest.find('.') == std::string::npos) names.push_back(rest);
    }
    return names;
}

std::string kind_text(const SceneKey& key) {
    switch (key.kind) {
        case KeyKind::text:
            return "a text";
        case KeyKind::word:
            return "one of " + joined(key.choices);
        case KeyKind::flag:
            return "true or false";
        case KeyKind::number:
            return "a number";
        case KeyKind::integer:
            return "a whole number";
        case KeyKind::number_or_auto:
            return "a number or \"auto\"";
        case KeyKind::numbers:
            return "a list of " + std::to_string(key.count) + " numbers";
        case KeyKind::integers:
            return "a list of " + std::to_string(key.count) + " whole numbers";
        case KeyKind::box:
            return "two corners [[x, y, z], [x, y, z]]";
        case KeyKind::vertices:
            return "a list of vertex indices, { box = [[x, y, z], [x, y, z]] } or \"boundary\"";
        case KeyKind::names:
            return "a list of " + std::to_string(key.count) + " names";
        case KeyKind::pairs:
            return "a list of pairs [i, j] of vertex indices";
        case KeyKind::limit:
            return "a number, { below = a }, { above = a } or { between = [a, b] }";
        case KeyKind::table:
            return "a table";
        case KeyKind::table_list:
            return "a list of tables";
        case KeyKind::named_tables:
            break;
    }
    return "a table of named tables";
}

std::string range_text(const SceneKey& key) {
    const std::string unit = key.unit.empty() ? "" : " " + key.unit;
    const bool lower = !std::isinf(key.lowest), upper = !std::isinf(key.highest);
    if (lower && upper) return number_text(key.lowest) + " ... " + number_text(key.highest) + unit;
    if (lower) return ">= " + number_text(key.lowest) + unit;
    return upper ? "<= " + number_text(key.highest) + unit : "";
}

}  // namespace percale::scenes
