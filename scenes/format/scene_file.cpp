#include "format/scene_file.h"

#include <algorithm>
#include <filesystem>

#include "common/input_file.h"
#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "format/former_keys.h"
#include "format/overrides.h"
#include "format/scene_check.h"
#include "format/scene_table.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// What is said of patterns, those of GarmentCode in JSON included.
constexpr const char* not_a_scene =
    ": is a sewing pattern, not a scene file: a scene names it as pattern of a [[cloth]], percale drape sews it around a body, "
    "percale sew writes its mesh";

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

void check_only_cloth(const std::vector<std::string>& cloths, const SeamSpec& seam) {
    if (cloths.size() == 1) return;
    fail_at(seam.place, "seam lacks cloths: the scene has " + std::to_string(cloths.size()) + ", name the two that it joins");
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
    for (const SeamSpec& seam : scene.seams) {
        if (!seam.cloths) faults.attempt([&] { check_only_cloth(cloths, seam); });
        if (!seam.cloths) continue;
        for (const std::string& name : *seam.cloths) check_name(cloths, name, seam.place, "seam: no cloth");
    }
    for (const PairSpec& pair : scene.pairs) {
        for (const std::string& name : pair.cloths) check_name(cloths, name, pair.place, "pair: no cloth");
    }
    for (const EventSpec& event : scene.events) {
        const std::string name = cloth_of(event);
        if (!name.empty()) check_name(cloths, name, event.place, "event: no cloth");
    }
}

Scene scene_of(const TomlNode& document, const std::string& name, FaultList& faults) {
    Scene scene;
    scene.file = name;
    scene.scheme_place = scene.duration_place = {.file = name};
    read_fields(document, scene_table(), scene, faults);
    return scene;
}

void sort_events(std::vector<EventSpec>& events) {
    std::stable_sort(events.begin(), events.end(), [](const EventSpec& a, const EventSpec& b) { return a.time < b.time; });
}

std::string file_text(const std::string& file) {
    if (is_mesh_file(file)) {
        throw SceneError(file + ": is a mesh, not a scene file: a scene names it as mesh, percale drape needs no scene");
    }
    if (std::filesystem::path(file).extension() == ".json") throw SceneError(file + not_a_scene);
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) throw SceneError(file + ": is a folder, not a scene file");
    return read_text(file);
}

/// The scene of a document; with kept faults, what could be read of it until there were some.
Scene scene_with(TomlNode document, const std::string& name, std::span<const Override> overrides, FaultList& faults) {
    document.place = {.file = name};
    if (document.entries.empty()) fail_at(document.place, "is empty; a scene needs at least one [fabric.NAME] and one [[cloth]]");
    if (document.find("panel") != nullptr && document.find("cloth") == nullptr) throw SceneError(name + not_a_scene);
    std::vector<Finding> warnings;
    rename_former_keys(document, "", warnings, faults);
    for (const Override& override : overrides) apply_override(document, with_present_key(override, warnings));
    check_document(document, faults);
    if (!faults.found.empty()) return {};
    Scene scene = scene_of(document, name, faults);
    scene.warnings = std::move(warnings);
    if (!faults.found.empty()) return scene;
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
    return scene_with(parse_toml(text, name), name, overrides, faults);
}

Scene scene_of_document(const TomlNode& document, const std::string& name, std::span<const Override> overrides) {
    FaultList faults(false);
    return scene_with(document, name, overrides, faults);
}

std::vector<SceneFileError> scene_faults(const std::string& file, std::span<const Override> overrides) {
    FaultList faults(true);
    faults.attempt([&] { scene_with(parse_toml(file_text(file), file), file, overrides, faults); });
    return faults.found;
}

}  // namespace percale::scenes
