#pragma once

#include <atomic>
#include <memory>

namespace percale::program {

/// From its construction on, a first interrupt or termination signal no longer ends the program but waits to be asked about, so
/// that a step is finished and a report written; one that comes half a second later or more ends it at once, with the exit code
/// of a stopped one. Construct once, and before starting threads: they inherit that the signals are blocked.
class StopSignals {
public:
    StopSignals();
    /// Whether one of them has come. Any thread may ask.
    bool asked() const;

private:
    std::shared_ptr<std::atomic<bool>> asked_;  // the waiting thread's, too
};

}  // namespace percale::program
