#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string_view>

#include "percale/settings.h"

namespace percale {

/// Properties of a scheme. Oscillator of angular frequency w, a = w dt.
struct SchemeFacts {
    Scheme scheme;
    std::string_view word;  // as in a scene file
    int order;              // of the error in dt
    bool implicit;
    bool contact;                // takes obstacles and self_contact
    double stable_up_to;         // largest a without growth; infinity for unconditionally stable schemes, 0 where all grows
    int force_evaluations;       // a step; 0 = as many as Newton needs
    int stages;                  // nonlinear systems a step, of an implicit scheme
    std::string_view stability;  // one sentence
};

/// One entry a scheme, in the order of the enum, without `automatic`.
std::span<const SchemeFacts> scheme_table();

/// Facts of any scheme but `automatic`.
const SchemeFacts& facts_of(Scheme scheme);

/// TR-BDF2 (Bank et al. 1985; Hosea and Shampine 1996): with this fraction for the trapezoid both stages have the same h.
constexpr double trapezoid_fraction = 2.0 - std::numbers::sqrt2;

/// Where a scheme evaluates forces: their weight, and the time as a fraction of the substep.
struct StageWeight {
    double weight = 0.0, place = 1.0;
};

/// The stages of a step of the scheme, at its start, between, and last. Explicit schemes keep the rest lengths of seams at their
/// values in the middle of the step, which is of second order.
std::array<StageWeight, 3> stage_weights(Scheme scheme);

}  // namespace percale
