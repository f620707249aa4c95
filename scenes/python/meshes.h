#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "percale/mesh.h"
#include "percale/rest_shape.h"

namespace percale::python {

namespace py = pybind11;

/// A percale.Mesh, or a pair (vertices, triangles) of arrays (n, 3) and (m, 3). Throws SceneError naming `what`.
std::shared_ptr<const TriangleMesh> mesh_of(py::handle value, const std::string& what);

/// What add_cloth takes as rest and warp: None, vertices (n, 3) without strain, or corners of triangles (m, 3, 3); a direction.
RestShape rest_shape_of(py::handle rest, py::handle warp, const TriangleMesh& mesh, const std::string& name);

}  // namespace percale::python
