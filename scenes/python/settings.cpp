#include "python/settings.h"

#include <algorithm>

#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "format/former_keys.h"
#include "format/scene_check.h"
#include "format/scene_table.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "percale/options.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/values.h"

namespace percale::python {
namespace {

using scenes::FaultList;
using scenes::SceneKey;
using scenes::TomlNode;

/// The keys of [step] that are settings here; the detector has an argument of its own.
std::vector<SceneKey> step_keys() {
    std::vector<SceneKey> keys = scenes::keys_of(scenes::step_table());
    std::erase_if(keys, [](const SceneKey& key) { return key.path == "detector"; });
    return keys;
}

void check_setting_names(const py::dict& settings) {
    std::vector<std::string> valid{"gravity", "wind"};
    for (const SceneKey& key : step_keys()) valid.push_back(key.path);
    for (const auto& [key, value] : settings) {
        const auto name = key.cast<std::string>();
        if (std::ranges::find(valid, name) == valid.end() && scenes::present_path("step." + name).empty())
            throw SceneError("Simulation", "unknown setting '" + name + "'" + scenes::suggestion(name, valid));
    }
}

scenes::Detector detector_of(const std::string& word) {
    const auto found = std::ranges::find(scenes::detector_words, word);
    if (found != scenes::detector_words.end()) return static_cast<scenes::Detector>(found - scenes::detector_words.begin());
    const std::vector<std::string> valid(scenes::detector_words.begin(), scenes::detector_words.end());
    throw SceneError("Simulation", "detector has no choice '" + word + "'" + scenes::suggestion(word, valid));
}

/// "thickness (m, 1e-6 ... 1, default 0.005): Gap kept from obstacles."
std::string key_text(const SceneKey& key) {
    std::vector<std::string> facts{scenes::kind_text(key)};
    if (!scenes::range_text(key).empty())
        facts.push_back(scenes::range_text(key));
    else if (!key.unit.empty())
        facts.push_back(key.unit);
    if (!key.default_text.empty()) facts.push_back("default " + key.default_text);
    std::string text = key.path + " (" + facts.front();
    for (std::size_t i = 1; i < facts.size(); ++i) text += ", " + facts[i];
    text += "): " + key.sentence + "\n";
    for (const SceneKey& inner : key.inside) text += "    " + key_text(inner);
    return text;
}

std::string keys_text(const std::vector<SceneKey>& keys) {
    std::string text;
    for (const SceneKey& key : keys) text += key_text(key);
    return text;
}

/// What a key is, for programs.
py::dict key_dict(const SceneKey& key) {
    py::dict facts;
    facts["kind"] = scenes::kind_text(key);
    facts["sentence"] = key.sentence;
    facts["unit"] = key.unit;
    facts["lowest"] = key.lowest;
    facts["highest"] = key.highest;
    facts["choices"] = py::list();
    for (const std::string& choice : key.choices) facts["choices"].cast<py::list>().append(choice);
    facts["default"] = key.default_text;
    facts["inside"] = py::dict();
    for (const SceneKey& inner : key.inside) facts["inside"][py::str(inner.path)] = key_dict(inner);
    return facts;
}

py::dict keys_dict(const std::vector<SceneKey>& keys) {
    py::dict dict;
    for (const SceneKey& key : keys) dict[py::str(key.path)] = key_dict(key);
    return dict;
}

py::object field_value(const scenes::Field<Fabric>& field, const Fabric& fabric) {
    const std::optional<TomlNode> value = field.write(fabric);
    return value ? python_of(*value) : py::none();
}

py::dict fabric_dict(const Fabric& fabric) { return python_of(scenes::spec_node(scenes::fabric_table(), fabric)); }

std::string fabric_repr(const Fabric& fabric) {
    std::string text;
    const py::dict fields = fabric_dict(fabric);
    for (const auto& [key, value] : fields)
        text += (text.empty() ? "" : ", ") + key.cast<std::string>() + "=" + py::repr(value).cast<std::string>();
    return "Fabric(" + text + ")";
}

/// The keys of a table of a scene file, checked; former names are a DeprecationWarning.
TomlNode checked_part(const py::dict& keys, const std::string& path) {
    TomlNode node = node_of(keys);
    std::vector<scenes::Finding> warnings;
    FaultList first(false);
    scenes::rename_former_keys(node, path, warnings, first);
    for (const std::string& text : scenes::finding_texts(warnings))
        if (PyErr_WarnEx(PyExc_DeprecationWarning, text.c_str(), 1) != 0) throw py::error_already_set();
    scenes::check_part(node, path, first);
    return node;
}

}  // namespace

scenes::Scene step_settings(const std::string& detector, const py::dict& settings) {
    check_setting_names(settings);
    scenes::Scene scene;
    scene.detector = detector_of(detector);
    py::dict step;
    for (const auto& [key, value] : settings) {
        const auto name = key.cast<std::string>();
        if (name == "gravity") {
            scene.step.gravity = vector_of(value, name);
        } else if (name == "wind") {
            if (!value.is_none()) scene.step.wind = vector_of(value, name);
        } else {
            step[key] = value;
        }
    }
    const TomlNode node = checked_part(step, "step");
    FaultList first(false);
    scenes::read_fields(node, scenes::step_table(), scene, first);
    check_options(scene.step, "Simulation");
    return scene;
}

py::dict settings_dict(const StepSettings& settings, scenes::Detector detector) {
    scenes::Scene scene;
    scene.step = settings;
    scene.detector = detector;
    py::dict dict = python_of(scenes::spec_node(scenes::step_table(), scene));
    dict["gravity"] = array_of(settings.gravity);
    dict["wind"] = settings.wind ? py::object(array_of(*settings.wind)) : py::none();
    return dict;
}

Fabric fabric_of_keys(const py::dict& keys) { return scenes::read_spec(checked_part(keys, "fabric"), scenes::fabric_table()); }

Fabric fabric_of(py::handle value) {
    if (py::isinstance<Fabric>(value)) return value.cast<Fabric>();
    if (py::isinstance<py::dict>(value)) return fabric_of_keys(py::reinterpret_borrow<py::dict>(value));
    throw SceneError("fabric", "must be a percale.Fabric or a dict of its keys, not " + described(value));
}

std::string step_settings_text() {
    return keys_text(step_keys()) +
           "gravity (3 numbers, m/s^2, default [0, -9.81, 0]): Acceleration of free fall; y is up.\n"
           "wind (3 numbers, m/s, or None): Velocity of the air; None: there is no air.\n";
}

std::string fabric_keys_text() { return keys_text(scenes::keys_of(scenes::fabric_table())); }

void bind_fabrics(py::module_& module) {
    static const std::string text =
        "What a cloth is made of. Fabric(**keys) takes the keys of [fabric.NAME] in scene files; at least one of springs,\n"
        "stretch_stiffness and preset. Throws SceneError for a key that is unknown, out of range or excluded by another.\n\n" +
        fabric_keys_text();
    py::class_<Fabric> fabric(module, "Fabric", text.c_str());
    fabric.def(py::init([](const py::kwargs& keys) { return fabric_of_keys(keys); }))
        .def("to_dict", &fabric_dict, "All fields as they are, defaults included; those that are not set left out.")
        .def("__repr__", &fabric_repr)
        .def("__eq__", [](const Fabric& a, const Fabric& b) { return fabric_dict(a).equal(fabric_dict(b)); });
    fabric.attr("__hash__") = py::none();
    for (const scenes::Field<Fabric>& field : scenes::fabric_table().fields) {
        if (field.key.path == "preset") continue;  // where the other fields started from; not kept
        fabric.def_property_readonly(
            field.key.path.c_str(), [&field](const Fabric& self) { return field_value(field, self); },
            field.key.sentence.c_str());
    }
    module.def(
        "fabric_presets",
        [] {
            py::dict presets;
            for (const FabricPreset& preset : fabric_presets()) presets[py::str(std::string(preset.name))] = preset.fabric;
            return presets;
        },
        "Fabrics to start from, by their names.");
    module.def(
        "isotropic", [](py::handle value) { return isotropic(fabric_of(value)); }, py::arg("fabric"),
        "The same fabric without a warp, for meshes that do not say where it is.");
    module.def(
        "step_options", [] { return keys_dict(step_keys()); },
        "Every setting of Simulation but detector, gravity and wind: kind, sentence, unit, range, choices, default.");
    module.def(
        "fabric_options", [] { return keys_dict(scenes::keys_of(scenes::fabric_table())); },
        "Every key of Fabric: kind, sentence, unit, range, choices, default.");
}

}  // namespace percale::python
