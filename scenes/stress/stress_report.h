#pragma once

#include <string>

#include "report/plot_svg.h"
#include "stress/stress.h"

// What a run under stress says: as text, as a table for programs, as a map.
namespace percale::scenes {

/// How often each scheme got each verdict, one aligned line a scheme.
std::string stress_summary(const StressRun& run);

/// One line for each of the first rows that failed, with what happened and its number for --cell; empty without any.
std::string stress_failures(const StressRun& run, int at_most);

/// One line a row with all figures, fractions of energy as StressFigures has them.
std::string stress_csv(const StressRun& run);

/// One panel a scheme, time step against stiffness: of the default matrix its base sweep, with the limit of explicit schemes.
Plot stress_map(const StressRun& run);

}  // namespace percale::scenes
