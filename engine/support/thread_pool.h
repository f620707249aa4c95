#pragma once

#include <memory>
#include <vector>

namespace percale {

/// A few threads that share out numbered parts of work, always the same parts to the same thread. One caller at a time, which
/// does its own share; work must not call run() again.
class ThreadPool {
public:
    /// `threads` >= 1, the caller's included.
    explicit ThreadPool(int threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int threads() const;

    /// work(part, thread) for every part of 0 ... parts - 1; thread t does parts * t / threads and on. Returns when all are done.
    template <class Work>
    void run(int parts, Work work) {
        run_parts(
            parts, [](void* data, int part, int thread) { (*static_cast<Work*>(data))(part, thread); }, &work);
    }

    /// Numbers to be summed in order, one a part, kept so that none are allocated anew.
    std::vector<double>& sums() { return sums_; }

    /// CPU seconds of the threads besides the caller so far.
    double other_cpu_seconds() const;

private:
    using Task = void (*)(void* data, int part, int thread);
    struct Shared;
    void run_parts(int parts, Task task, void* data);

    std::unique_ptr<Shared> shared_;
    std::vector<double> sums_;
};

}  // namespace percale
