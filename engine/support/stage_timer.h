#pragma once

#include <ctime>

namespace percale {

inline double cpu_seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds used by the calling thread.
inline double thread_cpu_seconds() { return cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID); }

/// Adds the CPU time of its scope to a total.
class StageTimer {
public:
    explicit StageTimer(double& total) : total_(total), start_(thread_cpu_seconds()) {}
    ~StageTimer() { total_ += thread_cpu_seconds() - start_; }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    double& total_;
    double start_;
};

}  // namespace percale
