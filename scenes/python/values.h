#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "fields/toml_document.h"
#include "format/override.h"

// Python values as the tree that scene files are read into, and back: all checks and messages are those of files.
namespace percale::python {

namespace py = pybind11;

/// A dict, list, tuple, str, bool, int, float or what NumPy has for them. Its places have this name for a file. Throws SceneError
/// naming the key of another type, of a key that is no str, or of an integer of more than 64 bits.
scenes::TomlNode node_of(py::handle value, const std::string& name = "");

/// A number, True or False, a text. Throw SceneError naming `what` for anything else.
double number_from(py::handle value, const std::string& what);
bool flag_from(py::handle value, const std::string& what);
std::string text_from(py::handle value, const std::string& what);

/// The other way round: dict, list, str, bool, int, float.
py::object python_of(const scenes::TomlNode& node);

/// {"step.time_step": 0.01, ...} as what changes a scene before it is checked; None: nothing.
std::vector<scenes::Override> overrides_of(py::handle value);

}  // namespace percale::python
