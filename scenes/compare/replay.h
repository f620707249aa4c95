#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace percale::scenes {

/// What distinguishes the steps of two runs, as steps.csv holds it.
struct StepHashes {
    std::string time;  // s
    std::string status;
    std::string contacts, state;  // hashes
};

/// The steps of a run: of its folder, or of a steps.csv itself. Throws SceneError naming the file if it cannot be read, is no
/// table of steps or was written without --replay-hash.
std::vector<StepHashes> read_step_hashes(const std::string& run);

struct ReplayDifference {
    std::size_t step = 0;           // the first that differs, from 1 on; 0: none among those that both have
    std::string what;               // the column
    std::string first, second;      // its values
    std::size_t steps_of_both = 0;  // how many both have
};

ReplayDifference compare_steps(const std::vector<StepHashes>& first, const std::vector<StepHashes>& second);

}  // namespace percale::scenes
