#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "sweep/study_folder.h"

namespace percale::scenes {

/// How a run's process ended.
struct WorkerEnd {
    std::size_t run = 0;
    int exit_code = 0;
    int signal = 0;  // that killed it; 0: none did
};

/// Runs of a study, each as a process of its own, so that what goes wrong in one, or kills it, leaves the others alone.
struct StudyWork {
    std::string program;  // path of percale
    int jobs = 1;         // processes at a time
    std::function<void(const WorkerEnd&)> ended;
    std::function<bool()> stop_asked;  // then those that run are asked to stop, and no other is begun
};

/// Does these runs, in their order. Processes die with the one that calls. Throws SceneError where none can be started.
void do_runs(const Study& study, const StudyFolder& folder, std::span<const std::size_t> runs, const StudyWork& work);

}  // namespace percale::scenes
