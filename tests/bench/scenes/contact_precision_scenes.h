#pragma once

#include <functional>
#include <string>
#include <vector>

#include "percale/simulation.h"

namespace percale::test {

/// A scene with contact, without step and stopping rule.
struct ContactScene {
    std::string name;
    /// `n`: vertices along the longest side of the cloth, or so. `start`: the number of a disturbed start.
    std::function<Simulation(int n, const StepSettings& settings, int start)> make;
    /// Called before each step with the time at which that ends, s, where something is moved.
    std::function<void(Simulation&, double end)> drive = {};
};

/// All of them; `scan` only where that body scan is installed.
std::vector<ContactScene> contact_scenes();

}  // namespace percale::test
