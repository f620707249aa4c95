#pragma once

#include "kernels.h"

namespace percale {

/// baseline, avx2 or avx512.
const char* instruction_set_name(InstructionSet set);

/// The kernels of a set; null where this build or this processor lacks it.
const Kernels* kernels_for(InstructionSet set);

/// The widest set that this processor has; PERCALE_INSTRUCTIONS=baseline|avx2|avx512 in the environment requests a narrower one.
/// Read once; any thread.
const Kernels& best_kernels();

}  // namespace percale
