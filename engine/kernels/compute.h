#pragma once

#include <algorithm>

#include "kernel_choice.h"
#include "support/thread_pool.h"

namespace percale {

/// What the numerical work of one simulation runs on.
struct Compute {
    const Kernels* kernels = &best_kernels();
    ThreadPool* pool = nullptr;  // null: the caller's thread alone
};

/// Below this many vertices' worth of work, sharing it out costs more than it saves.
constexpr int least_shared_slices = 512;

/// work(first, last, thread) for stretches of `grain` of 0 ... count - 1, on the pool's threads where there is enough to do. The
/// stretches are the same for any number of threads.
template <class Work>
void for_stretches(const Compute& compute, int count, int grain, bool shared, Work work) {
    const int parts = (count + grain - 1) / grain;
    const auto part_work = [&](int part, int thread) { work(part * grain, std::min((part + 1) * grain, count), thread); };
    if (shared && compute.pool) return compute.pool->run(parts, part_work);
    for (int part = 0; part < parts; ++part) part_work(part, 0);
}

/// work(range) for every chunk of the slices.
template <class Work>
void for_chunks(const Compute& compute, int slices, Work work) {
    for_stretches(compute, slices, chunk_slices, slices >= least_shared_slices, [&](int first, int last, int) {
        work(Slices{first, last});
    });
}

/// The sum of work(range, thread) over stretches of `grain` slices, in their order.
template <class Work>
double sum_stretches(const Compute& compute, int slices, int grain, Work work) {
    double sum = 0.0;
    if (!compute.pool || slices < least_shared_slices) {
        for_stretches(compute, slices, grain, false, [&](int first, int last, int thread) {
            sum += work(Slices{first, last}, thread);
        });
        return sum;
    }
    std::vector<double>& sums = compute.pool->sums();
    sums.assign((slices + grain - 1) / grain, 0.0);
    for_stretches(compute, slices, grain, true, [&](int first, int last, int thread) {
        sums[first / grain] = work(Slices{first, last}, thread);
    });
    for (const double part : sums) sum += part;
    return sum;
}

/// The sum of work(range) over the chunks, in their order.
template <class Work>
double sum_chunks(const Compute& compute, int slices, Work work) {
    return sum_stretches(compute, slices, chunk_slices, [&](Slices range, int) { return work(range); });
}

}  // namespace percale
