#pragma once

#include <memory>

#include "percale/error.h"

namespace percale {

/// Threads that work on numbered parts: a pool of the library (make_workers), or a host's job system behind this interface.
/// Results do not depend on them. Several simulations may share one, from any threads.
class Workers {
public:
    virtual ~Workers() = default;

    /// The largest number of parts that run at the same time, the caller's included; 1 ... 64, and always the same.
    virtual int threads() const = 0;

    /// Calls work(data, part, slot) once for each part of 0 ... parts - 1, in any order and on any threads, and returns when all
    /// are done; the caller then sees what they wrote. Simultaneous calls have different slots of 0 ... threads() - 1. `work`
    /// throws nothing and does not call run. Where the threads are busy for another caller, the caller does all parts.
    virtual void run(int parts, void (*work)(void* data, int part, int slot), void* data) = 0;

    /// CPU seconds that threads other than its callers have used so far; 0 where that is not known.
    virtual double other_cpu_seconds() const { return 0.0; }
};

/// A host's workers have violated the contract of `run`: the results of the computation cannot be trusted.
class WorkersError : public SceneError {
public:
    using SceneError::SceneError;
};

/// A pool of `threads` threads, the caller's included: 1 ... 64, 0: as many as the machine runs at once. Threads that wait give
/// their core back after some microseconds. Throws SceneError for a number out of range.
std::shared_ptr<Workers> make_workers(int threads);

/// work(part, slot) for every part of 0 ... parts - 1, by `workers` or, without any, one after the other.
template <class Work>
void run_parts(Workers* workers, int parts, Work& work) {
    if (workers && parts > 1) {
        workers->run(
            parts, [](void* data, int part, int slot) { (*static_cast<Work*>(data))(part, slot); }, &work);
        return;
    }
    for (int part = 0; part < parts; ++part) work(part, 0);
}

}  // namespace percale
