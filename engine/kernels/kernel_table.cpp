// Compiled once for every instruction set, with its compiler flags: PERCALE_PACK_BYTES and PERCALE_KERNEL_SET name it.
// Everything but the table has internal linkage, so that no code of a wider set can reach a narrower machine.
#include "kernel_table.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstddef>

#define PERCALE_INLINE [[gnu::always_inline]] inline

namespace percale {
namespace {

#include "pack.inl"

#include "spring_kernel.inl"

#include "product_kernel.inl"

#include "block_kernel.inl"

#include "vector_kernel.inl"

#include "membrane_kernel.inl"

#include "limit_kernel.inl"

#include "band_kernel.inl"

#include "layout_kernel.inl"

}  // namespace

#if PERCALE_PACK_BYTES == 64
const Kernels avx512_kernels
#elif PERCALE_PACK_BYTES == 32
const Kernels avx2_kernels
#else
const Kernels baseline_kernels
#endif
    = {.set = InstructionSet::PERCALE_KERNEL_SET,
       .pack_points = pack_points,
       .pack_float_points = pack_float_points,
       .start_springs = start_springs,
       .springs = springs,
       .multiply = multiply,
       .dot = dot_range,
       .advance = advance,
       .turn = turn,
       .jacobi = jacobi,
       .to_float = to_float,
       .add_float = add_float,
       .float_dot = float_dot,
       .float_advance = float_advance,
       .float_turn = float_turn,
       .multiply_fine = multiply_fine,
       .multiply_coarse = multiply_coarse,
       .smooth = smooth,
       .transfer = transfer,
       .fine_diagonal = fine_diagonal,
       .coarse_diagonal = coarse_diagonal,
       .galerkin = galerkin,
       .membrane = membrane,
       .limits = limits,
       .fill_corners = fill_corners,
       .multiply_corners = multiply_corners,
       .multiply_float_corners = multiply_float_corners,
       .corner_diagonal = corner_diagonal,
       .invert = invert,
       .dense_multiply = dense_multiply};

}  // namespace percale
