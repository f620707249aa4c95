#include "run/step_lengths.h"

#include <algorithm>
#include <cmath>

namespace percale::scenes {

namespace {

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

}  // namespace

StepLengths::StepLengths(const Scene& scene, long made, double length)
    : scene_(scene), count_(count_steps(scene.latest_end(), scene.step.time_step)), length_(length), made_(made) {}

bool StepLengths::over(double now) const { return scene_.step.adaptive ? left(now) <= rounding : made_ >= count_.steps; }

double StepLengths::left(double now) const { return (scene_.latest_end() - now) / scene_.step.time_step; }

double StepLengths::next(double now) {
    ++made_;
    if (!scene_.step.adaptive) return made_ >= count_.steps ? count_.last_dt : scene_.step.time_step;
    const double left = next_stop(scene_, now) - now;
    const double length = left / std::max(1.0, std::ceil(left / scene_.step.time_step - 1e-9));
    // The same length in every bit as before: another one would be a change of the scene.
    if (std::abs(length - length_) > 1e-9 * length) length_ = length;
    return length_;
}

}  // namespace percale::scenes
