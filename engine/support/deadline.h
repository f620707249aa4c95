#pragma once

#include <atomic>
#include <chrono>
#include <optional>

namespace percale {

/// The time at which a step should end; by default there is none. The only decision that reads a clock.
struct Deadline {
    std::optional<std::chrono::steady_clock::time_point> time = {};
    const std::atomic<bool>* cancel = nullptr;  // true: end at once, by the caller's wish (Simulation::set_cancel)
};

/// 0 s: no deadline.
inline Deadline deadline_in(double seconds, const std::atomic<bool>* cancel = nullptr) {
    if (seconds == 0.0) return {{}, cancel};
    return {std::chrono::steady_clock::now() +
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds)),
            cancel};
}

/// The deadline of a step, and how many further Newton iterations it may take for pins and obstacles to arrive.
struct TimeBudget {
    Deadline deadline;
    int late_iterations = 0;
};

/// Extends a deadline by so many seconds; cancelling stays in effect.
inline Deadline later(Deadline deadline, double seconds) {
    if (deadline.time)
        *deadline.time += std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
    return deadline;
}

inline bool is_cancelled(const Deadline& deadline) {
    return deadline.cancel != nullptr && deadline.cancel->load(std::memory_order_relaxed);
}
inline bool is_past(const Deadline& deadline) {
    return is_cancelled(deadline) || (deadline.time && std::chrono::steady_clock::now() >= *deadline.time);
}

}  // namespace percale
