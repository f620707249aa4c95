#pragma once

#include <atomic>
#include <string>
#include <utility>

#include "c/call.h"
#include "percale/simulation.h"

// The definitions of the opaque types of percale.h.

struct percale_simulation {
    explicit percale_simulation(percale::Simulation made) : simulation(std::move(made)) { simulation.set_cancel(&cancel); }

    std::atomic<bool> cancel = false;
    percale::Simulation simulation;
    mutable percale::c_interface::ErrorText error = {};
    std::string explanation = {};          // of the last step
    percale::StartFault start_fault = {};  // of the start that was last refused
};

struct percale_step_settings {
    percale::StepSettings value;
};

struct percale_fabric {
    percale::Fabric value;
};

struct percale_mesh {
    percale::TriangleMesh value;
};
