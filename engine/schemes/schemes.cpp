#include "schemes.h"

#include <limits>
#include <numbers>
#include <string>

#include "percale/options.h"

namespace percale {
namespace {

constexpr double always = std::numeric_limits<double>::infinity();

constexpr SchemeFacts table[] = {
    {Scheme::forward_euler, "forward_euler", 1, false, false, 0.0, 1, 0,
     "amplitude times sqrt(1 + a^2) a step: grows at every a"},
    {Scheme::symplectic_euler, "symplectic_euler", 1, false, false, 2.0, 1, 0, "amplitude kept for a < 2, grows beyond"},
    {Scheme::midpoint, "midpoint", 2, false, false, 0.0, 2, 0,
     "amplitude times sqrt(1 + a^4/4) a step: grows, slowly for small a"},
    {Scheme::rk4, "rk4", 4, false, false, 2.8284271247461903, 4, 0, "damped for a < 2 sqrt 2, grows beyond"},
    {Scheme::backward_euler, "backward_euler", 1, true, true, always, 0, 1, "amplitude times 1/sqrt(1 + a^2) a step, at every a"},
    {Scheme::implicit_midpoint, "implicit_midpoint", 2, true, false, always, 0, 1,
     "amplitude kept at every a, angular momentum too; what is faster than the step rings on"},
    {Scheme::trapezoid, "trapezoid", 2, true, false, always, 0, 1,
     "amplitude kept at every a in linear systems; stiff cloth (a > 3) can gain energy"},
    {Scheme::bdf2, "bdf2", 2, true, false, always, 0, 1, "damped at every a, by a^4/4 a step where a is small"},
    {Scheme::tr_bdf2, "tr_bdf2", 2, true, true, always, 0, 2,
     "damped at every a, to nothing for large a; the accurate choice of adaptive steps"},
};

}  // namespace

std::span<const SchemeFacts> scheme_table() { return table; }

const SchemeFacts& facts_of(Scheme scheme) { return table[static_cast<int>(scheme)]; }

std::array<StageWeight, 3> stage_weights(Scheme scheme) {
    constexpr double w = std::numbers::sqrt2 / 4.0;
    switch (scheme) {
        case Scheme::trapezoid:
            return {{{0.5, 0.0}, {}, {0.5, 1.0}}};
        case Scheme::tr_bdf2:
            return {{{w, 0.0}, {w, trapezoid_fraction}, {1.0 - 2.0 * w, 1.0}}};
        case Scheme::backward_euler:
        case Scheme::bdf2:
            return {{{}, {}, {1.0, 1.0}}};
        default:
            return {{{}, {}, {1.0, 0.5}}};
    }
}

std::string scheme_table_text() {
    std::string text =
        "scheme             order  kind      contact  a step costs         oscillator of frequency w, a = w time_step\n";
    for (const SchemeFacts& facts : table) {
        const std::string cost =
            facts.implicit ? std::to_string(facts.stages) + (facts.stages == 1 ? " system" : " systems")
                           : std::to_string(facts.force_evaluations) + " evaluation" + (facts.force_evaluations == 1 ? "" : "s");
        char line[256];
        std::snprintf(line, sizeof line, "%-18s %-6d %-9s %-8s %-20s %s\n", std::string(facts.word).c_str(), facts.order,
                      facts.implicit ? "implicit" : "explicit", facts.contact ? "yes" : "no", cost.c_str(),
                      std::string(facts.stability).c_str());
        text += line;
    }
    return text;
}

}  // namespace percale
