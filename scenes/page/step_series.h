#pragma once

#include <string>
#include <vector>

namespace percale::scenes {

/// A column of steps.csv over time: the smallest and the largest finite number of each group of steps; NaN where a group has
/// none.
struct StepColumn {
    std::string name;
    std::vector<double> min, max;
};

/// The steps of a run in groups of `every`, of which the last may be shorter.
struct StepSeries {
    int steps = 0, every = 1;
    std::vector<double> time;         // s, of the last step of each group
    std::vector<StepColumn> columns;  // dt, newton, linear, residual, contacts, smallest_distance, energy
    std::vector<double> bad;          // s, times of steps whose status is not "ok", at most as many as there may be groups
    int bad_steps = 0;                // how many there are
};

/// Reads FOLDER/steps.csv into at most `max_groups` groups. Throws SceneError with file and line where it is missing or no table
/// of steps.
StepSeries read_step_series(const std::string& folder, int max_groups);

}  // namespace percale::scenes
