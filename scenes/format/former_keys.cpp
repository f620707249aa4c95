#include "format/former_keys.h"

#include <algorithm>

#include "common/scene_file_error.h"
#include "format/scene_table.h"

namespace percale::scenes {
namespace {

std::string joined_path(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string last_part(const std::string& path) { return path.substr(path.rfind('.') + 1); }

void warn_once(const SourcePlace& place, const std::string& former, const std::string& present, std::vector<Finding>& warnings) {
    const std::string what = "the key " + former + " is called " + last_part(present) + " now";
    if (std::ranges::find(warnings, what, &Finding::what) != warnings.end()) return;
    warnings.push_back(finding("former_key", place, what, "the former name works in this release only"));
}

/// Renames an entry where its name is a former one; returns the path of its key.
std::string rename_entry(TomlNode& table, TomlNode& entry, const std::string& path, std::vector<Finding>& warnings) {
    const std::string entry_path = joined_path(path, entry.key), present = present_path(entry_path);
    if (present.empty()) return entry_path;
    const std::string name = last_part(present);
    if (table.find(name) != nullptr)
        fail_at(entry.key_place, "'" + entry.key + "' is the former name of '" + name + "', which is there, too");
    warn_once(entry.key_place, entry_path, present, warnings);
    entry.key = name;
    return present;
}

}  // namespace

void rename_former_keys(TomlNode& table, const std::string& path, std::vector<Finding>& warnings, FaultList& faults) {
    for (TomlNode& entry : table.entries) {
        faults.attempt([&] {
            const std::string entry_path = rename_entry(table, entry, path, warnings);
            const SceneKey* key = find_scene_key(entry_path);
            if (key == nullptr) return;
            const bool named = key->kind == KeyKind::named_tables;
            for (TomlNode& child : named ? entry.entries : entry.items) rename_former_keys(child, entry_path, warnings, faults);
            if (!named) rename_former_keys(entry, entry_path, warnings, faults);
        });
    }
}

Override with_present_key(Override override, std::vector<Finding>& warnings) {
    std::string path, renamed;  // the path leaves out names and numbers of items
    std::string rest = override.key;
    while (!rest.empty()) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const std::string part = rest.substr(0, dot), here = joined_path(path, part), present = present_path(here);
        rest.erase(0, dot + 1);
        if (!present.empty()) warn_once({"--set " + override.key}, here, present, warnings);
        renamed = joined_path(renamed, present.empty() ? part : last_part(present));
        if (!present.empty() || find_scene_key(here) != nullptr) path = present.empty() ? here : present;
    }
    if (path.empty()) return override;  // no key at all, which apply_override reports
    override.key = renamed;
    return override;
}

std::string present_path(const std::string& former_path) {
    const std::size_t dot = former_path.rfind('.');
    const std::string table = dot == std::string::npos ? "" : former_path.substr(0, dot + 1);
    for (const SceneKey& key : scene_keys())
        if (!key.former.empty() && table + key.former == former_path && key.path == table + last_part(key.path)) return key.path;
    return "";
}

}  // namespace percale::scenes
