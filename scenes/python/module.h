#pragma once

#include <pybind11/pybind11.h>

// The module percale._percale: one function a source, called in this order.
namespace percale::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_fabrics(py::module_& module);
void bind_poses(py::module_& module);
void bind_meshes(py::module_& module);
void bind_reports(py::module_& module);
void bind_certificates(py::module_& module);
void bind_simulation(py::module_& module);
void bind_scene_runs(py::module_& module);

}  // namespace percale::python
