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

}  // namespace

std::string settings_text(const Scene& scene) {
    ordered_json json = json_of(spec_node(scene_table(), scene));
    for (const Field<Scene>& field : scene_table().fields)
        if (!field.key.setting) json.erase(field.key.path);
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace percale::scenes
