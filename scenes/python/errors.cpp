#include "common/scene_file_error.h"
#include "percale/contact.h"
#include "percale/error.h"
#include "python/module.h"

namespace percale::python {
namespace {

// Owned by the module, which is never unloaded.
PyObject *scene_error_type = nullptr, *start_error_type = nullptr;

/// Sets an instance of a type, with attributes, as the error with which the call ends.
void raise(PyObject* type, const SceneError& error, py::dict attributes) {
    scenes::SourcePlace place;
    if (const auto* placed = dynamic_cast<const scenes::SceneFileError*>(&error)) place = placed->place();
    attributes["subject"] = error.subject();
    attributes["reason"] = error.reason();
    attributes["file"] = place.file;
    attributes["line"] = place.line;
    attributes["column"] = place.column;
    const py::object raised = py::reinterpret_borrow<py::object>(type)(error.what());
    for (const auto& [name, value] : attributes) py::setattr(raised, name, value);
    PyErr_SetObject(type, raised.ptr());
}

void raise_start(const StartError& error) {
    const StartFault& fault = error.fault();
    py::dict attributes;
    attributes["obstacle"] = fault.obstacle;
    attributes["intersecting_pairs"] = fault.intersecting_pairs;
    attributes["cloth_triangle"] = fault.cloth_triangle;
    attributes["obstacle_triangle"] = fault.obstacle_triangle;
    attributes["other_cloth_triangle"] = fault.other_cloth_triangle;
    attributes["vertices_inside"] = fault.vertices_inside;
    attributes["inside_vertex"] = fault.inside_vertex;
    py::list inside;
    for (const int vertex : fault.inside_vertices) inside.append(vertex);
    attributes["inside_vertices"] = inside;
    attributes["between_cloths"] = fault.between_cloths();
    raise(start_error_type, error, attributes);
}

void translate(std::exception_ptr pointer) {
    if (!pointer) return;
    try {
        std::rethrow_exception(pointer);
    } catch (const StartError& error) {
        raise_start(error);
    } catch (const SceneError& error) {
        raise(scene_error_type, error, {});
    }
}

constexpr const char* scene_error_text =
    "Wrong input: the message names the object, the value and the allowed range or the nearest name.\n\n"
    "Attributes: subject (what the message is about, \"\" if it does not say), reason (the message without it), and of what a\n"
    "file said file, line, column (\"\" and 0 where that is not known). The simulation is as it was before the call.";
constexpr const char* start_error_text =
    "Cloth that starts where no simulation may start: through, inside or touching an obstacle or other cloth.\n\n"
    "Attributes beside those of SceneError: obstacle (its number; -1: cloth against cloth), intersecting_pairs,\n"
    "cloth_triangle, obstacle_triangle, other_cloth_triangle (counted through all cloths; -1: none), vertices_inside,\n"
    "inside_vertex (the deepest), inside_vertices (all), between_cloths.";

}  // namespace

void bind_errors(py::module_& module) {
    scene_error_type = PyErr_NewExceptionWithDoc("percale.SceneError", scene_error_text, PyExc_ValueError, nullptr);
    if (scene_error_type == nullptr) throw py::error_already_set();
    start_error_type = PyErr_NewExceptionWithDoc("percale.StartError", start_error_text, scene_error_type, nullptr);
    if (start_error_type == nullptr) throw py::error_already_set();
    module.attr("SceneError") = py::reinterpret_borrow<py::object>(scene_error_type);
    module.attr("StartError") = py::reinterpret_borrow<py::object>(start_error_type);
    py::register_exception_translator(translate);
}

}  // namespace percale::python
