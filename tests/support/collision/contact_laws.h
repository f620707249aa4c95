#pragma once

#include <span>

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

// The setup of tests of contact laws.
namespace percale::test {

/// A simulation with the last backend of this build.
inline Simulation simulation_on_meshes(const StepSettings& settings) {
    return Simulation(settings, backends().back().make_detector());
}

/// Makes a step that must be accepted.
inline StepReport step_well(Simulation& simulation) {
    const StepReport report = simulation.step();
    CAPTURE(report.explanation());
    REQUIRE(report.ok());
    return report;
}

inline Vec3 mean(std::span<const Vec3> values) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace percale::test
