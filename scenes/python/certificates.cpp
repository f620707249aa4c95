#include <atomic>
#include <limits>

#include "percale/certify.h"
#include "percale/error.h"
#include "python/arrays.h"
#include "python/meshes.h"
#include "python/module.h"
#include "python/released_gil.h"

namespace percale::python {
namespace {

py::array pairs_of(const std::vector<IntersectingPair>& pairs) {
    py::array_t<int> array(std::vector<std::size_t>{pairs.size(), 2});
    int* out = array.mutable_data();
    for (const IntersectingPair& pair : pairs) {
        *out++ = pair.first;
        *out++ = pair.second;
    }
    return array;
}

Certificate certificate_of(py::handle cloth, py::handle obstacle, double distance_limit) {
    if (!(distance_limit >= 0.0)) throw SceneError("distance_limit", "must be at least 0 m");
    const auto first = mesh_of(cloth, "cloth"), second = mesh_of(obstacle, "obstacle");
    std::atomic<bool> cancel = false;
    return interruptible(cancel, [&] {
        const ReleasedGil others_run;
        return certify(*first, *second, distance_limit, &cancel);
    });
}

ClothCertificate cloth_certificate_of(py::handle cloth) {
    const auto mesh = mesh_of(cloth, "cloth");
    std::atomic<bool> cancel = false;
    return interruptible(cancel, [&] {
        const ReleasedGil others_run;
        return certify_cloth(*mesh, {}, {}, &cancel);
    });
}

py::array_t<double> distances_of(py::handle mesh, py::handle points) {
    const auto surface = mesh_of(mesh, "mesh");
    const std::vector<Vec3> places = points_of(points, "points");
    for (const Vec3& x : places)
        if (!x.allFinite()) throw SceneError("points", "one is not finite");
    std::atomic<bool> cancel = false;
    const std::vector<double> distances = interruptible(cancel, [&] {
        const ReleasedGil others_run;
        return surface_distances(*surface, places, &cancel);
    });
    py::array_t<double> array(static_cast<long>(distances.size()));
    std::copy(distances.begin(), distances.end(), array.mutable_data());
    return array;
}

}  // namespace

void bind_certificates(py::module_& module) {
    py::class_<Certificate>(module, "Certificate", "What the exact check of a cloth against an obstacle found.")
        .def_property_readonly(
            "pairs", [](const Certificate& self) { return pairs_of(self.pairs); },
            "(k, 2) int32: triangles of cloth and obstacle that intersect, not merely touch.")
        .def_readonly("touching_pairs", &Certificate::touching_pairs, "Pairs that share points but do not cross.")
        .def_readonly("watertight", &Certificate::watertight, "Whether the obstacle is closed, so that depth has a meaning.")
        .def_readonly("vertices_inside", &Certificate::vertices_inside, "Cloth vertices inside a watertight obstacle.")
        .def_property_readonly(
            "inside_vertices", [](const Certificate& self) { return array_of(std::span<const int>(self.inside_vertices)); },
            "These, ascending, int32.")
        .def_readonly("deepest_vertex", &Certificate::deepest_vertex, "-1: none.")
        .def_readonly("deepest_penetration", &Certificate::deepest_penetration, "m; 0 on an open obstacle.")
        .def_readonly("smallest_distance", &Certificate::smallest_distance, "m; infinity beyond distance_limit.")
        .def_property_readonly("clean", &Certificate::clean, "No pair intersects and no vertex is inside.");
    py::class_<ClothCertificate>(module, "ClothCertificate", "Where cloth meets itself.")
        .def_property_readonly(
            "crossing", [](const ClothCertificate& self) { return pairs_of(self.crossing); },
            "(k, 2) int32: triangles that cross, the lower number first.")
        .def_property_readonly(
            "touching", [](const ClothCertificate& self) { return pairs_of(self.touching); },
            "(k, 2) int32: triangles that share a point though no vertex, and do not cross.")
        .def_property_readonly(
            "clean", [](const ClothCertificate& self) { return self.crossing.empty(); }, "No triangles cross.");
    module.def("certify", &certificate_of, py::arg("cloth"), py::arg("obstacle"),
               py::arg("distance_limit") = std::numeric_limits<double>::infinity(),
               "Exact check of two meshes in world coordinates, each a Mesh or (vertices, triangles); shares no code with the\n"
               "solver. distance_limit: how far to search for the smallest distance, m, >= 0. Other threads run meanwhile.");
    module.def("certify_cloth", &cloth_certificate_of, py::arg("cloth"), "The same of a cloth against itself.");
    module.def("surface_distances", &distances_of, py::arg("mesh"), py::arg("points"),
               "Distance of each of (n, 3) points to the surface, m; with a minus inside a watertight mesh.");
}

}  // namespace percale::python
