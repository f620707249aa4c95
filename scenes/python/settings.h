#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "format/scene.h"
#include "percale/fabric.h"

// Settings and fabrics from Python's keyword arguments, read by the tables of scene files: same names, ranges, defaults and
// messages.
namespace percale::python {

namespace py = pybind11;

/// The keys of [step] but the detector, and gravity and wind; `detector` is a word of detector_words. Throws SceneError.
scenes::Scene step_settings(const std::string& detector, const py::dict& settings);

/// All of these as they are, defaults included.
py::dict settings_dict(const StepSettings& settings, scenes::Detector detector);

/// The keys of a [fabric.NAME]. Throws SceneError.
Fabric fabric_of_keys(const py::dict& keys);

/// A percale.Fabric, or a dict of its keys.
Fabric fabric_of(py::handle value);

/// The keyword arguments of Simulation and of Fabric, a line each.
std::string step_settings_text();
std::string fabric_keys_text();

}  // namespace percale::python
