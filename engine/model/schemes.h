#pragma once

#include <string_view>

#include "percale/settings.h"

namespace percale {

/// What is known of a scheme. Oscillator of angular frequency w, a = w dt.
struct SchemeFacts {
    Scheme scheme;
    std::string_view word;  // as in a scene file
    int order;              // of the error in dt
    bool implicit;
    double stable_up_to;         // largest a without growth; infinity for unconditionally stable schemes
    int force_evaluations;       // a step; 0 = as many as Newton needs
    std::string_view stability;  // one sentence
};

const SchemeFacts& facts_of(Scheme scheme);

}  // namespace percale
