#include "export/run_settings.h"

#include <nlohmann/json.hpp>

#include "format/scene_table.h"

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

ordered_json json_of(const TomlNode& node) {
    switch (node.kind) {
        case TomlKind::integer:
            return node.integer;
        case TomlKind::number:
            return node.number;
        case TomlKind::boolean:
            return node.text == "true";
        case TomlKind::text:
        case TomlKind::date:
            return node.text;
        case TomlKind::list:
            break;
        case TomlKind::table: {
            ordered_json object = ordered_json::object();
            for (const TomlNode& entry : node.entries) object[entry.key] = json_of(entry);
            return object;
        }
    }
    ordered_json list = ordered_json::array();
    for (const TomlNode& item : node.items) list.push_back(json_of(item));
    return list;
}

/// A setting as people write it: /step/time_step is step.time_step.
std::string key_of(const std::string& pointer) {
    std::string key = pointer.empty() ? "" : pointer.substr(1);
    for (char& letter : key)
        if (letter == '/') letter = '.';
    return key;
}

std::string value_text(const nlohmann::json& settings, const std::string& pointer) {
    const nlohmann::json::json_pointer place(pointer);
    return settings.contains(place) ? settings.at(place).dump() : "nothing";
}

}  // namespace

std::string settings_text(const Scene& scene) {
    ordered_json json = json_of(spec_node(scene_table(), scene));
    for (const Field<Scene>& field : scene_table().fields)
        if (!field.key.setting) json.erase(field.key.path);
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string different_settings(const std::string& here, const std::string& saved, const std::string& where) {
    const nlohmann::json now = nlohmann::json::parse(here), then = nlohmann::json::parse(saved);
    std::string text;
    int count = 0;
    for (const nlohmann::json& change : nlohmann::json::diff(now, then)) {
        const std::string path = change.at("path");
        if (path == "/step/threads") continue;
        if (++count > 3) return text + "; and more";
        text += (text.empty() ? "" : "; ") + key_of(path) + " is " + value_text(now, path) + ", " + where + " " +
                value_text(then, path);
    }
    return text;
}

}  // namespace percale::scenes
