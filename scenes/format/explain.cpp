#include "format/explain.h"

#include <ostream>

#include "common/nearest_name.h"
#include "common/text.h"
#include "format/former_keys.h"
#include "format/scene_table.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "percale/options.h"

namespace percale::scenes {
namespace {

bool is_table(const SceneKey& key) {
    return key.kind == KeyKind::table || key.kind == KeyKind::table_or_list || key.kind == KeyKind::table_list ||
           key.kind == KeyKind::named_tables;
}

bool at_top(const std::string& path) { return path.find('.') == std::string::npos; }

// The heading of the table that holds a key, as a scene file writes it: [step], [fabric.NAME], [[cloth]]; "" at the top.
std::string heading(const std::string& path) {
    const SceneKey& top = *find_scene_key(path.substr(0, path.find('.')));
    if (top.kind == KeyKind::table) return "[" + top.path + "]";
    if (top.kind == KeyKind::table_or_list) return "[" + top.path + "] or [[" + top.path + "]]";
    if (top.kind == KeyKind::table_list) return "[[" + top.path + "]]";
    return top.kind == KeyKind::named_tables ? "[" + top.path + ".NAME]" : "";
}

std::string below_heading(const std::string& path) { return at_top(path) ? path : path.substr(path.find('.') + 1); }

// What the words of a choice already say needs no kind.
std::string value_text(const SceneKey& key) {
    const std::string range = key.kind == KeyKind::word ? "" : range_text(key);
    if (!range.empty()) return kind_text(key) + ", " + range;
    return kind_text(key) + (key.unit.empty() ? "" : ", " + key.unit);
}

std::string default_text(const SceneKey& key) {
    if (key.required) return "required";
    return key.default_text;
}

void print_key(std::ostream& out, const SceneKey& key) {
    if (is_table(key) && at_top(key.path)) {
        out << heading(key.path) << "\n    " << key.sentence << "\n";
        return;
    }
    const std::string fallback = default_text(key);
    out << "  " << below_heading(key.path) << ": " << value_text(key);
    if (key.required) {
        out << "; required";
    } else if (!fallback.empty()) {
        out << "; default " << fallback;
    }
    out << "\n      " << key.sentence << "\n";
}

bool belongs(const std::string& path, const std::string& topic) {
    return topic.empty() || path == topic || path.starts_with(topic + ".");
}

// The topic as a path: itself, or every path whose last part it is.
std::vector<std::string> topic_paths(const std::string& topic) {
    if (topic.empty() || find_scene_key(topic) != nullptr) return {topic};
    if (const std::string present = present_path(topic); !present.empty()) return {present};
    std::vector<std::string> paths;
    for (const SceneKey& key : scene_keys())
        if (key.path.ends_with("." + topic)) paths.push_back(key.path);
    return paths;
}

[[noreturn]] void fail_topic(const std::string& topic) {
    std::vector<std::string> names = {"presets"};
    for (const SceneKey& key : scene_keys()) {
        names.push_back(key.path);
        names.push_back(key.path.substr(key.path.rfind('.') + 1));
    }
    const std::string nearest = did_you_mean(topic, names);
    throw SceneError("explain: no topic '" + topic + "'" + (nearest.empty() ? ";" : nearest) + " topics: presets, " +
                     joined(keys_inside("")) + ", or any key of these such as cloth.pin");
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::string markdown_row(const SceneKey& key) {
    const std::string fallback = key.required ? "required" : code(key.default_text);
    return "| `" + below_heading(key.path) + "` | " + value_text(key) + " | " + fallback + " | " + key.sentence + " |\n";
}

void print_preset(std::ostream& out, const FabricPreset& preset) {
    const Fabric& fabric = preset.fabric;
    const auto [warp, weft] = *fabric.stretch_stiffness;
    out << "  " << preset.name << ": area_density " << number_text(fabric.area_density) << " kg/m^2, stretch_stiffness ["
        << number_text(warp) << ", " << number_text(weft) << "] N/m, shear_stiffness " << number_text(*fabric.shear_stiffness)
        << " N/m, bend_stiffness " << short_number(*fabric.bend_stiffness) << " N m\n";
}

// One block for each source, in the order of the list.
void explain_presets(std::ostream& out) {
    std::string_view source;
    for (const FabricPreset& preset : fabric_presets()) {
        if (preset.source != source) out << (source.empty() ? "" : "\n") << preset.source << "\n";
        source = preset.source;
        print_preset(out, preset);
    }
    out << "\nAll: damping_time " << number_text(*fabric_presets()[0].fabric.damping_time)
        << " s, thickness and friction as without a preset. Used as [fabric.NAME] preset = \"cotton\".\n";
}

}  // namespace

void explain(std::ostream& out, const std::string& topic) {
    if (topic == "presets") return explain_presets(out);
    const std::vector<std::string> paths = topic_paths(topic);
    if (paths.empty()) fail_topic(topic);
    std::string last_heading;
    bool first = true;
    for (const SceneKey& key : scene_keys()) {
        bool chosen = false;
        for (const std::string& path : paths) chosen = chosen || belongs(key.path, path);
        if (!chosen) continue;
        const std::string table = heading(key.path);
        if (table != last_heading && !first) out << "\n";
        if (table != last_heading && !at_top(key.path)) out << table << "\n";
        last_heading = table;
        first = false;
        print_key(out, key);
    }
    if (paths.front() == "step.scheme") out << "\n" << scheme_table_text();
}

std::string key_tables_markdown() {
    const std::string columns = "| key | value | default | meaning |\n|---|---|---|---|\n";
    std::string text = "### Top of the file\n\n" + columns;
    for (const SceneKey& key : scene_keys()) {
        if (is_table(key) && at_top(key.path)) {
            text += "\n### `" + heading(key.path) + "`\n\n" + key.sentence + "\n\n" + columns;
        } else {
            text += markdown_row(key);
        }
    }
    return text;
}

}  // namespace percale::scenes
