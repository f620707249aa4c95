#include "kernel_choice.h"

#include <cstdlib>
#include <string>
#include <string_view>

#include "kernel_table.h"
#include "percale/error.h"

namespace percale {
namespace {

const Kernels& chosen_kernels() {
    const char* wish = std::getenv("PERCALE_INSTRUCTIONS");
    bool narrow_enough = wish == nullptr;
    for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::baseline}) {
        narrow_enough = narrow_enough || std::string_view(wish) == instruction_set_name(set);
        const Kernels* kernels = kernels_for(set);
        if (narrow_enough && kernels) return *kernels;
    }
    throw SceneError("PERCALE_INSTRUCTIONS = '" + std::string(wish) + "' in the environment; allowed: baseline, avx2, avx512");
}

}  // namespace

const char* instruction_set_name(InstructionSet set) {
    switch (set) {
        case InstructionSet::baseline:
            return "baseline";
        case InstructionSet::avx2:
            return "avx2";
        case InstructionSet::avx512:
            return "avx512";
    }
    return "";
}

const Kernels* kernels_for(InstructionSet set) {
    if (set == InstructionSet::baseline) return &baseline_kernels;
#if defined(PERCALE_WIDE_KERNELS)
    if (set == InstructionSet::avx2) return __builtin_cpu_supports("avx2") ? &avx2_kernels : nullptr;
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
    if (set == InstructionSet::avx512) return wide ? &avx512_kernels : nullptr;
#endif
    return nullptr;
}

const Kernels& best_kernels() {
    static const Kernels& kernels = chosen_kernels();
    return kernels;
}

}  // namespace percale
