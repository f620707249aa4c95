#include "thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "percale/error.h"
#include "stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

void relax() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

}  // namespace

/// A run is open while parts are left. A worker enters, looks whether a run is open and takes parts; the caller closes the run
/// when no part is left and waits until nobody is inside. Both write first and read then, in one order for all (the default of
/// atomics), so that one of them sees the other: no worker touches the data of a run that has returned.
struct ThreadPool::Shared {
    /// Parts of one thread that nobody has begun yet, on a cache line of its own.
    struct alignas(64) Stretch {
        std::atomic<int> next = 0;
        int end = 0;
    };

    std::vector<std::thread> workers;
    std::vector<Stretch> stretches;  // one a thread
    std::vector<std::atomic<double>> cpu_seconds;
    std::atomic<bool> in_use = false;  // by a caller
    std::atomic<bool> open = false;
    std::atomic<int> inside = 0;    // workers
    std::atomic<int> round = 0;     // a new one wakes workers
    std::atomic<int> sleeping = 0;  // of them, about to wait for it
    std::atomic<bool> stopping = false;
    bool spin = true;
    void (*work)(void* data, int part, int slot) = nullptr;
    void* data = nullptr;

    explicit Shared(int threads) : stretches(threads), cpu_seconds(threads) {}

    int threads() const { return static_cast<int>(stretches.size()); }

    /// Also where not all threads could be started.
    ~Shared() {
        stopping = true;
        ++round;
        round.notify_all();
        for (std::thread& worker : workers) worker.join();
    }

    /// Its own stretch first, then what is left of the others.
    void take_parts(int thread) {
        for (int k = 0; k < threads(); ++k) {
            Stretch& stretch = stretches[(thread + k) % threads()];
            if (stretch.next.load(std::memory_order_relaxed) >= stretch.end) continue;
            for (int part = stretch.next++; part < stretch.end; part = stretch.next++) work(data, part, thread);
        }
    }

    /// Waits for a round other than `seen`; returns it.
    int wait_for_round(int seen) {
        const auto start = std::chrono::steady_clock::now();
        while (spin && std::chrono::steady_clock::now() - start < longest_spin) {
            for (int k = 0; k < spins_between_looks; ++k) {
                if (const int now = round.load(std::memory_order_acquire); now != seen) return now;
                relax();
            }
        }
        ++sleeping;
        round.wait(seen);
        --sleeping;
        return round;
    }

    void serve(int thread) {
        for (int seen = 0;;) {
            seen = wait_for_round(seen);
            if (stopping) return;
            ++inside;
            if (open) {
                take_parts(thread);
                cpu_seconds[thread].store(thread_cpu_seconds(), std::memory_order_relaxed);
            }
            --inside;
        }
    }

    void share_out(int parts) {
        for (int t = 0; t < threads(); ++t) {
            stretches[t].next.store(static_cast<int>(static_cast<long>(parts) * t / threads()), std::memory_order_relaxed);
            stretches[t].end = static_cast<int>(static_cast<long>(parts) * (t + 1) / threads());
        }
        open = true;
        ++round;
        if (sleeping > 0) round.notify_all();
        take_parts(0);
        open = false;
        while (inside > 0) relax();
    }
};

ThreadPool::ThreadPool(int threads) : shared_(std::make_unique<Shared>(threads)) {
    // With fewer cores than threads a spinning thread would take the core from one that works.
    shared_->spin = threads <= static_cast<int>(std::thread::hardware_concurrency());
    shared_->workers.reserve(threads - 1);
    for (int t = 1; t < threads; ++t) shared_->workers.emplace_back([shared = shared_.get(), t] { shared->serve(t); });
}

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const { return shared_->threads(); }

double ThreadPool::other_cpu_seconds() const {
    double sum = 0.0;
    for (const auto& seconds : shared_->cpu_seconds) sum += seconds.load(std::memory_order_relaxed);
    return sum;
}

void ThreadPool::run(int parts, void (*work)(void* data, int part, int slot), void* data) {
    const bool alone = threads() == 1 || parts < 2 || shared_->in_use.exchange(true);
    if (alone) {
        for (int part = 0; part < parts; ++part) work(data, part, 0);
        return;
    }
    shared_->work = work;
    shared_->data = data;
    shared_->share_out(parts);
    shared_->in_use = false;
}

std::shared_ptr<Workers> make_workers(int threads) {
    if (threads < 0 || threads > most_threads) {
        throw SceneError("make_workers: " + std::to_string(threads) + " threads are outside the allowed range 0 ... " +
                         std::to_string(most_threads));
    }
    const int cores = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, most_threads);
    return std::make_shared<ThreadPool>(threads == 0 ? cores : threads);
}

}  // namespace percale
