#pragma once

#include <algorithm>

#include "kernels.h"

namespace percale {

/// What the numerical work of one simulation runs on.
struct Compute {
    const Kernels* kernels = &best_kernels();
};

/// work(range) for every chunk of the slices.
template <class Work>
void for_chunks(const Compute&, int slices, Work work) {
    for (int first = 0; first < slices; first += chunk_slices) work(Slices{first, std::min(first + chunk_slices, slices)});
}

/// The sum of work(range) over the chunks, in their order.
template <class Work>
double sum_chunks(const Compute& compute, int slices, Work work) {
    double sum = 0.0;
    for_chunks(compute, slices, [&](Slices range) { sum += work(range); });
    return sum;
}

}  // namespace percale
