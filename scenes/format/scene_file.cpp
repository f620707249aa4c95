#include "format/scene_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/nearest_name.h"
#include "common/text.h"
#include "format/overrides.h"
#include "format/scene_check.h"
#include "format/scene_keys.h"
#include "format/scene_parts.h"
#include "format/toml_values.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "percale/options.h"

namespace percale::scenes {
namespace {

int choice_index(std::span<const std::string> choices, const std::string& word) {
    return static_cast<int>(std::find(choices.begin(), choices.end(), word) - choices.begin());
}

template <class Owner>
void read_option(const TomlNode& table, const Option<Owner>& option, Owner& owner) {
    const TomlNode* node = find_value(table, option.key);
    if (node == nullptr) return;
    if (option.number) {
        if (node->is_number()) *option.number(owner) = node->number;
        if (option.automatic) *option.automatic(owner) = !node->is_number();
    } else if (option.integer) {
        *option.integer(owner) = static_cast<int>(node->integer);
    } else if (option.flag) {
        *option.flag(owner) = node->text == "true";
    } else if (option.number_or_auto) {
        *option.number_or_auto(owner) = node->is_number() ? std::optional(node->number) : std::nullopt;
    } else if (option.optional_number) {
        *option.optional_number(owner) = node->number;
    } else if (option.optional_pair) {
        *option.optional_pair(owner) = {node->items[0].number, node->items[1].number};
    } else {
        const auto found = std::find(option.choices.begin(), option.choices.end(), node->text);
        option.set_choice(owner, static_cast<int>(found - option.choices.begin()));
    }
}

void read_step(const TomlNode& document, Scene& scene) {
    read_value(document, "gravity", scene.step.gravity);
    const TomlNode* step = document.find("step");
    if (step == nullptr) return;
    for (const auto& option : step_options()) read_option(*step, option, scene.step);
    if (scene.step.adaptive && step->find("scheme") == nullptr) scene.step.scheme = Scheme::tr_bdf2;
    if (const TomlNode* scheme = step->find("scheme")) scene.scheme_place = scheme->place;
    if (const TomlNode* detector = step->find("detector"))
        scene.detector = static_cast<Detector>(choice_index(find_scene_key("step.detector")->choices, detector->text));
}

void check_exclusive(const TomlNode& table, std::string_view one, std::string_view other) {
    const TomlNode *first = find_value(table, one), *second = find_value(table, other);
    if (first != nullptr && second != nullptr)
        fail_at(second->key_place,
                "[fabric." + table.key + "]: " + std::string(one) + " and " + std::string(other) + " exclude each other");
}

Fabric read_fabric(const TomlNode& table) {
    const TomlNode* preset = table.find("preset");
    const bool stretches = table.find("springs") != nullptr || table.find("stretch_stiffness") != nullptr;
    if (!stretches && preset == nullptr)
        fail_at(table.place,
                "[fabric." + table.key + "] lacks 'springs', 'stretch_stiffness' or 'preset': what resists stretching");
    check_exclusive(table, "springs", "preset");
    check_exclusive(table, "springs", "stretch_stiffness");
    check_exclusive(table, "springs.bend", "bend_stiffness");
    check_exclusive(table, "spring_damping", "damping_time");
    Fabric fabric = preset != nullptr ? fabric_preset(preset->text) : Fabric{};
    if (table.find("spring_damping") != nullptr) fabric.damping_time.reset();
    for (const auto& option : fabric_options()) read_option(table, option, fabric);
    if (fabric.has_moduli()) fabric.springs = {.structural = 0.0};
    if (fabric.damping_time) fabric.spring_damping = 0.0;
    try {
        check_options(fabric, "[fabric." + table.key + "]");
    } catch (const SceneError& error) {
        fail_at(table.place, error.what());
    }
    return fabric;
}

void read_fabrics(const TomlNode& document, Scene& scene, FaultList& faults) {
    const TomlNode* fabrics = document.find("fabric");
    if (fabrics == nullptr) return;
    for (const TomlNode& table : fabrics->entries) {
        faults.attempt([&] { scene.fabrics[table.key] = read_fabric(table); });
        const bool own = table.find("stretch_stiffness") != nullptr || table.find("shear_stiffness") != nullptr;
        if (table.find("preset") != nullptr && !own) scene.preset_moduli.insert(table.key);
    }
}

template <class Part>
void read_list(const TomlNode& document, std::string_view key, Part (*read)(const TomlNode&), std::vector<Part>& parts,
               FaultList& faults) {
    const TomlNode* list = document.find(key);
    if (list == nullptr) return;
    for (const TomlNode& item : list->items) faults.attempt([&] { parts.push_back(read(item)); });
}

void read_output(const TomlNode& document, OutputSpec& output) {
    read_value(document, "output.frames", output.frames);
    read_value(document, "output.fps", output.fps);
}

template <class Part>
std::vector<std::string> checked_names(const std::vector<Part>& parts, const std::string& what, FaultList& faults) {
    std::vector<std::string> names;
    for (const Part& part : parts) {
        const auto first = std::find_if(parts.begin(), parts.end(), [&](const Part& one) { return one.name == part.name; });
        faults.attempt([&] {
            if (&*first != &part)
                fail_at(part.place, "a second " + what + " '" + part.name + "'; the first is at " + place_text(first->place));
        });
        names.push_back(part.name);
    }
    return names;
}

std::string cloth_of(const EventSpec& event) {
    return std::visit(
        [](const auto& what) -> std::string {
            if constexpr (requires { what.cloth; }) return what.cloth;
            return "";
        },
        event.what);
}

void check_references(const Scene& scene, FaultList& faults) {
    const std::vector<std::string> cloths = checked_names(scene.cloths, "cloth", faults);
    checked_names(scene.obstacles, "obstacle", faults);
    std::vector<std::string> fabrics;
    for (const auto& [name, fabric] : scene.fabrics) fabrics.push_back(name);
    const auto check_name = [&](const std::vector<std::string>& names, const std::string& name, const SourcePlace& place,
                                const std::string& what) {
        faults.attempt([&] {
            if (std::find(names.begin(), names.end(), name) == names.end())
                fail_at(place, what + " '" + name + "'" + suggestion(name, names));
        });
    };
    for (const ClothSpec& cloth : scene.cloths)
        check_name(fabrics, cloth.fabric, cloth.place, "cloth '" + cloth.name + "': no fabric");
    for (const SeamSpec& seam : scene.seams)
        for (const std::string& name : seam.cloths) check_name(cloths, name, seam.place, "seam: no cloth");
    for (const EventSpec& event : scene.events) {
        const std::string name = cloth_of(event);
        if (!name.empty()) check_name(cloths, name, event.place, "event: no cloth");
    }
}

Scene scene_of(const TomlNode& document, const std::string& name, FaultList& faults) {
    Scene scene;
    scene.file = name;
    scene.scheme_place = {.file = name};
    read_value(document, "title", scene.title);
    read_value(document, "duration", scene.duration);
    faults.attempt([&] { read_step(document, scene); });
    read_fabrics(document, scene, faults);
    read_list(document, "cloth", read_cloth, scene.cloths, faults);
    read_list(document, "obstacle", read_obstacle, scene.obstacles, faults);
    read_list(document, "seam", read_seam, scene.seams, faults);
    read_list(document, "event", read_event, scene.events, faults);
    if (const TomlNode* expect = document.find("expect"))
        faults.attempt([&] { scene.expectations = read_expectations(*expect); });
    read_output(document, scene.output);
    return scene;
}

void sort_events(std::vector<EventSpec>& events) {
    std::stable_sort(events.begin(), events.end(), [](const EventSpec& a, const EventSpec& b) { return a.time < b.time; });
}

std::string file_text(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) throw SceneError(file + ": is a folder, not a scene file");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SceneError(file + ": cannot be read: " + std::strerror(errno));
    std::ostringstream text;
    text << in.rdbuf();
    if (in.bad()) throw SceneError(file + ": cannot be read: " + std::strerror(errno));
    return text.str();
}

/// The scene of a text; with kept faults, what could be read of it until there were some.
Scene parsed(const std::string& text, const std::string& name, std::span<const Override> overrides, FaultList& faults) {
    TomlNode document = parse_toml(text, name);
    document.place = {.file = name};
    if (document.entries.empty()) fail_at(document.place, "is empty; a scene needs at least one [fabric.NAME] and one [[cloth]]");
    for (const Override& override : overrides) apply_override(document, override);
    check_document(document, faults);
    if (!faults.messages.empty()) return {};
    Scene scene = scene_of(document, name, faults);
    if (!faults.messages.empty()) return scene;
    if (scene.cloths.empty()) fail_at(document.place, "has no cloth; a scene needs at least one [[cloth]]");
    check_references(scene, faults);
    sort_events(scene.events);
    return scene;
}

}  // namespace

Scene load_scene(const std::string& file, std::span<const Override> overrides) {
    return parse_scene(file_text(file), file, overrides);
}

Scene parse_scene(const std::string& text, const std::string& name, std::span<const Override> overrides) {
    FaultList faults(false);
    return parsed(text, name, overrides, faults);
}

std::vector<std::string> scene_faults(const std::string& file, std::span<const Override> overrides) {
    FaultList faults(true);
    faults.attempt([&] { parsed(file_text(file), file, overrides, faults); });
    return faults.messages;
}

}  // namespace percale::scenes
