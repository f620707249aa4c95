#pragma once

#include <span>
#include <string_view>

#include "percale/settings.h"

namespace percale {

/// What is known of a scheme. Oscillator of angular frequency w, a = w dt.
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

/// Of any scheme but `automatic`.
const SchemeFacts& facts_of(Scheme scheme);

}  // namespace percale
