#pragma once

#include <cstddef>
#include <string>

#include "export/step_table.h"

namespace percale::scenes {

/// The steps of a run with their hashes: of its folder, or of a steps.csv itself. Throws SceneError naming the file if it cannot
/// be read, is no table of steps or was written without --replay-hash.
StepRows read_hashed_steps(const std::string& run);

struct ReplayDifference {
    std::size_t step = 0;                 // the first that differs, from 1 on; 0: none among those that both have
    std::string time = {}, what = {};     // of that step in the first run, s; the column
    std::string first = {}, second = {};  // its values
    std::size_t steps_of_both = 0;        // how many both have
};

/// Compares times, statuses and hashes.
ReplayDifference compare_steps(const StepRows& first, const StepRows& second);

}  // namespace percale::scenes
