#pragma once

#include <string>
#include <vector>

#include "compare/compare.h"
#include "report/plot_svg.h"

// What a comparison says: as text, as a table for programs, as a diagram.
namespace percale::scenes {

/// What is compared with what, and how well the reference is known.
std::string reference_text(const Reference& reference);

/// One aligned line a run under a line of headings. An error that the reference cannot distinguish from 0 is written as "< its
/// uncertainty".
std::string comparison_table(const Comparison& comparison);

/// The same for programs, with all errors. The reference comes first, and its errors are its uncertainty. What was not measured
/// is empty.
std::string comparison_csv(const Comparison& comparison);

/// The cheapest run whose error is certainly at most `largest_error` m (the uncertainty of the reference added); null: none.
const ComparedRun* cheapest_within(const Comparison& comparison, double largest_error);

/// "for an error of 1e-3 m use rk4 at 1/3840 s (0.08 CPU s)", one for each choice, from 0.1 m downwards in decades.
std::vector<std::string> advice(const Comparison& comparison);

/// Error in m against CPU s, one line a scheme (adaptive steps a line of their own), runs that finished only.
Plot comparison_plot(const Comparison& comparison);

}  // namespace percale::scenes
