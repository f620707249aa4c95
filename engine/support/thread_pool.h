#pragma once

#include <memory>

#include "percale/workers.h"

namespace percale {

/// Workers with a chunk of the parts for each thread, so that the same data meet the same caches run after run; a thread that
/// has finished takes over from the others.
class ThreadPool final : public Workers {
public:
    /// `threads` >= 1, the caller's included.
    explicit ThreadPool(int threads);
    ~ThreadPool() override;
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int threads() const override;
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override;
    double other_cpu_seconds() const override;

private:
    struct Shared;
    std::unique_ptr<Shared> shared_;
};

}  // namespace percale
