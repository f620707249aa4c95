#include "program/stop_signals.h"

#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

#include "program/exit_codes.h"

namespace percale::program {

namespace {

/// Waits for one signal after the other. The second ends the program as it is: what is half written has a name of its own.
void take_signals(const sigset_t& set, std::atomic<bool>& asked) {
    int signal = 0;
    while (sigwait(&set, &signal) == 0) {
        if (asked.exchange(true)) std::_Exit(stopped_by_signal);
        std::fprintf(stderr, "percale: stops after this step; the same once more stops it at once\n");
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
