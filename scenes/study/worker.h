#pragma once

#include <functional>
#include <string>
#include <vector>

namespace percale::scenes {

/// How a process ended.
struct WorkerEnd {
    int exit_code = 0;  // -1: a signal killed it
    int signal = 0;     // that killed it; 0: none did
};

/// Runs a program, words[0], as a process of its own and waits for its end, so that what goes wrong in it, or kills it, leaves
/// the caller alone. What it prints becomes the file `log`, which is removed where that is empty. The process is killed when
/// the calling thread ends. Once `stop_asked` (which may be empty) is true it is asked to stop. Throws SceneError where it cannot
/// be started.
WorkerEnd run_worker(std::vector<std::string> words, const std::string& log, const std::function<bool()>& stop_asked);

}  // namespace percale::scenes
