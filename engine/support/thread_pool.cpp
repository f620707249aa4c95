#include "thread_pool.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "percale/error.h"
#include "stage_timer.h"
#include "tolerances.h"

#if defined(__SANITIZE_THREAD__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wtsan"  // it does not model fences; the fence below orders only atomics
#endif

namespace percale {
namespace {

/// How long a thread looks for more work before it goes to sleep: regions follow each other within microseconds, and waking a
/// thread takes tens of them. Longer: other programs get less of the cores. Shorter: every region waits for threads to wake. The
/// second number counts the looks between two readings of the clock. Cost alone.
constexpr std::chrono::microseconds longest_spin(20);
constexpr int spins_between_looks = 8;

void relax() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

}  // namespace

/// A run is open while parts are left. A worker announces that it is inside, checks whether a run is open and takes parts; the
/// caller closes the run when no part is left and waits until no worker is inside. Both write first and read afterwards, in one
/// order for all (the default of atomics), so that one of them sees the other: no worker touches the data of a run that has
/// returned.
///
/// Only as many workers are called as there are parts, each by a cache line of its own: the others continue to sleep, and a call
/// costs no more than these few lines.
struct ThreadPool::Shared {
    /// One thread's line. A chunk of parts that nobody has begun yet; empty between runs.
    struct alignas(64) Seat {
        std::atomic<int> next = 0;
        int end = 0;
        std::atomic<bool> inside = false;
    };
    struct alignas(64) Bell {
        std::atomic<unsigned> round = 0;  // a new one calls the worker
        std::atomic<bool> sleeps = false;
    };

    std::vector<std::thread> workers;
    std::vector<Seat> seats;  // one a thread
    std::vector<Bell> bells;
    std::vector<clockid_t> clocks;                 // of the workers' CPU time
    alignas(64) std::atomic<bool> in_use = false;  // by a caller
    std::atomic<bool> stopping = false;
    bool spin = true;
    unsigned last_round = 0;
    alignas(64) std::atomic<bool> open = false;
    int called = 1;           // threads of this run, the caller's included
    bool many_parts = false;  // more than one a thread
    void (*work)(void* data, int part, int slot) = nullptr;
    void* data = nullptr;

    explicit Shared(int threads) : seats(threads), bells(threads) {}

    int threads() const { return static_cast<int>(seats.size()); }

    /// Runs also where not all threads could be started.
    ~Shared() {
        stopping = true;
        ring(threads());
        for (std::thread& worker : workers) worker.join();
    }

    void take_parts_of(int seat, int thread) {
        Seat& from = seats[seat];
        if (from.next.load(std::memory_order_relaxed) >= from.end) return;
        for (int part = from.next++; part < from.end; part = from.next++) work(data, part, thread);
    }

    /// Takes its own chunk first, then the rest of the others; with one part a thread only the caller looks at the others.
    void take_parts(int thread) {
        take_parts_of(thread, thread);
        if (thread > 0 && !many_parts) return;
        for (int k = 1; k < called; ++k) take_parts_of((thread + k) % called, thread);
    }

    /// Waits for a round other than `seen`; returns it.
    unsigned wait_for_round(int thread, unsigned seen) {
        Bell& bell = bells[thread];
        const auto start = std::chrono::steady_clock::now();
        while (spin && std::chrono::steady_clock::now() - start < longest_spin) {
            for (int k = 0; k < spins_between_looks; ++k) {
                if (const unsigned now = bell.round.load(std::memory_order_acquire); now != seen) return now;
                relax();
            }
        }
        bell.sleeps = true;
        while (bell.round == seen) bell.round.wait(seen);
        bell.sleeps.store(false, std::memory_order_relaxed);
        return bell.round;
    }

    void serve(int thread) {
        for (unsigned seen = 0;;) {
            seen = wait_for_round(thread, seen);
            if (stopping) return;
            seats[thread].inside = true;
            if (open && thread < called) take_parts(thread);
            seats[thread].inside.store(false, std::memory_order_release);
        }
    }

    /// Calls the workers before `count`.
    void ring(int count) {
        ++last_round;
        for (int t = 1; t < count; ++t) bells[t].round.store(last_round, std::memory_order_release);
        std::atomic_thread_fence(std::memory_order_seq_cst);
        for (int t = 1; t < count; ++t) {
            if (bells[t].sleeps.load(std::memory_order_relaxed)) bells[t].round.notify_one();
        }
    }

    void share_out(int parts) {
        called = std::min(parts, threads());
        many_parts = parts > called;
        for (int t = 0; t < called; ++t) {
            seats[t].next.store(static_cast<int>(static_cast<long>(parts) * t / called), std::memory_order_relaxed);
            seats[t].end = static_cast<int>(static_cast<long>(parts) * (t + 1) / called);
        }
        open = true;
        ring(called);
        take_parts(0);
        open = false;
        for (int t = 1; t < threads(); ++t) {
            while (seats[t].inside) relax();
        }
    }
};

ThreadPool::ThreadPool(int threads) : shared_(std::make_unique<Shared>(threads)) {
    // With fewer cores than threads a spinning thread would take the core from one that works.
    shared_->spin = threads <= static_cast<int>(std::thread::hardware_concurrency());
    shared_->workers.reserve(threads - 1);
    shared_->clocks.reserve(threads - 1);
    for (int t = 1; t < threads; ++t) {
        std::thread& worker = shared_->workers.emplace_back([shared = shared_.get(), t] { shared->serve(t); });
        clockid_t clock{};
        if (pthread_getcpuclockid(worker.native_handle(), &clock) == 0) shared_->clocks.push_back(clock);
    }
}

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const { return shared_->threads(); }

double ThreadPool::other_cpu_seconds() const {
    double sum = 0.0;
    for (const clockid_t clock : shared_->clocks) sum += cpu_seconds_of(clock);
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
    if (threads < 0 || threads > max_threads) {
        throw SceneError("make_workers: " + std::to_string(threads) + " threads are outside the allowed range 0 ... " +
                         std::to_string(max_threads));
    }
    const int cores = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, max_threads);
    return std::make_shared<ThreadPool>(threads == 0 ? cores : threads);
}

}  // namespace percale
