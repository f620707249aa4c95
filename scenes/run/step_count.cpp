#include "run/step_count.h"

#include <algorithm>
#include <cmath>

#include "percale/options.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

double longest_step() {
    const auto options = step_options();
    return std::find_if(options.begin(), options.end(), [](const auto& option) { return option.key == "time_step"; })->highest;
}

}  // namespace

StepCount count_steps(double duration, double time_step) {
    // A duration written with 16 digits is a multiple of a step written with 16 digits only up to rounding.
    const double ratio = duration / time_step;
    const double whole = std::round(ratio);
    if (whole >= 1.0 && std::abs(ratio - whole) <= whole_steps_rounding * whole) return {static_cast<long>(whole), time_step};
    const double full = std::floor(ratio);
    // A rounded time step leaves a remainder that is no step of its own: the last one takes it along.
    const double longer = duration - (full - 1.0) * time_step;
    if (full >= 1.0 && ratio - full <= least_last_step && longer <= longest_step()) return {static_cast<long>(full), longer};
    return {static_cast<long>(full) + 1, duration - full * time_step};
}

}  // namespace percale::scenes
