#include "format/scene_table.h"

#include "common/scene_file_error.h"
#include "common/text.h"
#include "fields/option_fields.h"
#include "format/body_tables.h"
#include "format/scene.h"
#include "format/script_tables.h"
#include "frames/cloth_fit.h"
#include "frames/frame_formats.h"
#include "percale/fabric_presets.h"

namespace percale::scenes {
namespace {

std::string fabric_shown(const TomlNode& table) { return table.key.empty() ? "[fabric]" : "[fabric." + table.key + "]"; }

/// A preset is where the other keys start from; it is not kept as such.
Field<Fabric> preset_field() {
    std::vector<std::string> names;
    for (const FabricPreset& preset : fabric_presets()) names.emplace_back(preset.name);
    return {.key = {.path = "preset",
                    .kind = KeyKind::word,
                    .sentence = "A fabric to start from, which single keys override; instead of springs. percale explain presets "
                                "lists them with their numbers.",
                    .choices = std::move(names)},
            .read = [](const TomlNode& node, Fabric& fabric, FaultList&) { fabric = fabric_preset(node.text); },
            .write = [](const Fabric&) -> std::optional<TomlNode> { return std::nullopt; }};
}

std::vector<Field<Fabric>> fabric_fields() {
    std::vector<Field<Fabric>> fields = option_fields<Fabric>(
        fabric_options(), itself,
        {.path = "springs", .sentence = "Constants of the springs, whatever their length; or stretch_stiffness, or a preset."});
    fields.insert(fields.begin(), preset_field());
    return fields;
}

/// What is given takes the place of what a preset or the defaults say.
void finish_fabric(const TomlNode& table, Fabric& fabric) {
    if (table.find("spring_damping") != nullptr) fabric.damping_time.reset();
    if (fabric.has_moduli()) fabric.springs = {.structural = 0.0};
    if (fabric.damping_time) fabric.spring_damping = 0.0;
    at_place(table.place, "", [&] { check_options(fabric, fabric_shown(table)); });
}

bool has_preset_moduli(const TomlNode& table) {
    return table.find("preset") != nullptr && table.find("stretch_stiffness") == nullptr &&
           table.find("shear_stiffness") == nullptr;
}

Field<Scene> fabrics_field() {
    return {.key = {.path = "fabric",
                    .kind = KeyKind::named_tables,
                    .sentence = "What cloth is made of; one table [fabric.NAME] for each fabric.",
                    .inside = keys_of(fabric_table())},
            .read =
                [](const TomlNode& node, Scene& scene, FaultList& faults) {
                    for (const TomlNode& table : node.entries) {
                        faults.attempt([&] { scene.fabrics[table.key] = read_spec(table, fabric_table()); });
                        if (has_preset_moduli(table)) scene.preset_moduli.insert(table.key);
                    }
                },
            .write = [](const Scene& scene) -> std::optional<TomlNode> {
                TomlNode node;
                for (const auto& [name, fabric] : scene.fabrics) {
                    node.entries.push_back(spec_node(fabric_table(), fabric));
                    node.entries.back().key = name;
                }
                return node;
            }};
}

/// Steps of automatic length need a scheme that estimates its error.
void finish_step(const TomlNode& table, Scene& scene) {
    const TomlNode* scheme = table.find("scheme");
    if (scene.step.adaptive && scheme == nullptr) scene.step.scheme = Scheme::tr_bdf2;
    if (scheme != nullptr) scene.scheme_place = scheme->place;
}

FieldTable<Scene> made_step_table() {
    FieldTable<Scene> table{.fields = option_fields<Scene>(
                                step_options(), [](auto& scene) -> auto& { return scene.step; }),
                            .finish = finish_step};
    table.fields.push_back(word_field<Scene>(
        {.path = "detector",
         .sentence = "Which tree finds obstacle triangles near the cloth; all find the same contacts; none refuses obstacles."},
        &Scene::detector, detector_words, std::vector{Detector::fcl, Detector::bullet, Detector::brute_force, Detector::none}));
    return table;
}

Field<Scene> step_field() {
    return table_field<Scene>({.path = "step", .sentence = "How the simulation steps."}, itself, step_table());
}

/// A number of seconds, or until rest.
Field<Scene> duration_field() {
    return with_default<Scene>(
        {.key = {.path = "duration",
                 .kind = KeyKind::number_or_rest,
                 .sentence = "How long to simulate; \"rest\": until all cloth has been still and its forces balanced for half a "
                             "second and nothing more is to happen.",
                 .unit = "s",
                 .lowest = 1e-6,
                 .highest = scenes::max_time},
         .read =
             [](const TomlNode& node, Scene& scene, FaultList&) {
                 scene.until_rest = !node.is_number();
                 scene.duration_place = node.place;
                 if (!scene.until_rest) read_value(node, scene.duration);
             },
         .write = [](const Scene& scene) -> std::optional<TomlNode> {
             return scene.until_rest ? value_node(std::string("rest")) : value_node(scene.duration);
         }});
}

/// Only scenes that end at rest have it.
Field<Scene> max_duration_field() {
    return {.key = {.path = "max_duration",
                    .kind = KeyKind::number,
                    .sentence = "With duration = \"rest\": the run fails if it is not at rest by then.",
                    .unit = "s",
                    .lowest = 1e-6,
                    .highest = scenes::max_time,
                    .default_text = number_text(Scene().max_duration),
                    .former = "longest"},
            .read =
                [](const TomlNode& node, Scene& scene, FaultList&) {
                    if (!scene.until_rest)
                        fail_at(node.key_place,
                                "max_duration is that of a scene with duration = \"rest\"; without, it means nothing");
                    read_value(node, scene.max_duration);
                },
            .write = [](const Scene& scene) -> std::optional<TomlNode> {
                return scene.until_rest ? std::optional(value_node(scene.max_duration)) : std::nullopt;
            }};
}

/// One word, or a list of them; written as what it is.
Field<OutputSpec> output_frames_field() {
    return with_default<OutputSpec>(
        {.key = {.path = "frames",
                 .kind = KeyKind::words,
                 .sentence = "Formats of the frames, one or several; " + frame_words_meaning() + ".",
                 .choices = frame_words()},
         .read =
             [](const TomlNode& node, OutputSpec& spec, FaultList&) {
                 read_value(node, spec.frames);
                 if (spec.frames.empty()) fail_at(node.place, "output.frames is an empty list; for no frames write \"none\"");
                 if (spec.frames.size() > 1 && std::ranges::find(spec.frames, no_frames) != spec.frames.end())
                     fail_at(node.place, "output.frames has 'none' beside formats");
             },
         .write = [](const OutputSpec& spec) -> std::optional<TomlNode> {
             return spec.frames.size() == 1 ? value_node(spec.frames.front()) : value_node(spec.frames);
         }});
}

const FieldTable<OutputSpec>& output_table() {
    static const FieldTable<OutputSpec> table = {
        .fields = {
            output_frames_field(),
            value_field<OutputSpec>({.path = "fps",
                                     .sentence = "Frames per second of simulated time.",
                                     .unit = "1/s",
                                     .lowest = 0.01,
                                     .highest = 1e5},
                                    &OutputSpec::fps),
            value_field<OutputSpec>({.path = "fields",
                                     .sentence = "What frames say of how cloth sits, and report.json sums up as it is at the "
                                                 "end. " +
                                                 fit_words_meaning() + ".",
                                     .choices = {std::begin(fit_words), std::end(fit_words)}},
                                    &OutputSpec::fields),
        }};
    return table;
}

void append_keys(const std::string& prefix, const std::vector<SceneKey>& from, std::vector<SceneKey>& to) {
    for (SceneKey key : from) {
        const std::vector<SceneKey> inside = std::exchange(key.inside, {});
        key.path = prefix + key.path;
        to.push_back(key);
        append_keys(key.path + ".", inside, to);
    }
}

}  // namespace

const FieldTable<Fabric>& fabric_table() {
    static const FieldTable<Fabric> table = {.fields = fabric_fields(),
                                             .rules = {.shown = fabric_shown,
                                                       .at_least_one = {"springs", "stretch_stiffness", "preset"},
                                                       .at_least_one_why = "what resists stretching",
                                                       .exclude = {{"springs", "preset"},
                                                                   {"springs", "stretch_stiffness"},
                                                                   {"springs.bend", "bend_stiffness"},
                                                                   {"spring_damping", "damping_time"},
                                                                   {"pressure", "gas_volume"}}},
                                             .finish = finish_fabric};
    return table;
}

const FieldTable<Scene>& step_table() {
    static const FieldTable<Scene> table = made_step_table();
    return table;
}

const FieldTable<Scene>& scene_table() {
    static const FieldTable<Scene> table = {
        .fields = {
            value_field<Scene>({.path = "title", .sentence = "What the scene shows.", .setting = false}, &Scene::title),
            duration_field(),
            max_duration_field(),
            value_field<Scene>(
                {.path = "gravity",
                 .sentence = "Acceleration of free fall; y is up.",
                 .unit = "m/s^2",
                 .lowest = -1e4,
                 .highest = 1e4},
                [](auto& scene) -> auto& { return scene.step.gravity; }),
            step_field(),
            fabrics_field(),
            list_field<Scene>({.path = "cloth", .sentence = "One piece of cloth; [[cloth]] once for each.", .required = true},
                              &Scene::cloths, cloth_table()),
            list_field<Scene>({.path = "obstacle", .sentence = "A body that cloth cannot enter; [[obstacle]] once for each."},
                              &Scene::obstacles, obstacle_table()),
            list_field<Scene>({.path = "seam", .sentence = "Sews vertices together, pair by pair; [[seam]] once for each."},
                              &Scene::seams, seam_table()),
            list_field<Scene>({.path = "pair",
                               .sentence = "Two cloths with self_contact that do not meet, or keep another distance; [[pair]] "
                                           "once for each."},
                              &Scene::pairs, pair_table()),
            list_field<Scene>({.path = "event",
                               .sentence = "Something that happens once, before the first step at or after its time: exactly one "
                                           "of pin, unpin, move, gravity, wind."},
                              &Scene::events, event_table()),
            expect_field(),
            table_field<Scene>({.path = "output", .sentence = "What is written."}, &Scene::output, output_table()),
        }};
    return table;
}

const std::vector<SceneKey>& scene_keys() {
    static const std::vector<SceneKey> keys = [] {
        std::vector<SceneKey> all;
        append_keys("", keys_of(scene_table()), all);
        return all;
    }();
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

}  // namespace percale::scenes
