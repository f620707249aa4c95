#include "python/simulation.h"

#include <string>

#include "python/module.h"
#include "python/settings.h"

namespace percale::python {
namespace {

/// The number of a cloth, obstacle or seam under a type of its own, so that one is not taken for another.
template <class Id>
void bind_id(py::module_& module, const char* name, const char* text) {
    const std::string shown = std::string("<percale.") + name + " ";
    py::class_<Id>(module, name, text)
        .def_readonly("index", &Id::index, "Its number, counted from 0 in the order in which they were added.")
        .def("__eq__", [](const Id& a, const Id& b) { return a.index == b.index; })
        .def("__hash__", [](const Id& id) { return std::hash<int>()(id.index); })
        .def("__repr__", [shown](const Id& id) { return shown + std::to_string(id.index) + ">"; });
}

std::shared_ptr<SharedSimulation> make_simulation(const std::string& detector, const py::kwargs& settings) {
    return std::make_shared<SharedSimulation>(step_settings(detector, settings));
}

}  // namespace

void bind_simulation(py::module_& module) {
    bind_id<ClothId>(module, "ClothId", "A cloth of a simulation, from add_cloth.");
    bind_id<ObstacleId>(module, "ObstacleId", "An obstacle of a simulation, from add_obstacle.");
    bind_id<SeamId>(module, "SeamId", "A seam of a simulation, from add_seam.");
    static const std::string text =
        "Cloth, obstacles and their motion in time. SI units, y up. Wrong arguments throw SceneError (or TypeError) from the "
        "call\n"
        "that was wrong and change nothing; a step never throws for numerical trouble but returns a StepReport. One thread at a\n"
        "time per simulation; simulations are independent, and step and prepare let other threads run.\n\n"
        "Simulation(detector=\"fcl\", **settings). detector: fcl, bullet, brute_force, or none, which refuses obstacles. "
        "Settings\n"
        "are the keys of [step] in scene files:\n\n" +
        step_settings_text();
    SimulationClass simulation(module, "Simulation", text.c_str());
    simulation.def(py::init(&make_simulation), py::arg("detector") = "fcl");
    simulation.def_property_readonly(
        "settings", [](const SharedSimulation& self) { return settings_dict(self.settings, self.detector); },
        "All settings as they are now, defaults included: a dict.");
    bind_simulation_scene(simulation);
    bind_simulation_script(simulation);
    bind_simulation_views(simulation);
}

}  // namespace percale::python
