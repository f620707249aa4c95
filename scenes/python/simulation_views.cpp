#include <pybind11/stl.h>

#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>

#include "percale/error.h"
#include "python/arrays.h"
#include "python/simulation.h"

// What a simulation shows.
namespace percale::python {
namespace {

/// ContactLoad as NumPy reads it.
py::dtype load_type() {
    const auto vector = py::dtype::from_args(py::make_tuple("f8", py::make_tuple(3)));
    py::list names, formats, offsets;
    const auto add = [&](const char* name, const py::object& format, std::size_t offset) {
        names.append(name);
        formats.append(format);
        offsets.append(offset);
    };
    add("vertex", py::dtype::of<int>(), offsetof(ContactLoad, vertex));
    add("obstacle", py::dtype::of<int>(), offsetof(ContactLoad, obstacle));
    add("normal", vector, offsetof(ContactLoad, normal));
    add("friction", vector, offsetof(ContactLoad, friction));
    add("cloth_point", vector, offsetof(ContactLoad, cloth_point));
    add("obstacle_point", vector, offsetof(ContactLoad, obstacle_point));
    return {names, formats, offsets, static_cast<long>(sizeof(ContactLoad))};
}

py::array contact_loads(const SharedSimulation& self, ClothId cloth) {
    const std::vector<ContactLoad> loads = self.look().contact_loads(cloth);
    py::array array(load_type(), loads.size());
    if (!loads.empty()) std::memcpy(array.mutable_data(), loads.data(), loads.size() * sizeof(ContactLoad));
    return array;
}

/// A new array, or the caller's, that one entry a vertex is written into.
template <class Write>
py::array_t<double> written(const SharedSimulation& self, ClothId cloth, const py::object& out, Write write) {
    const std::size_t count = self.look().positions(cloth).size();
    std::vector<Vec3> points(count);
    write(std::span<Vec3>(points));
    if (out.is_none()) return array_of(points);
    if (!py::isinstance<py::array>(out)) throw SceneError("out", "must be an array, not " + described(out));
    const auto given = py::reinterpret_borrow<py::array>(out);
    const bool fits = py::array_t<double, py::array::c_style>::check_(given) && given.writeable() && given.ndim() == 2 &&
                      given.shape(0) == static_cast<long>(count) && given.shape(1) == 3;
    if (!fits)
        throw SceneError("out", "must be a writable C-contiguous float64 array of shape (" + std::to_string(count) + ", 3)");
    auto target = py::reinterpret_borrow<py::array_t<double>>(out);
    if (count > 0) std::memcpy(target.mutable_data(), points.data(), count * sizeof(Vec3));
    return target;
}

void bind_arrays(SimulationClass& simulation) {
    const auto shows = [&](const char* name, Shown what, const char* text) {
        simulation.def(
            name, [what](SharedSimulation& self, ClothId cloth) { return self.array(cloth, what); }, py::arg("cloth"), text);
    };
    shows("positions", Shown::positions,
          "(n, 3) float64, m, world; read-only. All calls give the same memory: a call copies nothing, and every call that "
          "changes\n"
          "the simulation brings it up to date as long as somebody holds it. It is the array's own and can be read at any time,\n"
          "after remove_cloth, too (it then stays as it is). To keep a state: .copy().");
    shows("velocities", Shown::velocities, "(n, 3) float64, m/s; as positions.");
    shows("masses", Shown::masses, "(n,) float64, kg, lumped; as positions.");
    simulation
        .def(
            "normals",
            [](const SharedSimulation& self, ClothId cloth, const py::object& out) {
                return written(self, cloth, out, [&](std::span<Vec3> to) { self.look().normals(cloth, to); });
            },
            py::arg("cloth"), py::arg("out") = py::none(),
            "(n, 3) unit normals of the vertices, world; 0 where there is none. A new array, or out.")
        .def(
            "keep_previous_positions",
            [](SharedSimulation& self, bool keep) { self.change([&](Simulation& s) { s.keep_previous_positions(keep); }); },
            py::arg("keep") = true, "From now on, for interpolate: each step first notes where the cloth is.")
        .def(
            "interpolate",
            [](const SharedSimulation& self, double fraction, ClothId cloth, const py::object& out) {
                return written(self, cloth, out, [&](std::span<Vec3> to) { self.look().interpolate(fraction, cloth, to); });
            },
            py::arg("fraction"), py::arg("cloth"), py::arg("out") = py::none(),
            "(n, 3), m: where the cloth is at a fraction, 0 ... 1, of the last step. A new array, or out.")
        .def("contact_loads", &contact_loads, py::arg("cloth"),
             "What obstacles do to the vertices at the end of the last step: a structured array with the fields vertex, "
             "obstacle,\n"
             "normal and friction (N), cloth_point and obstacle_point (m, world); vertices that nothing presses left out.")
        .def(
            "pinned_vertices",
            [](const SharedSimulation& self, ClothId cloth) {
                return array_of(std::span<const int>(self.look().pinned_vertices(cloth)));
            },
            py::arg("cloth"), "Ascending, int32.");
}

void bind_body_views(SimulationClass& simulation) {
    simulation
        .def(
            "force_on", [](const SharedSimulation& self, ObstacleId id) { return array_of(self.look().force_on(id)); },
            py::arg("obstacle"), "What all cloth does to an obstacle, N, shape (3,).")
        .def(
            "torque_on",
            [](const SharedSimulation& self, ObstacleId id, py::handle about) {
                return array_of(self.look().torque_on(id, vector_of(about, "about")));
            },
            py::arg("obstacle"), py::arg("about"), "Torque of the same forces about a point (m, world), N m, shape (3,).")
        .def(
            "keep_impulses",
            [](SharedSimulation& self, bool keep) { self.change([&](Simulation& s) { s.keep_impulses(keep); }); },
            py::arg("keep") = true, "From now on, for impulse_on: steps add up what contact gives obstacles.")
        .def(
            "impulse_on", [](const SharedSimulation& self, ObstacleId id) { return array_of(self.look().impulse_on(id)); },
            py::arg("obstacle"),
            "What all cloth gave an obstacle in the last step, impacts included, N s, shape (3,). Zero after a step that failed "
            "and\nafter restore.")
        .def(
            "angular_impulse_on",
            [](const SharedSimulation& self, ObstacleId id, py::handle about) {
                return array_of(self.look().angular_impulse_on(id, vector_of(about, "about")));
            },
            py::arg("obstacle"), py::arg("about"),
            "The angular momentum of the same about a point (m, world), N m s, shape (3,).")
        .def(
            "obstacle_pose", [](const SharedSimulation& self, ObstacleId id) { return self.look().obstacle_pose(id); },
            py::arg("obstacle"), "Where it is now.")
        .def(
            "obstacle_shape",
            [](const SharedSimulation& self, ObstacleId id) { return array_of(self.look().obstacle_shape(id)); },
            py::arg("obstacle"), "(n, 3), m: vertices of a deforming obstacle before its pose, a copy; (0, 3) for a rigid one.")
        .def(
            "seam_gaps",
            [](const SharedSimulation& self, SeamId seam) {
                const std::vector<double> gaps = self.look().seam_gaps(seam);
                py::array_t<double> array(static_cast<long>(gaps.size()));
                std::copy(gaps.begin(), gaps.end(), array.mutable_data());
                return array;
            },
            py::arg("seam"), "How far apart the sides of each stitch are, m.")
        .def(
            "meets", [](const SharedSimulation& self, ClothId first, ClothId second) { return self.look().meets(first, second); },
            py::arg("first"), py::arg("second"), "Whether two cloths, or a cloth with itself, meet now.");
}

void bind_figures(SimulationClass& simulation) {
    simulation
        .def_property_readonly(
            "time", [](const SharedSimulation& self) { return self.look().time(); }, "s.")
        .def_property_readonly(
            "cloth_count", [](const SharedSimulation& self) { return self.look().cloth_count(); }, "Without those removed.")
        .def(
            "energy", [](const SharedSimulation& self) { return self.look().energy(); }, "Of the current state, J; work is 0.")
        .def(
            "largest_strain",
            [](const SharedSimulation& self, std::optional<ClothId> cloth) {
                return cloth ? self.look().largest_strain(*cloth) : self.look().largest_strain();
            },
            py::arg("cloth") = py::none(), "Of structural springs, (l - l0)/l0, of a cloth or of all.")
        .def(
            "largest_speed", [](const SharedSimulation& self) { return self.look().largest_speed(); }, "Of a vertex, m/s.")
        .def(
            "state_hash", [](const SharedSimulation& self) { return self.look().state_hash(); },
            "64 bits that depend on every bit of positions and velocities.");
}

}  // namespace

void bind_simulation_views(SimulationClass& simulation) {
    bind_arrays(simulation);
    bind_body_views(simulation);
    bind_figures(simulation);
}

}  // namespace percale::python
