#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "kernel_choice.h"
#include "support/thread_pool.h"

namespace percale {

/// The threads and kernels for the numerical work of one simulation.
struct Compute {
    const Kernels* kernels = &best_kernels();
    Workers* workers = nullptr;  // null: the caller's thread alone
    /// Numbers to be summed in order, one or two a part, kept to avoid allocations.
    mutable std::vector<std::array<double, 2>> sums = {};

    int threads() const { return workers ? workers->threads() : 1; }
};

/// Below this many slices (second: of the coarser levels of multigrid, whose passes do more) dividing them costs more than it
/// saves, and parts are no smaller than the third. Cost alone.
constexpr int min_shared_slices = 96, min_shared_coarse_slices = 40, min_part_slices = 16;

/// work(first, last, thread) for chunks of `grain` of 0 ... count - 1, on all threads where there is enough to do. The chunks
/// are the same for any number of threads.
template <class Work>
void parallel_for_chunks(const Compute& compute, int count, int grain, bool shared, Work work) {
    const int parts = (count + grain - 1) / grain;
    auto part_work = [&](int part, int thread) { work(part * grain, std::min((part + 1) * grain, count), thread); };
    run_parts(shared ? compute.workers : nullptr, parts, part_work);
}

/// work(range) for ranges that make up all slices, of any suitable length: results must not depend on it.
template <class Work>
void for_chunks(const Compute& compute, int slices, Work work, int min = min_shared_slices) {
    const bool shared = compute.workers && slices >= min;
    const int even = (slices + 2 * compute.threads() - 1) / (2 * compute.threads());
    const int grain = shared ? std::clamp(even, min_part_slices, chunk_slices) : chunk_slices;
    parallel_for_chunks(compute, slices, grain, shared, [&](int first, int last, int) { work(Slices{first, last}); });
}

/// work(i) for every vertex of the slices, padding included; the result must not depend on the order.
template <class Work>
void for_each_vertex(const Compute& compute, int slices, Work work) {
    for_chunks(compute, slices, [&](Slices range) {
        const std::size_t last = static_cast<std::size_t>(range.last) * slice_lanes;
        for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes; i < last; ++i) work(i);
    });
}

/// The two sums of work(range, thread) over chunks of `grain` slices, in their order.
template <class Work>
std::array<double, 2> sum_pairs(const Compute& compute, int slices, int grain, Work work) {
    std::array<double, 2> sum{};
    const auto add = [&sum](const std::array<double, 2>& part) {
        sum[0] += part[0];
        sum[1] += part[1];
    };
    if (!compute.workers || slices < min_shared_slices) {
        parallel_for_chunks(compute, slices, grain, false, [&](int first, int last, int thread) {
            add(work(Slices{first, last}, thread));
        });
        return sum;
    }
    auto& sums = compute.sums;
    sums.resize((slices + grain - 1) / grain);
    parallel_for_chunks(compute, slices, grain, true, [&](int first, int last, int thread) {
        sums[first / grain] = work(Slices{first, last}, thread);
    });
    for (const auto& part : sums) add(part);
    return sum;
}

/// The sum of work(range, thread) over chunks of `grain` slices, in their order.
template <class Work>
double sum_stretches(const Compute& compute, int slices, int grain, Work work) {
    return sum_pairs(compute, slices, grain, [&](Slices range, int thread) {
        return std::array<double, 2>{work(range, thread), 0.0};
    })[0];
}

/// The sum of work(range) over the chunks, in their order.
template <class Work>
double sum_chunks(const Compute& compute, int slices, Work work) {
    return sum_stretches(compute, slices, chunk_slices, [&](Slices range, int) { return work(range); });
}

}  // namespace percale
