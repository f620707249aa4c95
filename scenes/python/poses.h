#pragma once

#include <pybind11/pybind11.h>

#include "percale/mesh.h"

namespace percale::python {

namespace py = pybind11;

/// A percale.Pose, a dict of its arguments, or None: where a mesh lies as it is. Throws SceneError naming `what`.
Pose pose_of(py::handle value, const char* what = "pose");

}  // namespace percale::python
