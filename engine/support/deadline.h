#pragma once

#include <chrono>
#include <optional>

namespace percale {

/// When a step should be at its end; empty: it may take as long as it takes. The one decision that reads a clock.
using Deadline = std::optional<std::chrono::steady_clock::time_point>;

inline Deadline deadline_in(double seconds) {
    if (seconds == 0.0) return std::nullopt;
    return std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

/// The deadline of a step, and how many of Newton's iterations it may take beyond for what moves to arrive.
struct TimeBudget {
    Deadline deadline;
    int late_iterations = 0;
};

inline bool is_past(const Deadline& deadline) { return deadline && std::chrono::steady_clock::now() >= *deadline; }

}  // namespace percale
