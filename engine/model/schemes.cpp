#include "schemes.h"

#include <limits>

namespace percale {
namespace {

// One entry a scheme, in the order of the enum.
constexpr SchemeFacts table[] = {
    {Scheme::symplectic_euler, "symplectic_euler", 1, false, 2.0, 1, "amplitude kept for a < 2, grows beyond"},
    {Scheme::rk4, "rk4", 4, false, 2.8284271247461903, 4, "damped for a < 2 sqrt 2, grows beyond"},
    {Scheme::backward_euler, "backward_euler", 1, true, std::numeric_limits<double>::infinity(), 0,
     "amplitude times 1/sqrt(1 + a^2) a step, at every a"},
};

}  // namespace

const SchemeFacts& facts_of(Scheme scheme) { return table[static_cast<int>(scheme)]; }

}  // namespace percale
