#include "program/stop_signals.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "program/exit_codes.h"

namespace percale::program {

namespace {

/// Hosts may send both signals at once, or one to each process and to all: only what comes later is meant as a second one.
constexpr std::chrono::milliseconds second_signal_after{500};

/// A step that takes longer is cancelled; it ends, and a report is written, within the rest of a second.
constexpr std::chrono::milliseconds overdue_after{300};

[[noreturn]] void end_now() { std::_Exit(stopped_by_signal); }

/// The next signal, or 0 where none comes within the time.
int wait_for_signal(const sigset_t& set, std::chrono::milliseconds time) {
    const timespec limit{.tv_sec = time.count() / 1000, .tv_nsec = time.count() % 1000 * 1000000};
    return std::max(0, sigtimedwait(&set, nullptr, &limit));
}

/// Waits for one signal after the other. The second ends the program as it is: what is half written has a name of its own. So
/// does the first where what is prepared does not come to an end.
void take_signals(const sigset_t& set, SignalState& state) {
    int signal = 0;
    while (sigwait(&set, &signal) != 0) {
    }
    const auto first = std::chrono::steady_clock::now();
    state.asked = true;
    std::fprintf(stderr, "%spercale: stopping; once more ends it at once\n", isatty(STDERR_FILENO) == 1 ? "\n" : "");
    constexpr std::chrono::milliseconds look_again{50};
    while (true) {
        const int next = wait_for_signal(set, look_again);
        const auto since = std::chrono::steady_clock::now() - first;
        if (next > 0 && since > second_signal_after) end_now();
        if (since < overdue_after) continue;
        state.overdue = true;
        if (state.preparing > 0 && state.preparing >= state.jobs) end_now();
    }
}

}  // namespace

StopSignals::StopSignals() : state_(std::make_shared<SignalState>()) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    // Not joined: nothing but a signal would end its wait.
    std::thread([set, state = state_] { take_signals(set, *state); }).detach();
}

}  // namespace percale::program
