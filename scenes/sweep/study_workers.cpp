#include "sweep/study_workers.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <thread>
#include <vector>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "percale/error.h"

namespace percale::scenes {

namespace {

std::vector<std::string> words_of(const Study& study, const StudyFolder& folder, std::size_t run, const std::string& program) {
    std::vector<std::string> words = {program,   "run",   study.scene,     "-o", folder.folder_of(run),
                                      "--quiet", "--set", "step.threads=1"};
    for (const Override& change : overrides_of(study, run)) {
        words.push_back("--set");
        words.push_back(change.key + "=" + change.value);
    }
    return words;
}

/// Turns the new process into the run; does only what is safe after a fork.
[[noreturn]] void become(std::vector<char*>& words, int log) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    dup2(log, STDERR_FILENO);
    dup2(log, STDOUT_FILENO);
    execv(words[0], words.data());
    _exit(127);
}

pid_t start(const Study& study, const StudyFolder& folder, std::size_t run, const std::string& program) {
    std::vector<std::string> words = words_of(study, folder, run, program);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int log = open(folder.log_of(run).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (log < 0) throw SceneError(folder.log_of(run) + ": cannot be written: " + std::strerror(errno));
    const pid_t child = fork();
    if (child == 0) become(pointers, log);
    const int error = errno;
    close(log);
    if (child < 0) throw SceneError(program + ": cannot be started: " + std::strerror(error));
    return child;
}

/// Removes a log that is empty.
void drop_empty_log(const std::string& file) {
    std::error_code error;
    if (std::filesystem::file_size(file, error) == 0 && !error) std::filesystem::remove(file, error);
}

/// The processes that run now.
class Children {
public:
    ~Children() {
        for (const auto& [child, run] : running_) kill(child, SIGKILL);
        for (const auto& [child, run] : running_) waitpid(child, nullptr, 0);
    }

    std::size_t count() const { return running_.size(); }
    void add(pid_t child, std::size_t run) { running_[child] = run; }
    void ask_to_stop() const {
        for (const auto& [child, run] : running_) kill(child, SIGTERM);
    }

    /// One that has ended; false where none has.
    bool take_ended(WorkerEnd& end) {
        for (auto entry = running_.begin(); entry != running_.end(); ++entry) {
            int status = 0;
            if (waitpid(entry->first, &status, WNOHANG) != entry->first) continue;
            end = {entry->second, WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
            running_.erase(entry);
            return true;
        }
        return false;
    }

private:
    std::map<pid_t, std::size_t> running_;
};

}  // namespace

void do_runs(const Study& study, const StudyFolder& folder, std::span<const std::size_t> runs, const StudyWork& work) {
    Children children;
    std::size_t next = 0;
    bool stopping = false;
    while (children.count() > 0 || (next < runs.size() && !stopping)) {
        if (!stopping && work.stop_asked && work.stop_asked()) {
            stopping = true;
            children.ask_to_stop();
        }
        while (!stopping && next < runs.size() && children.count() < static_cast<std::size_t>(work.jobs)) {
            const std::size_t run = runs[next++];
            children.add(start(study, folder, run, work.program), run);
        }
        WorkerEnd end;
        if (!children.take_ended(end)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        drop_empty_log(folder.log_of(end.run));
        if (work.ended) work.ended(end);
    }
}

}  // namespace percale::scenes
