#include <pybind11/stl.h>

#include <string>

#include "percale/error.h"
#include "python/arrays.h"
#include "python/meshes.h"
#include "python/poses.h"
#include "python/settings.h"
#include "python/simulation.h"
#include "python/values.h"

// What a simulation is made of, its steps and its saved states.
namespace percale::python {
namespace {

ClothId add_cloth(SharedSimulation& self, py::handle mesh, py::handle fabric, py::handle pose, const std::string& name,
                  const py::kwargs& shape) {
    for (const auto& [key, value] : shape) {
        const auto word = key.cast<std::string>();
        if (word != "rest" && word != "warp")
            throw SceneError(name, "add_cloth has no argument '" + word + "'; valid: mesh, fabric, pose, name, rest, warp");
    }
    const auto given = [&](const char* key) -> py::object { return shape.contains(key) ? py::object(shape[key]) : py::none(); };
    const auto start = mesh_of(mesh, name);
    const RestShape rest = rest_shape_of(given("rest"), given("warp"), *start, name);
    const Fabric made = fabric_of(fabric);
    const Pose placed = pose_of(pose);
    return self.change([&](Simulation& simulation) { return simulation.add_cloth(*start, made, placed, name, rest); });
}

ObstacleId add_obstacle(SharedSimulation& self, py::handle mesh, py::handle pose, const std::string& name,
                        const ObstacleSettings& settings) {
    const auto body = mesh_of(mesh, name);
    const Pose placed = pose_of(pose);
    return self.change([&](Simulation& simulation) { return simulation.add_obstacle(*body, placed, settings); });
}

py::bytes saved(const SharedSimulation& self) {
    const std::vector<std::byte> bytes = self.look().save();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void restore(SharedSimulation& self, const py::bytes& saved) {
    const std::string_view text = saved;
    self.change([&](Simulation& simulation) { simulation.restore(std::as_bytes(std::span(text.data(), text.size()))); });
}

void bind_bodies(SimulationClass& simulation) {
    simulation
        .def("add_cloth", &add_cloth, py::arg("mesh"), py::arg("fabric"), py::arg("pose") = py::none(), py::arg("name") = "cloth",
             "Adds a cloth and returns its ClothId. mesh: Mesh or (vertices, triangles); fabric: Fabric or a dict of its keys;\n"
             "pose: Pose, dict or None. The mesh at its pose is the rest shape, unless rest says another: vertices (n, 3), or\n"
             "corners of every triangle (m, 3, 3), m. warp: 3 numbers, the direction of warp there; free meshes only.")
        .def(
            "add_obstacle",
            [](SharedSimulation& self, py::handle mesh, py::handle pose, double friction, const std::string& name,
               const py::kwargs& more) {
                ObstacleSettings settings{.friction = friction, .name = name};
                for (const auto& [key, value] : more) {
                    const auto word = key.cast<std::string>();
                    if (word == "restitution") {
                        settings.restitution = number_from(value, name + ": " + word);
                    } else if (word == "deforming") {
                        settings.deforming = flag_from(value, name + ": " + word);
                    } else if (word == "yields") {
                        settings.yields = flag_from(value, name + ": " + word);
                    } else {
                        throw SceneError(name, "add_obstacle has no argument '" + word +
                                                   "'; valid: mesh, pose, friction, name, restitution, deforming, yields");
                    }
                }
                return add_obstacle(self, mesh, pose, name, settings);
            },
            py::arg("mesh"), py::arg("pose") = py::none(), py::arg("friction") = default_friction, py::arg("name") = "obstacle",
            "Adds a body that cloth cannot enter and returns its ObstacleId. friction: Coulomb coefficient, 0 ... 10;\n"
            "restitution: 0 ... 1; deforming: whether deform_obstacle may move its vertices; yields: whether its surface gives\n"
            "way where it leaves cloth no room.")
        .def(
            "remove_cloth",
            [](SharedSimulation& self, ClothId cloth) { self.change([&](Simulation& s) { s.remove_cloth(cloth); }); },
            py::arg("cloth"),
            "Takes a cloth out with its seams. Its id is good no more, all others are; arrays of it that are held stay as they "
            "are.")
        .def(
            "remove_obstacle",
            [](SharedSimulation& self, ObstacleId obstacle) { self.change([&](Simulation& s) { s.remove_obstacle(obstacle); }); },
            py::arg("obstacle"), "Takes an obstacle out.")
        .def(
            "set_fabric",
            [](SharedSimulation& self, ClothId cloth, py::handle fabric) {
                const Fabric made = fabric_of(fabric);
                self.change([&](Simulation& s) { s.set_fabric(cloth, made); });
            },
            py::arg("cloth"), py::arg("fabric"), "Another fabric; positions, velocities and pins stay.");
}

void bind_steps(SimulationClass& simulation) {
    simulation
        .def(
            "prepare", [](SharedSimulation& self) { self.run([](Simulation& s) { s.prepare(); }); },
            "Checks the start as the first step does, and moves out cloth that starts through, inside or touching an obstacle\n"
            "(start_repair says which). Throws StartError, everything as it was, where that is not possible or start is refuse.")
        .def(
            "step", [](SharedSimulation& self) { return self.run([](Simulation& s) { return s.step(); }); },
            "Advances by the time step. A step that fails (report.ok is False) leaves the state as it was and keeps the targets\n"
            "of pins and obstacles. Throws what prepare does, before anything moves. Other threads run meanwhile.")
        .def(
            "start_repair",
            [](const SharedSimulation& self) {
                const auto moves = self.look().start_repair();
                return std::vector<StartMove>(moves.begin(), moves.end());
            },
            "What the last prepare that found something to check moved: a list of StartMove.")
        .def(
            "plan", [](const SharedSimulation& self) { return self.look().plan(); },
            "What the coming steps are made of and what is left out; runs nothing.")
        .def("save", &saved,
             "Everything that the coming steps depend on, as bytes. A simulation made by the same calls that takes them by "
             "restore\n"
             "makes the same steps in every bit.")
        .def("restore", &restore, py::arg("saved"),
             "Throws SceneError, the simulation as it was, where the bytes are damaged or of a simulation made otherwise.")
        .def(
            "reset", [](SharedSimulation& self, ClothId cloth) { self.change([&](Simulation& s) { s.reset(cloth); }); },
            py::arg("cloth"), "Puts a cloth back to where it was added, at rest; pins, time, seams and fabric stay.");
}

}  // namespace

void bind_simulation_scene(SimulationClass& simulation) {
    bind_bodies(simulation);
    bind_steps(simulation);
}

}  // namespace percale::python
