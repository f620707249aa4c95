#include "program/stop_signals.h"

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "program/exit_codes.h"

namespace percale::program {

namespace {

/// Hosts may send both signals at once, or one to each process and to all: only what comes later is meant as a second one.
constexpr std::chrono::milliseconds second_signal_after{500};

/// Waits for one signal after the other. The second ends the program as it is: what is half written has a name of its own.
void take_signals(const sigset_t& set, std::atomic<bool>& asked) {
    std::chrono::steady_clock::time_point first;
    int signal = 0;
    while (sigwait(&set, &signal) == 0) {
        const auto now = std::chrono::steady_clock::now();
        if (!asked.exchange(true)) {
            first = now;
            std::fprintf(stderr, "%spercale: stopping; once more ends it at once\n", isatty(STDERR_FILENO) == 1 ? "\n" : "");
        } else if (now - first > second_signal_after) {
            std::_Exit(stopped_by_signal);
        }
    }
}

}  // namespace

StopSignals::StopSignals() : asked_(std::make_shared<std::atomic<bool>>(false)) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    // Not joined: nothing but a signal would end its wait.
    std::thread([set, asked = asked_] { take_signals(set, *asked); }).detach();
}

bool StopSignals::asked() const { return *asked_; }

}  // namespace percale::program
