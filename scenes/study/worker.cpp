#include "study/worker.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "percale/error.h"

namespace percale::scenes {

namespace {

/// Turns the new process into the program; does only what is safe after a fork.
[[noreturn]] void become(std::vector<char*>& words, int log) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    dup2(log, STDERR_FILENO);
    dup2(log, STDOUT_FILENO);
    execv(words[0], words.data());
    _exit(127);
}

pid_t start(std::vector<std::string>& words, const std::string& log) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) throw SceneError(log + ": cannot be written: " + std::strerror(errno));
    const pid_t child = fork();
    if (child == 0) become(pointers, file);
    const int error = errno;
    close(file);
    if (child < 0) throw SceneError(words[0] + ": cannot be started: " + std::strerror(error));
    return child;
}

}  // namespace

WorkerEnd run_worker(std::vector<std::string> words, const std::string& log, const std::function<bool()>& stop_asked) {
    const pid_t child = start(words, log);
    int status = 0;
    for (bool stopping = false;;) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child || (ended < 0 && errno != EINTR)) break;
        if (!stopping && stop_asked && stop_asked()) {
            stopping = true;
            kill(child, SIGTERM);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::error_code error;
    if (std::filesystem::file_size(log, error) == 0 && !error) std::filesystem::remove(log, error);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
}

}  // namespace percale::scenes
