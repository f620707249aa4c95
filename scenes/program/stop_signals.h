#pragma once

#include <atomic>
#include <memory>

namespace percale::program {

/// What the thread that waits for signals and those who ask share.
struct SignalState {
    std::atomic<bool> asked = false, overdue = false;
    std::atomic<int> preparing = 0, jobs = 0;
};

/// From its construction on, a first interrupt or termination signal no longer ends the program but waits to be asked about, so
/// that a step is finished and a report written; one that comes half a second later or more ends it at once, with the exit code
/// of a stopped one. Construct once, and before starting threads: they inherit that the signals are blocked.
class StopSignals {
public:
    StopSignals();
    /// Whether one of them has come. Any thread may ask.
    bool asked() const { return state_->asked; }
    /// True some time after one has come: what has not been finished since then is not waited for.
    const std::atomic<bool>& overdue() const { return state_->overdue; }

    /// work(), during which nothing has been written, or nothing that a kill would harm, and which cannot be asked to stop: once
    /// a signal is overdue and all jobs are at that, the program ends.
    template <class Work>
    auto prepare(Work work) const {
        const Count preparing(state_->preparing);
        return work();
    }

    /// work(), one of several jobs side by side; without any the program is one.
    template <class Work>
    auto job(Work work) const {
        const Count one(state_->jobs);
        return work();
    }

private:
    struct Count {
        explicit Count(std::atomic<int>& of) : count(of) { ++count; }
        ~Count() { --count; }
        Count(const Count&) = delete;
        Count& operator=(const Count&) = delete;
        std::atomic<int>& count;
    };

    std::shared_ptr<SignalState> state_;  // the waiting thread's, too
};

}  // namespace percale::program
