#pragma once

namespace percale::scenes {

/// Steps of a scene, undivided, and the length of the last one, s.
struct StepCount {
    long steps = 0;
    double last_dt = 0.0;
};
StepCount count_steps(double duration, double time_step);

}  // namespace percale::scenes
