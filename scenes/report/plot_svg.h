#pragma once

#include <string>
#include <vector>

// A diagram with logarithmic axes as an SVG file.
namespace percale::scenes {

struct PlotPoint {
    double x = 0.0, y = 0.0;
    std::string label = {};  // shown by viewers that show titles; may be empty
};

/// Points joined in their order by a line; what is not positive and finite is left out, as it has no place on the axes.
struct PlotSeries {
    std::string name = {};  // in the legend
    std::vector<PlotPoint> points = {};
};

struct Plot {
    std::string title = {}, x_label = {}, y_label = {};  // labels with their units
    std::vector<PlotSeries> series = {};                 // each in a colour of its own, twelve of them, and with a marker
    double floor = 0.0;                                  // a dashed line at this y; none if 0
    std::string floor_label = {};
};

/// A range of a logarithmic axis and where it is drawn, in pixels.
struct LogAxis {
    int first = 0, last = 1;  // powers of ten at its ends
    double from = 0.0, to = 1.0;

    /// Where a value > 0 lies.
    double place(double value) const;
};

/// The smallest range of whole decades that holds all values (positive, finite); 0 ... 1 without any.
LogAxis axis_around(const std::vector<double>& values, double from, double to);

/// The diagram as a well-formed SVG document; the same bytes for the same plot.
std::string plot_svg(const Plot& plot);

}  // namespace percale::scenes
