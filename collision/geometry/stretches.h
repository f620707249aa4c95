#pragma once

#include <algorithm>
#include <cstddef>

#include "percale/workers.h"

namespace percale {

/// How many stretches of `grain` make up `count`.
constexpr std::size_t stretch_count(std::size_t count, std::size_t grain) { return (count + grain - 1) / grain; }

/// work(first, last, slot) for stretches of `grain` of 0 ... count - 1: by `workers`, or one after the other.
template <class Work>
void for_stretches(Workers* workers, std::size_t count, std::size_t grain, Work work) {
    auto part_work = [&](int part, int slot) {
        const std::size_t first = static_cast<std::size_t>(part) * grain;
        work(first, std::min(first + grain, count), slot);
    };
    run_parts(workers, static_cast<int>(stretch_count(count, grain)), part_work);
}

}  // namespace percale
