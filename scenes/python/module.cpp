#include "python/module.h"

#include <pybind11/numpy.h>

#include "python/released_gil.h"

PYBIND11_MODULE(_percale, module) {
    namespace python = percale::python;
    // NumPy is loaded now: loaded by the first call it could let the GIL go while another thread waits for it with the GIL held.
    pybind11::dtype::of<double>();
    python::watch_exit();
    module.attr("__version__") = PERCALE_VERSION;
    python::bind_errors(module);
    python::bind_fabrics(module);
    python::bind_poses(module);
    python::bind_meshes(module);
    python::bind_reports(module);
    python::bind_certificates(module);
    python::bind_simulation(module);
    python::bind_scene_runs(module);
}
