#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"
#include "percale/options.h"
#include "python/arrays.h"
#include "python/poses.h"
#include "python/simulation.h"
#include "python/values.h"

// What the caller prescribes: pins, obstacles, seams, gravity, wind. Calls that take several vertices change all or nothing.
namespace percale::python {
namespace {

/// The vertices that a call names, each once and all of the cloth; pinned where they have to be.
std::vector<int> vertices_of(const SharedSimulation& self, ClothId cloth, py::handle value, const char* call, bool pinned) {
    const std::vector<int> vertices = indices_of(value, std::string(call) + ": vertices");
    const long count = static_cast<long>(self.look().positions(cloth).size());
    const std::vector<int> held = pinned ? self.look().pinned_vertices(cloth) : std::vector<int>();
    for (const int vertex : vertices) {
        const std::string shown = "vertex " + std::to_string(vertex);
        if (vertex < 0 || vertex >= count)
            throw SceneError(call, "there is no " + shown + ", vertices are 0 ... " + std::to_string(count - 1));
        if (pinned && !std::ranges::binary_search(held, vertex)) throw SceneError(call, shown + " is not pinned");
    }
    std::vector<int> sorted = vertices;
    std::ranges::sort(sorted);
    const auto twice = std::ranges::adjacent_find(sorted);
    if (twice != sorted.end()) throw SceneError(call, "vertex " + std::to_string(*twice) + " is named twice");
    return vertices;
}

void pin(SharedSimulation& self, ClothId cloth, py::handle value) {
    const std::vector<int> vertices = vertices_of(self, cloth, value, "pin", false);
    self.change([&](Simulation& simulation) {
        for (const int vertex : vertices) simulation.pin(cloth, vertex);
    });
}

void unpin(SharedSimulation& self, ClothId cloth, py::handle value) {
    const std::vector<int> vertices = vertices_of(self, cloth, value, "unpin", true);
    self.change([&](Simulation& simulation) {
        for (const int vertex : vertices) simulation.unpin(cloth, vertex);
    });
}

void move_pin(SharedSimulation& self, ClothId cloth, py::handle value, py::handle target) {
    const std::vector<int> vertices = vertices_of(self, cloth, value, "move_pin", true);
    const bool single = dimensions_of(target, "move_pin: targets") == 1 && vertices.size() == 1;
    const std::vector<Vec3> targets =
        single ? std::vector{vector_of(target, "move_pin: targets")} : points_of(target, "move_pin: targets", vertices.size());
    for (const Vec3& x : targets)
        if (!x.allFinite()) throw SceneError("move_pin", "a target is not finite");
    self.change([&](Simulation& simulation) {
        for (std::size_t i = 0; i < vertices.size(); ++i) simulation.move_pin(cloth, vertices[i], targets[i]);
    });
}

Stitch stitch_of(const double* row) {
    for (int k = 0; k < 3; ++k)
        if (row[k] != std::floor(row[k]) || !(std::abs(row[k]) < 2147483648.0))
            throw SceneError("points", "a vertex of a stitch must be an integer, not " + scenes::number_text(row[k]));
    return {static_cast<int>(row[0]), static_cast<int>(row[1]), static_cast<int>(row[2]), row[3]};
}

std::vector<Stitch> stitches_of(py::handle vertices, py::handle points) {
    std::vector<Stitch> stitches;
    if (!vertices.is_none()) {
        const std::vector<int> pairs = rows_of_indices(vertices, "vertices", 2);
        for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) stitches.push_back({pairs[i], pairs[i + 1], pairs[i + 1], 0.0});
    }
    if (!points.is_none()) {
        const std::vector<double> rows = rows_of_numbers(points, "points", 4);
        for (std::size_t i = 0; i + 3 < rows.size(); i += 4) stitches.push_back(stitch_of(&rows[i]));
    }
    return stitches;
}

SeamSettings seam_settings(const py::dict& given) {
    SeamSettings settings;
    const std::vector<std::string> valid{"after", "over", "stiffness", "contact_while_closing", "weld", "name"};
    for (const auto& [key, value] : given) {
        const auto word = key.cast<std::string>();
        const auto at = std::ranges::find(valid, word) - valid.begin();
        if (at == static_cast<long>(valid.size()))
            throw SceneError("add_seam", "unknown setting '" + word + "'" + scenes::suggestion(word, valid));
        double* numbers[] = {&settings.after, &settings.over, &settings.stiffness};
        bool* flags[] = {&settings.contact_while_closing, &settings.weld};
        if (at < 3) {
            *numbers[at] = number_from(value, "add_seam: " + word);
        } else if (at < 5) {
            *flags[at - 3] = flag_from(value, "add_seam: " + word);
        } else {
            settings.name = text_from(value, "add_seam: " + word);
        }
    }
    return settings;
}

SeamId add_seam(SharedSimulation& self, const std::pair<ClothId, ClothId>& cloths, py::handle vertices, py::handle points,
                const py::kwargs& more) {
    const std::vector<Stitch> stitches = stitches_of(vertices, points);
    const SeamSettings settings = seam_settings(more);
    return self.change([&](Simulation& s) { return s.add_seam(cloths.first, cloths.second, stitches, settings); });
}

void set_points(SharedSimulation& self, ClothId cloth, py::handle value, bool positions) {
    const std::vector<Vec3> points = points_of(value, positions ? "positions" : "velocities");
    self.change([&](Simulation& s) { positions ? s.set_positions(cloth, points) : s.set_velocities(cloth, points); });
}

void teleport(SharedSimulation& self, const std::vector<ClothId>& cloths, const std::vector<ObstacleId>& obstacles,
              py::handle motion, const std::string& velocities) {
    if (velocities != "keep" && velocities != "clear")
        throw SceneError("teleport", "velocities has no choice '" + velocities + "'; valid: keep, clear");
    const Pose pose = pose_of(motion, "motion");
    const TeleportVelocities what = velocities == "keep" ? TeleportVelocities::keep : TeleportVelocities::clear;
    self.change([&](Simulation& s) { s.teleport(cloths, obstacles, pose, what); });
}

void bind_pins(SimulationClass& simulation) {
    simulation
        .def("pin", &pin, py::arg("cloth"), py::arg("vertices"), "Holds vertices, an index or a list of them, where they are.")
        .def("unpin", &unpin, py::arg("cloth"), py::arg("vertices"), "Lets pinned vertices go.")
        .def("move_pin", &move_pin, py::arg("cloth"), py::arg("vertices"), py::arg("targets"),
             "Where pinned vertices are at the end of the next step, m: (3,) for one, (k, 3) for k; they then stay there.")
        .def(
            "set_positions", [](SharedSimulation& self, ClothId cloth, py::handle x) { set_points(self, cloth, x, true); },
            py::arg("cloth"), py::arg("positions"), "All vertices of a cloth, (n, 3), m.")
        .def(
            "set_velocities", [](SharedSimulation& self, ClothId cloth, py::handle v) { set_points(self, cloth, v, false); },
            py::arg("cloth"), py::arg("velocities"), "All vertices of a cloth, (n, 3), m/s; pinned ones stay at rest.")
        .def(
            "teleport", &teleport, py::arg("cloths"), py::arg("obstacles"), py::arg("motion"), py::arg("velocities") = "keep",
            "Moves cloths and obstacles together by a rigid motion of the world, in no time. velocities: keep (they turn along)\n"
            "or clear.");
}

void bind_obstacles(SimulationClass& simulation) {
    simulation
        .def(
            "move_obstacle",
            [](SharedSimulation& self, ObstacleId obstacle, py::handle pose) {
                const Pose end = pose_of(pose);
                self.change([&](Simulation& s) { s.move_obstacle(obstacle, end); });
            },
            py::arg("obstacle"), py::arg("pose"), "Where an obstacle is at the end of the next step; the scale must not change.")
        .def(
            "deform_obstacle",
            [](SharedSimulation& self, ObstacleId obstacle, py::handle vertices) {
                const std::vector<Vec3> end = points_of(vertices, "vertices");
                self.change([&](Simulation& s) { s.deform_obstacle(obstacle, end); });
            },
            py::arg("obstacle"), py::arg("vertices"),
            "Where the vertices of a deforming obstacle are at the end of the next step, (n, 3), m, before its pose.")
        .def(
            "set_friction",
            [](SharedSimulation& self, ObstacleId obstacle, double friction) {
                self.change([&](Simulation& s) { s.set_friction(obstacle, friction); });
            },
            py::arg("obstacle"), py::arg("friction"), "Coulomb coefficient against cloth, 0 ... 10.")
        .def(
            "set_restitution",
            [](SharedSimulation& self, ObstacleId obstacle, double restitution) {
                self.change([&](Simulation& s) { s.set_restitution(obstacle, restitution); });
            },
            py::arg("obstacle"), py::arg("restitution"), "0 ... 1.");
}

void bind_world(SimulationClass& simulation) {
    simulation
        .def(
            "set_gravity",
            [](SharedSimulation& self, py::handle value) {
                const Vec3 gravity = vector_of(value, "gravity");
                self.change([&](Simulation& s) { s.set_gravity(gravity); });
                self.settings.gravity = gravity;
            },
            py::arg("gravity"), "m/s^2, 3 numbers.")
        .def(
            "set_wind",
            [](SharedSimulation& self, py::handle value) {
                const Vec3 wind = vector_of(value, "velocity");
                self.change([&](Simulation& s) { s.set_wind(wind); });
                self.settings.wind = wind;
            },
            py::arg("velocity"), "Velocity of the air, m/s, 3 numbers; before the first call there is no air.")
        .def(
            "set_time_step",
            [](SharedSimulation& self, double time_step) {
                self.change([&](Simulation& s) { s.set_time_step(time_step); });
                self.settings.time_step = time_step;
            },
            py::arg("time_step"), "s, 1e-7 ... 1.")
        .def(
            "set_work_limit",
            [](SharedSimulation& self, int iterations) {
                self.change([&](Simulation& s) { s.set_work_limit(iterations); });
                self.settings.work_limit = iterations;
            },
            py::arg("iterations"), "Newton iterations of a step at most, 1 ... 50000; 0: no limit.")
        .def(
            "set_time_limit",
            [](SharedSimulation& self, double seconds) { self.change([&](Simulation& s) { s.set_time_limit(seconds); }); },
            py::arg("seconds"),
            "Wall time of a step, s, 1e-6 ... 1e6; 0: none. A step that has used it up is taken as it is:\n"
            "report.out_of_time; where pins and obstacles have not arrived after some 20 iterations more it fails\n"
            "(work_limit). Results then depend on the machine.")
        .def(
            "set_cancel", [](SharedSimulation& self, bool wish) { self.set_cancel(wish); }, py::arg("wish"),
            "While True a step ends at once and fails (cancelled), nothing moves, and a start that would have to be repaired is\n"
            "refused. Any thread may call it while another one is in step or prepare. Ctrl-C does so by itself on the main "
            "thread.");
}

void bind_cloth_to_cloth(SimulationClass& simulation) {
    simulation
        .def(
            "add_seam",
            [](SharedSimulation& self, ClothId first, ClothId second, py::handle vertices, py::handle points,
               const py::kwargs& more) {
                return add_seam(self, {first, second}, vertices, points, more);
            },
            py::arg("first"), py::arg("second"), py::arg("vertices") = py::none(), py::arg("points") = py::none(),
            "Sews vertices of the first cloth to the second, which may be the same, and returns the SeamId. vertices: (k, 2), "
            "pairs\n"
            "of indices; points: (k, 4), i, j, k, t: x_i joins (1 - t) x_j + t x_k. Settings: after (s), over (s), stiffness "
            "(N/m),\n"
            "contact_while_closing, weld, name.")
        .def(
            "set_pair",
            [](SharedSimulation& self, ClothId first, ClothId second, bool contact, std::optional<double> thickness) {
                self.change([&](Simulation& s) { s.set_pair(first, second, {.contact = contact, .thickness = thickness}); });
            },
            py::arg("first"), py::arg("second"), py::arg("contact") = true, py::arg("thickness") = py::none(),
            "What two cloths with self_contact are to each other; thickness: m, 1e-6 ... 1, or None: the mean of theirs.")
        .def(
            "set_layer",
            [](SharedSimulation& self, ClothId cloth, int layer) {
                self.change([&](Simulation& s) { s.set_layer(cloth, layer); });
            },
            py::arg("cloth"), py::arg("layer"), "Where self_contact cloth is worn, from the inside out, -1000 ... 1000.");
}

}  // namespace

void bind_simulation_script(SimulationClass& simulation) {
    bind_pins(simulation);
    bind_obstacles(simulation);
    bind_world(simulation);
    bind_cloth_to_cloth(simulation);
}

}  // namespace percale::python
