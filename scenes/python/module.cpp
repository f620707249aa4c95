#include "python/module.h"

PYBIND11_MODULE(_percale, module) {
    namespace python = percale::python;
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
