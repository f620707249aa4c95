#pragma once

#include <string>
#include <vector>

#include "report/plot_svg.h"

// Maps: coloured cells over two logarithmic axes, one panel beside the other.
namespace percale::scenes {

struct MapCell {
    double x = 0.0, y = 0.0;  // > 0, the middle of the cell
    int colour = 0;           // number of the legend's entry
    std::string label = {};   // shown by viewers that show titles
};

struct MapPanel {
    std::string name = {};
    std::vector<MapCell> cells = {};
    std::vector<PlotPoint> limit = {};  // a line over the cells; may be empty
};

struct ColourName {
    std::string colour, name;  // as in SVG, and in the legend
};

/// All panels have the same axes.
struct ColourMap {
    std::string title = {}, x_label = {}, y_label = {};  // labels with their units
    std::vector<ColourName> legend = {};
    std::string limit_name = {};  // of the lines, in the legend; none if empty
    std::vector<MapPanel> panels = {};
};

/// Three panels a row, cells as large as the smallest distance between places on an axis. A well-formed SVG document; the same
/// bytes for the same map.
std::string map_svg(const ColourMap& map);

}  // namespace percale::scenes
