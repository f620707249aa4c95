#pragma once

#include "kernels.h"

namespace percale {

/// The tables of the instruction sets; the wider ones exist on x86-64 only (PERCALE_WIDE_KERNELS).
extern const Kernels baseline_kernels;
extern const Kernels avx2_kernels;
extern const Kernels avx512_kernels;

}  // namespace percale
