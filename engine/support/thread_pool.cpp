#include "thread_pool.h"

#include <atomic>
#include <thread>

#include "stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

void relax() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

/// Waits until `value` is no longer `old`; returns what it is then.
int wait_for_change(const std::atomic<int>& value, int old, bool spin) {
    for (int k = 0; spin && k < most_spins; ++k) {
        const int now = value.load(std::memory_order_acquire);
        if (now != old) return now;
        relax();
    }
    value.wait(old, std::memory_order_acquire);
    return value.load(std::memory_order_acquire);
}

}  // namespace

struct ThreadPool::Shared {
    std::vector<std::thread> workers;
    std::vector<double> cpu_seconds;  // of each worker
    std::atomic<int> round = 0;       // a new one begins a run
    std::atomic<int> busy = 0;        // workers that have not finished it
    bool stopping = false;
    bool spin = true;
    Task task = nullptr;
    void* data = nullptr;
    int parts = 0;

    int threads() const { return static_cast<int>(cpu_seconds.size()) + 1; }

    /// Also where not all threads could be started.
    ~Shared() {
        stopping = true;
        round.fetch_add(1, std::memory_order_release);
        round.notify_all();
        for (std::thread& worker : workers) worker.join();
    }

    void do_share(int thread) {
        const long all = parts;
        for (long part = all * thread / threads(); part < all * (thread + 1) / threads(); ++part) {
            task(data, static_cast<int>(part), thread);
        }
    }

    void work(int thread) {
        for (int seen = 0;;) {
            seen = wait_for_change(round, seen, spin);
            if (stopping) return;
            do_share(thread);
            cpu_seconds[thread - 1] = thread_cpu_seconds();
            if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) busy.notify_one();
        }
    }
};

ThreadPool::ThreadPool(int threads) : shared_(std::make_unique<Shared>()) {
    // With fewer cores than threads a spinning thread would take the core from one that works.
    shared_->spin = threads <= static_cast<int>(std::thread::hardware_concurrency());
    shared_->cpu_seconds.assign(threads - 1, 0.0);
    shared_->workers.reserve(threads - 1);
    for (int t = 1; t < threads; ++t) shared_->workers.emplace_back([shared = shared_.get(), t] { shared->work(t); });
}

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const { return shared_->threads(); }

double ThreadPool::other_cpu_seconds() const {
    double sum = 0.0;
    for (const double seconds : shared_->cpu_seconds) sum += seconds;
    return sum;
}

void ThreadPool::run_parts(int parts, Task task, void* data) {
    shared_->task = task;
    shared_->data = data;
    shared_->parts = parts;
    shared_->busy.store(threads() - 1, std::memory_order_relaxed);
    shared_->round.fetch_add(1, std::memory_order_release);
    shared_->round.notify_all();
    shared_->do_share(0);
    for (int left = shared_->busy.load(std::memory_order_acquire); left > 0;) {
        left = wait_for_change(shared_->busy, left, shared_->spin);
    }
}

}  // namespace percale
