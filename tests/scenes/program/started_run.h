#pragma once

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/scenes/program/run_program.h"

namespace percale::program::test {

/// The program at work in a folder, its output thrown away. Killed if it is still there in the end.
class StartedRun {
public:
    StartedRun(const TestFolder& folder, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), PERCALE_PROGRAM);
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        child_ = fork();
        if (child_ != 0) return;
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        if (chdir(folder.path().c_str()) == 0) execv(PERCALE_PROGRAM, words.data());
        _exit(99);
    }
    ~StartedRun() {
        if (child_ > 0) end(SIGKILL);
    }
    StartedRun(const StartedRun&) = delete;
    StartedRun& operator=(const StartedRun&) = delete;

    /// Waits, two minutes at most, until the file is there: the program may be one under sanitizers, on a busy machine.
    void wait_for(const TestFolder& folder, const std::string& file) const {
        for (int i = 0; i < 120000 && !folder.holds(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    /// Waits as long until it answers signals itself, for which it blocks these two; all are blocked while a thread is begun.
    void wait_for_signals() const {
        for (int i = 0; i < 120000 && (!blocks(SIGTERM) || blocks(SIGHUP)); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    void send(int signal) const { kill(child_, signal); }
    /// Sends the signal; returns the exit code, or -1 where the signal ended the program.
    int end(int signal) {
        kill(child_, signal);
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    bool blocks(int signal) const {
        std::ifstream status("/proc/" + std::to_string(child_) + "/status");
        const std::string key = "SigBlk:";
        for (std::string line; std::getline(status, line);)
            if (line.starts_with(key)) return (std::stoull(line.substr(key.size()), nullptr, 16) >> (signal - 1) & 1) != 0;
        return false;
    }

    pid_t child_ = -1;
};

}  // namespace percale::program::test
