#pragma once

namespace percale::program {

/// From its construction on, an interrupt or a termination signal no longer ends the program but waits to be asked about, so
/// that a step is finished and a report written. Construct before starting threads: they inherit it.
class StopSignals {
public:
    StopSignals();
    /// Whether one of them has come. Any thread may ask.
    bool asked() const;
};

}  // namespace percale::program
