#include "engine/kernels/kernel_choice.h"

#include <cstdlib>
#include <string>

#include "tests/support/catch.h"

namespace percale::test::kernel_choice_test {
namespace {

constexpr InstructionSet all_sets[] = {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512};

}  // namespace

TEST_CASE("The baseline kernels exist everywhere, and every table knows its set") {
    REQUIRE(kernels_for(InstructionSet::baseline));
    for (const InstructionSet set : all_sets) {
        if (const Kernels* kernels = kernels_for(set)) CHECK(kernels->set == set);
    }
}

TEST_CASE("Instruction sets have the names of the environment variable") {
    CHECK(instruction_set_name(InstructionSet::baseline) == std::string("baseline"));
    CHECK(instruction_set_name(InstructionSet::avx2) == std::string("avx2"));
    CHECK(instruction_set_name(InstructionSet::avx512) == std::string("avx512"));
}

TEST_CASE("The best kernels are the widest available, or at most as wide as requested") {
    const char* wish = std::getenv("PERCALE_INSTRUCTIONS");
    const Kernels* expected = nullptr;
    for (const InstructionSet set : all_sets) {
        if (kernels_for(set)) expected = kernels_for(set);
        if (wish && wish == std::string(instruction_set_name(set))) break;
    }
    CHECK(&best_kernels() == expected);
    CHECK(&best_kernels() == &best_kernels());
}

TEST_CASE("A machine with a wider set has the narrower ones") {
    if (kernels_for(InstructionSet::avx512)) CHECK(kernels_for(InstructionSet::avx2));
}

}  // namespace percale::test::kernel_choice_test
