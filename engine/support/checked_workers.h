#pragma once

#include <atomic>
#include <vector>

#include "percale/workers.h"

namespace percale {

/// A host's workers, with checks of their contract: each part once, slots in range, no exception.
class CheckedWorkers : public Workers {
public:
    /// Throws SceneError where the host states no threads, or too many.
    explicit CheckedWorkers(std::shared_ptr<Workers> host);

    int threads() const override { return threads_; }
    /// Throws WorkersError where the host has not done each part once; exceptions of the host pass through. A part that is
    /// called again is not done again.
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override;
    double other_cpu_seconds() const override { return host_->other_cpu_seconds(); }

    /// Throws WorkersError once a run has failed: work was left out.
    void check() const;

private:
    /// One call of run.
    struct Batch {
        void (*work)(void* data, int part, int slot) = nullptr;
        void* data = nullptr;
        std::atomic<int> parts = 0, done = 0;
        std::atomic<bool> wrong = false;
    };
    static void do_part(void* workers, int part, int slot);

    std::shared_ptr<Workers> host_;
    int threads_;
    Batch batch_;                           // a member, for a host that returns before its last part has begun
    std::vector<std::atomic<bool>> begun_;  // of each part of the run; grows
    std::atomic<bool> broken_ = false;
};

}  // namespace percale
