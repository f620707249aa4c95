#pragma once

#include "format/scene.h"

namespace percale::scenes {

/// Steps of a scene, undivided, and the length of the last one, s.
struct StepCount {
    long steps = 0;
    double last_dt = 0.0;
};
StepCount count_steps(double duration, double time_step);

/// Says how long the steps of a run are: `time_step`, the last one shorter; with "auto" equal ones from stop to stop, which are
/// the times of frames, events and expectations' `at`, and the scene's end. Times in s.
class StepLengths {
public:
    /// `made`: steps so far; `length`: of the last one, before the first step.time_step.
    StepLengths(const Scene& scene, long made, double length);

    long made() const { return made_; }
    double length() const { return length_; }
    bool over(double now) const;
    /// The length of the next step.
    double next(double now);

private:
    /// The time that is left, in steps of step.time_step.
    double left(double now) const;

    const Scene& scene_;
    StepCount count_;
    double length_;
    long made_;
};

/// Says when checkpoints are due: at the end of each interval of so many seconds of the scene; 0: never.
class CheckpointTimes {
public:
    CheckpointTimes(double every, double now) : every_(every), made_(count(now)) {}

    bool due(double now);

private:
    double count(double now) const;

    double every_, made_;
};

}  // namespace percale::scenes
