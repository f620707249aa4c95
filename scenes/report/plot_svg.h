#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Diagrams as SVG files: lines, points or coloured cells over logarithmic or linear axes, in one panel or in several.
namespace percale::scenes {

struct PlotPoint {
    double x = 0.0, y = 0.0;
    std::string label = {};  // shown by viewers that show titles; may be empty
};

enum class AxisScale { logarithmic, linear };

/// lines: markers, joined in their order; points: markers alone; curve: the line alone, which no axis makes room for; cells: as
/// large as the smallest distance between places on an axis.
enum class PlotMarks { lines, points, curve, cells };

/// What has no place on an axis (not finite; on a logarithmic one not above 0) is left out.
struct PlotSeries {
    std::string name = {};  // in the legend, where series of one name stand once; "": it is not there
    std::vector<PlotPoint> points = {};
    std::size_t panel = 0;
    PlotMarks marks = PlotMarks::lines;
    std::string colour = {};  // as SVG has it; "": one of twelve, one a name
};

/// All panels have the same axes.
struct Plot {
    std::string title = {}, x_label = {}, y_label = {};  // labels with their units
    std::vector<PlotSeries> series = {};
    double floor = 0.0;  // a dashed line at this y; none if 0
    std::string floor_label = {};
    AxisScale x_scale = AxisScale::logarithmic, y_scale = AxisScale::logarithmic;
    std::vector<std::string> panels = {};  // their names, up to three a row; empty: one without a name
};

/// The range of an axis and where it is drawn, in pixels.
struct PlotAxis {
    AxisScale scale = AxisScale::logarithmic;
    double first = 0.0, last = 1.0;  // at its ends: values, or on a logarithmic axis powers of ten
    double step = 1.0;               // likewise: between ticks of a linear axis, and the size of a cell
    double from = 0.0, to = 1.0;

    /// Where a value lies; on a logarithmic axis it must be above 0.
    double place(double value) const;
    /// Whether it has a place between the ends.
    bool holds(double value) const;
};

/// The smallest range of whole decades, or of whole ticks, that holds all values, which must have a place; 0 ... 1 without any.
PlotAxis axis_around(AxisScale scale, const std::vector<double>& values);

/// The range that cells about these values fill.
PlotAxis axis_of_cells(AxisScale scale, std::vector<double> values);

/// The diagram as a well-formed SVG document; the same bytes for the same plot. The legend stands inside a frame, where it hides
/// the fewest points; below all where it finds no room, or cells would be hidden.
std::string plot_svg(const Plot& plot);

}  // namespace percale::scenes
