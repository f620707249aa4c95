#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "kernel_choice.h"
#include "support/thread_pool.h"

namespace percale {

/// What the numerical work of one simulation runs on.
struct Compute {
    const Kernels* kernels = &best_kernels();
    Workers* workers = nullptr;  // null: the caller's thread alone
    /// Numbers to be summed in order, one or two a part, kept so that none are allocated anew.
    mutable std::vector<std::array<double, 2>> sums = {};

    int threads() const { return workers ? workers->threads() : 1; }
};

/// Below this many slices (second: of the coarser levels of multigrid, whose passes do more) sharing them out costs more than it
/// saves, and parts are no smaller than the third. Cost alone.
constexpr int least_shared_slices = 96, least_shared_coarse_slices = 40, least_part_slices = 16;

/// work(first, last, thread) for stretches of `grain` of 0 ... count - 1, on all threads where there is enough to do. The
/// stretches are the same for any number of threads.
template <class Work>
void for_stretches(const Compute& compute, int count, int grain, bool shared, Work work) {
    const int parts = (count + grain - 1) / grain;
    auto part_work = [&](int part, int thread) { work(part * grain, std::min((part + 1) * grain, count), thread); };
    run_parts(shared ? compute.workers : nullptr, parts, part_work);
}

/// work(range) for ranges that make up all slices, of whatever length suits: nothing may depend on it.
template <class Work>
void for_chunks(const Compute& compute, int slices, Work work, int least = least_shared_slices) {
    const bool shared = compute.workers && slices >= least;
    const int even = (slices + 2 * compute.threads() - 1) / (2 * compute.threads());
    const int grain = shared ? std::clamp(even, least_part_slices, chunk_slices) : chunk_slices;
    for_stretches(compute, slices, grain, shared, [&](int first, int last, int) { work(Slices{first, last}); });
}

/// work(i) for every vertex of the slices, padding included; the same whatever the order.
template <class Work>
void for_each_vertex(const Compute& compute, int slices, Work work) {
    for_chunks(compute, slices, [&](Slices range) {
        const std::size_t last = static_cast<std::size_t>(range.last) * slice_lanes;
        for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes; i < last; ++i) work(i);
    });
}

/// The two sums of work(range, thread) over stretches of `grain` slices, in their order.
template <class Work>
std::array<double, 2> sum_pairs(const Compute& compute, int slices, int grain, Work work) {
    std::array<double, 2> sum{};
    const auto add = [&sum](const std::array<double, 2>& part) {
        sum[0] += part[0];
        sum[1] += part[1];
    };
    if (!compute.workers || slices < least_shared_slices) {
        for_stretches(compute, slices, grain, false, [&](int first, int last, int thread) {
            add(work(Slices{first, last}, thread));
        });
        return sum;
    }
    auto& sums = compute.sums;
    sums.resize((slices + grain - 1) / grain);
    for_stretches(compute, slices, grain, true, [&](int first, int last, int thread) {
        sums[first / grain] = work(Slices{first, last}, thread);
    });
    for (const auto& part : sums) add(part);
    return sum;
}

/// The sum of work(range, thread) over stretches of `grain` slices, in their order.
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
