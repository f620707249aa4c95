#pragma once

#include <optional>
#include <vector>

#include "report/plot_svg.h"
#include "study/study.h"

namespace percale::scenes {

/// The plot of a study: its measure, `values` of each run (nothing where there is none), over its key. The first other key that
/// varies makes a series for each of its values, the second a panel for each; of a key that is random, or has more than twelve
/// values, each of three ranges with as many runs. Axes are logarithmic where values are spread so, and the measure's where all
/// are above 0 and the largest is a hundred times the smallest. Points are joined where the runs are a grid of three keys at
/// most.
Plot study_plot(const Study& study, const std::vector<std::optional<double>>& values);

}  // namespace percale::scenes
