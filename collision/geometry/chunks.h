#pragma once

#include <algorithm>
#include <cstddef>

#include "percale/workers.h"

namespace percale {

/// Number of chunks of `grain` items that make up `count`.
constexpr std::size_t chunk_count(std::size_t count, std::size_t grain) { return (count + grain - 1) / grain; }

/// Calls work(first, last, slot) for chunks of `grain` of 0 ... count - 1: on `workers`, or one after the other.
template <class Work>
void parallel_for_chunks(Workers* workers, std::size_t count, std::size_t grain, Work work) {
    auto part_work = [&](int part, int slot) {
        const std::size_t first = static_cast<std::size_t>(part) * grain;
        work(first, std::min(first + grain, count), slot);
    };
    run_parts(workers, static_cast<int>(chunk_count(count, grain)), part_work);
}

}  // namespace percale
