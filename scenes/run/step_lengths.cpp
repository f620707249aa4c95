#include "run/step_lengths.h"

#include <algorithm>
#include <cmath>

#include "percale/options.h"

namespace percale::scenes {

namespace {

/// Fraction of a number of steps up to which a duration is a multiple of the step, and fraction of a step up to which the last
/// step takes a remainder along. 0: rounding adds a step of no length.
constexpr double whole_steps_rounding = 1e-9, min_last_step = 1e-3;

constexpr double rounding = 1e-7;  // of a step

/// The next time at which adaptive steps have to end: that of a frame, an event or an expectation, or the scene's end.
double next_stop(const Scene& scene, double now) {
    const double after = now + 1e-9 * scene.step.time_step;
    double stop = scene.latest_end();
    const double frame = (std::floor(after * scene.output.fps) + 1.0) / scene.output.fps;
    if (frame > after) stop = std::min(stop, frame);
    for (const EventSpec& event : scene.events)
        if (event.time > after) stop = std::min(stop, event.time);
    for (const Expectation& expectation : scene.expectations)
        if (expectation.at && *expectation.at > after) stop = std::min(stop, *expectation.at);
    return stop;
}

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
    if (full >= 1.0 && ratio - full <= min_last_step && longer <= longest_step()) return {static_cast<long>(full), longer};
    return {static_cast<long>(full) + 1, duration - full * time_step};
}

StepLengths::StepLengths(const Scene& scene, long made, double length)
    : scene_(scene), count_(count_steps(scene.latest_end(), scene.step.time_step)), length_(length), made_(made) {}

bool StepLengths::over(double now) const { return scene_.step.adaptive ? left(now) <= rounding : made_ >= count_.steps; }

double StepLengths::left(double now) const { return (scene_.latest_end() - now) / scene_.step.time_step; }

double StepLengths::next(double now) {
    ++made_;
    if (!scene_.step.adaptive) return made_ >= count_.steps ? count_.last_dt : scene_.step.time_step;
    const double left = next_stop(scene_, now) - now;
    const double length = left / std::max(1.0, std::ceil(left / scene_.step.time_step - 1e-9));
    // The length stays the same in every bit: another one would be a change of the scene.
    if (std::abs(length - length_) > 1e-9 * length) length_ = length;
    return length_;
}

bool CheckpointTimes::due(double now) {
    const double before = made_;
    made_ = count(now);
    return made_ > before;
}

double CheckpointTimes::count(double now) const { return every_ > 0.0 ? std::floor(now / every_ + 1e-9) : 0.0; }

}  // namespace percale::scenes
