#include "python/meshes.h"

#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>

#include "meshes/mesh_import.h"
#include "meshes/obj_file.h"
#include "meshes/ply_output.h"
#include "percale/error.h"
#include "percale/strain.h"
#include "python/arrays.h"
#include "python/module.h"

namespace percale::python {
namespace {

using Mesh = std::shared_ptr<TriangleMesh>;

Mesh held(TriangleMesh mesh) { return std::make_shared<TriangleMesh>(std::move(mesh)); }

Mesh make_mesh(py::handle vertices, py::handle triangles) {
    TriangleMesh mesh{.vertices = points_of(vertices, "vertices"), .triangles = {}};
    const std::vector<int> corners = rows_of_indices(triangles, "triangles", 3);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    check_mesh(mesh, "mesh", false);
    return held(std::move(mesh));
}

py::array vertices_of(const Mesh& mesh) {
    return shown<double>(mesh, mesh->vertices.empty() ? nullptr : mesh->vertices.front().data(), mesh->vertices.size(), 3);
}

py::array triangles_of(const Mesh& mesh) {
    return shown<int>(mesh, mesh->triangles.empty() ? nullptr : mesh->triangles.front().data(), mesh->triangles.size(), 3);
}

Mesh read_mesh(const std::filesystem::path& file, double unit, const std::string& part, double weld) {
    if (!(unit > 0.0) || !std::isfinite(unit)) throw SceneError("unit", "must be a finite number of m above 0");
    if (!(weld >= 0.0) || !std::isfinite(weld)) throw SceneError("weld", "must be a finite number of m, 0 or more");
    return held(scenes::import_mesh(file.string(), unit, nullptr, part, weld));
}

void write_as_obj(const std::filesystem::path& file, py::handle mesh) {
    const auto given = mesh_of(mesh, "mesh");
    scenes::write_obj(file.string(), given->vertices, given->triangles);
}

void write_as_ply(const std::filesystem::path& file, py::handle mesh) {
    scenes::write_ply(file.string(), *mesh_of(mesh, "mesh"));
}

py::array strains_of(py::handle mesh, py::handle positions, py::handle rest, py::handle warp) {
    const auto given = mesh_of(mesh, "mesh");
    const RestShape shape = rest_shape_of(rest, warp, *given, "mesh");
    const std::vector<Vec3> points = points_of(positions, "positions", given->vertices.size());
    const std::vector<TriangleStrain> strains = triangle_strains(*given, shape, points);
    py::array_t<double> array(std::vector<std::size_t>{strains.size(), 3});
    double* out = array.mutable_data();
    for (const TriangleStrain& strain : strains) {
        for (const double value : {strain.warp, strain.weft, strain.shear}) *out++ = value;
    }
    return array;
}

void bind_shapes(py::module_& module) {
    module.def(
        "make_grid",
        [](double width, double depth, int columns, int rows) { return held(make_grid(width, depth, columns, rows)); },
        py::arg("width"), py::arg("depth"), py::arg("columns"), py::arg("rows"),
        "Flat grid in the plane y = 0, centred, normals +y; vertex (column c, row r) has index r * columns + c. m; columns,\n"
        "rows >= 2 count vertices. A grid has springs along rows, columns and diagonals.");
    module.def(
        "make_sphere", [](double radius, int level) { return held(make_sphere(radius, level)); }, py::arg("radius"),
        py::arg("level") = 4, "Icosahedron subdivided `level` times, 0 ... 8: 20 * 4^level triangles; radius in m.");
    module.def(
        "make_box", [](py::handle size) { return held(make_box(vector_of(size, "size"))); }, py::arg("size"),
        "Axis-parallel box, centred; three edge lengths in m.");
    module.def(
        "make_cylinder", [](double radius, double height, int segments) { return held(make_cylinder(radius, height, segments)); },
        py::arg("radius"), py::arg("height"), py::arg("segments") = 48,
        "Closed cylinder about the y axis, centred; m; segments >= 3.");
    module.def(
        "make_capsule", [](double radius, double height, int segments) { return held(make_capsule(radius, height, segments)); },
        py::arg("radius"), py::arg("height"), py::arg("segments") = 48,
        "Capsule about the y axis, centred; height: between the centres of its half spheres, m; segments: a multiple of 4.");
    module.def(
        "make_plane", [](double half_size) { return held(make_plane(half_size)); }, py::arg("half_size") = 10.0,
        "Horizontal square at y = 0, normals +y; m.");
}

}  // namespace

std::shared_ptr<const TriangleMesh> mesh_of(py::handle value, const std::string& what) {
    if (py::isinstance<TriangleMesh>(value)) return value.cast<Mesh>();
    const bool is_pair = (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) && py::len(value) == 2;
    if (!is_pair) throw SceneError(what, "must be a percale.Mesh or a pair (vertices, triangles), not " + described(value));
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    return make_mesh(pair[0], pair[1]);
}

RestShape rest_shape_of(py::handle rest, py::handle warp, const TriangleMesh& mesh, const std::string& name) {
    RestShape shape;
    if (!rest.is_none() && dimensions_of(rest, name + ": rest") == 3) {
        shape.corners = corners_of(rest, name + ": rest");
    } else if (!rest.is_none()) {
        const TriangleMesh flat{.vertices = points_of(rest, name + ": rest", mesh.vertices.size()), .triangles = mesh.triangles};
        shape = percale::rest_shape_of(mesh, flat, name);
    }
    if (!warp.is_none()) shape.warp = vector_of(warp, name + ": warp");
    return shape;
}

void bind_meshes(py::module_& module) {
    py::class_<TriangleMesh, Mesh>(
        module, "Mesh",
        "A triangle mesh that does not change; lengths in m. Mesh(vertices, triangles): (n, 3) numbers and (m, 3)\n"
        "integers, counter-clockwise seen from outside; a free mesh. `vertices, triangles = mesh` takes it apart.")
        .def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"))
        .def_property_readonly("vertices", &vertices_of, "(n, 3) float64, read-only, no copy.")
        .def_property_readonly("triangles", &triangles_of, "(m, 3) int32, read-only, no copy.")
        .def_readonly("grid_columns", &TriangleMesh::grid_columns, "Vertices a row of a grid; 0: a free mesh.")
        .def_readonly("grid_rows", &TriangleMesh::grid_rows, "Rows of a grid; 0: a free mesh.")
        .def_property_readonly(
            "is_grid", [](const TriangleMesh& mesh) { return mesh.is_grid(); }, "Whether make_grid made it.")
        .def("__iter__", [](const Mesh& mesh) { return py::iter(py::make_tuple(vertices_of(mesh), triangles_of(mesh))); })
        .def("__repr__", [](const TriangleMesh& mesh) {
            return "<percale.Mesh: " + std::to_string(mesh.vertices.size()) + " vertices, " +
                   std::to_string(mesh.triangles.size()) + " triangles>";
        });
    bind_shapes(module);
    module.def(
        "read_mesh", &read_mesh, py::arg("path"), py::arg("unit") = 1.0, py::arg("part") = "", py::arg("weld") = 0.0,
        "Reads a mesh file: OBJ, OFF, PLY in full precision, other formats in single. unit: m per unit of the file, > 0;\n"
        "part: an object or group of an OBJ file that is taken alone;\n"
        "weld: vertices within so many m of an earlier one become one with it; 0: none. Throws SceneError naming file and\n"
        "line.");
    module.def("write_obj", &write_as_obj, py::arg("path"), py::arg("mesh"),
               "Writes a mesh, or (vertices, triangles), as OBJ that reads back in every bit; whole or not at all.");
    module.def("write_ply", &write_as_ply, py::arg("path"), py::arg("mesh"), "The same as binary PLY.");
    module.def("triangle_strains", &strains_of, py::arg("mesh"), py::arg("positions"), py::arg("rest") = py::none(),
               py::arg("warp") = py::none(),
               "(m, 3) of every triangle at positions (n, 3), m: stretch less 1 along warp and along weft, and shear, rad.");
}

}  // namespace percale::python
