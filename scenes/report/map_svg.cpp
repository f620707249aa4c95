#include "report/map_svg.h"

#include <algorithm>
#include <cmath>

#include "report/svg_text.h"

namespace percale::scenes {

namespace {

// Pixels.
constexpr int columns = 3;
constexpr double map_left = 70.0, map_top = 60.0, panel_width = 250.0, panel_height = 230.0, panel_gap = 20.0,
                 heading_height = 22.0;
constexpr double legend_height = 70.0, axis_height = 45.0;

/// One axis of all panels: its values, from where its cells begin to where they end.
struct CellAxis {
    double lowest = 0.0, highest = 1.0;  // powers of ten
    double size = 1.0;                   // of a cell, likewise

    double share(double power) const { return (power - lowest) / (highest - lowest); }
};

CellAxis axis_of(std::vector<double> values) {
    for (double& value : values) value = std::log10(value);
    std::sort(values.begin(), values.end());
    if (values.empty()) return {};
    double size = 1.0;
    for (std::size_t k = 1; k < values.size(); ++k)
        if (values[k] - values[k - 1] > 1e-6) size = std::min(size, values[k] - values[k - 1]);
    return {values.front() - 0.5 * size, values.back() + 0.5 * size, size};
}

struct MapAxes {
    CellAxis x, y;
};

MapAxes axes_of(const ColourMap& map) {
    std::vector<double> x, y;
    for (const MapPanel& panel : map.panels) {
        for (const MapCell& cell : panel.cells) {
            x.push_back(cell.x);
            y.push_back(cell.y);
        }
    }
    return {axis_of(std::move(x)), axis_of(std::move(y))};
}

/// Where a panel's drawing begins, and values lie in it.
struct PanelPlace {
    const MapAxes& axes;
    double x0 = 0.0, y0 = 0.0;

    double x(double power) const { return x0 + panel_width * axes.x.share(power); }
    double y(double power) const { return y0 + panel_height * (1.0 - axes.y.share(power)); }
};

std::string cell_svg(const MapCell& cell, const ColourMap& map, const PanelPlace& place) {
    const double x = std::log10(cell.x), y = std::log10(cell.y);
    const double half_x = 0.5 * place.axes.x.size, half_y = 0.5 * place.axes.y.size;
    return "<rect" + svg_attribute("x", place.x(x - half_x)) + svg_attribute("y", place.y(y + half_y)) +
           svg_attribute("width", place.x(x + half_x) - place.x(x - half_x)) +
           svg_attribute("height", place.y(y - half_y) - place.y(y + half_y)) +
           svg_attribute("fill", map.legend[static_cast<std::size_t>(cell.colour)].colour) + "><title>" +
           svg_escaped(cell.label) + "</title></rect>\n";
}

bool is_inside(const PlotPoint& point, const MapAxes& axes) {
    if (!(point.x > 0.0 && point.y > 0.0)) return false;
    const double x = axes.x.share(std::log10(point.x)), y = axes.y.share(std::log10(point.y));
    return x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0;
}

std::string limit_svg(const MapPanel& panel, const PanelPlace& place) {
    std::string points;
    for (const PlotPoint& point : panel.limit) {
        if (!is_inside(point, place.axes)) continue;
        points += (points.empty() ? "" : " ") + svg_number(place.x(std::log10(point.x))) + "," +
                  svg_number(place.y(std::log10(point.y)));
    }
    if (points.empty()) return "";
    return "<polyline" + svg_attribute("points", points) + " fill=\"none\" stroke=\"black\" stroke-width=\"2\"/>\n";
}

std::string power_text(int power) { return "1e" + std::to_string(power); }

/// Whole powers of ten inside an axis, every second one where there are many.
std::vector<int> ticks(const CellAxis& axis) {
    std::vector<int> powers;
    const int first = static_cast<int>(std::ceil(axis.lowest)), last = static_cast<int>(std::floor(axis.highest));
    const int step = last - first > 5 ? 2 : 1;
    for (int power = first; power <= last; power += step) powers.push_back(power);
    return powers;
}

std::string ticks_svg(const PanelPlace& place, bool labelled_left, bool labelled_below) {
    std::string text;
    const double bottom = place.y0 + panel_height;
    for (const int power : ticks(place.axes.x)) {
        text += svg_line(place.x(power), bottom, place.x(power), bottom + 5.0, "stroke=\"#444444\"");
        if (labelled_below) text += svg_text(place.x(power), bottom + 20.0, "middle", power_text(power));
    }
    for (const int power : ticks(place.axes.y)) {
        text += svg_line(place.x0 - 5.0, place.y(power), place.x0, place.y(power), "stroke=\"#444444\"");
        if (labelled_left) text += svg_text(place.x0 - 8.0, place.y(power) + 4.5, "end", power_text(power));
    }
    return text;
}

std::string panel_svg(const MapPanel& panel, const ColourMap& map, const PanelPlace& place) {
    std::string text = svg_text(place.x0 + 0.5 * panel_width, place.y0 - 6.0, "middle", panel.name);
    text += "<g stroke=\"white\" stroke-width=\"0.5\">\n";
    for (const MapCell& cell : panel.cells) text += cell_svg(cell, map, place);
    text += "</g>\n";
    return text + limit_svg(panel, place) + "<rect" + svg_attribute("x", place.x0) + svg_attribute("y", place.y0) +
           svg_attribute("width", panel_width) + svg_attribute("height", panel_height) + " fill=\"none\" stroke=\"#444444\"/>\n";
}

std::string legend_svg(const ColourMap& map, double y) {
    std::string text;
    double x = map_left;
    for (const auto& [colour, name] : map.legend) {
        text += "<rect" + svg_attribute("x", x) + svg_attribute("y", y) + " width=\"16\" height=\"16\"" +
                svg_attribute("fill", colour) + "/>\n" + svg_text(x + 22.0, y + 13.0, "start", name);
        x += 44.0 + 7.5 * static_cast<double>(name.size());
    }
    if (map.limit_name.empty()) return text;
    return text + svg_line(map_left, y + 30.0, map_left + 16.0, y + 30.0, "stroke=\"black\" stroke-width=\"2\"") +
           svg_text(map_left + 22.0, y + 35.0, "start", map.limit_name);
}

}  // namespace

std::string map_svg(const ColourMap& map) {
    const MapAxes axes = axes_of(map);
    const int count = static_cast<int>(map.panels.size()), rows = std::max(1, (count + columns - 1) / columns);
    const double width = map_left + columns * (panel_width + panel_gap), row_height = panel_height + heading_height + panel_gap;
    const double bottom = map_top + heading_height + rows * row_height;
    std::string text = svg_opening(width, bottom + axis_height + legend_height, map.title);
    text += svg_text(0.5 * width, 28.0, "middle", map.title, " font-size=\"17\"");
    for (int k = 0; k < count; ++k) {
        const int row = k / columns, column = k % columns;
        const PanelPlace place{axes, map_left + column * (panel_width + panel_gap), map_top + heading_height + row * row_height};
        text += panel_svg(map.panels[static_cast<std::size_t>(k)], map, place);
        text += ticks_svg(place, column == 0, k + columns >= count);
    }
    text += svg_text(0.5 * width, bottom + 22.0, "middle", map.x_label);
    const double middle = 0.5 * (map_top + bottom);
    text += svg_text(20.0, middle, "middle", map.y_label, " transform=\"rotate(-90 20 " + svg_number(middle) + ")\"");
    return text + legend_svg(map, bottom + axis_height) + "</svg>\n";
}

}  // namespace percale::scenes
