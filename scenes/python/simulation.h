#pragma once

#include <pybind11/pybind11.h>

#include "python/shared_simulation.h"

// The class Simulation in three parts: what it is made of, what the caller prescribes, what it shows.
namespace percale::python {

using SimulationClass = py::class_<SharedSimulation, std::shared_ptr<SharedSimulation>>;

void bind_simulation_scene(SimulationClass& simulation);
void bind_simulation_script(SimulationClass& simulation);
void bind_simulation_views(SimulationClass& simulation);

}  // namespace percale::python
