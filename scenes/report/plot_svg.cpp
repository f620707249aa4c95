#include "report/plot_svg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/svg_text.h"

namespace percale::scenes {

namespace {

/// In the logarithm: a number that is a power of ten up to rounding gets no further decade in a plot.
constexpr double decade_rounding = 1e-9;

constexpr double plot_width = 860.0, plot_height = 540.0;  // pixels
constexpr double plot_left = 90.0, plot_right = 640.0, plot_top = 50.0, plot_bottom = 470.0;
constexpr double legend_left = 660.0, legend_line = 24.0;

// Dark enough on white; the first seven can be distinguished with any colour vision (Okabe and Ito 2008), the others by their
// markers, too.
constexpr std::array<const char*, 12> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#b8860b",
                                                 "#56b4e9", "#7b3294", "#a50026", "#666666", "#1b7837", "#e377c2"};

/// Corners of a marker about (0, 0), pixels; empty: a circle.
std::vector<std::array<double, 2>> marker_corners(std::size_t kind) {
    switch (kind % 5) {
        case 1:
            return {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};
        case 2:
            return {{0, -5.5}, {5, 4}, {-5, 4}};
        case 3:
            return {{0, -6}, {6, 0}, {0, 6}, {-6, 0}};
        case 4:
            return {{0, 5.5}, {5, -4}, {-5, -4}};
        default:
            return {};
    }
}

/// The first five kinds are filled, the next five hollow.
std::string marker(std::size_t kind, double x, double y, const std::string& label) {
    const std::string colour = colours[kind % colours.size()];
    const std::string style = svg_attribute("fill", kind % 10 < 5 ? colour : "white") + svg_attribute("stroke", colour) +
                              " stroke-width=\"1.5\"><title>" + svg_escaped(label) + "</title>";
    const auto corners = marker_corners(kind);
    if (corners.empty())
        return "<circle" + svg_attribute("cx", x) + svg_attribute("cy", y) + svg_attribute("r", 4.5) + style + "</circle>\n";
    std::string points;
    for (const auto& [dx, dy] : corners) points += (points.empty() ? "" : " ") + svg_number(x + dx) + "," + svg_number(y + dy);
    return "<polygon" + svg_attribute("points", points) + style + "</polygon>\n";
}

bool has_place(double value) { return std::isfinite(value) && value > 0.0; }
bool has_place(const PlotPoint& point) { return has_place(point.x) && has_place(point.y); }

/// Where a plot's values lie on the page.
struct Axes {
    LogAxis x, y;
};

Axes axes_of(const Plot& plot) {
    std::vector<double> x, y;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& point : series.points) {
            if (!has_place(point)) continue;
            x.push_back(point.x);
            y.push_back(point.y);
        }
    }
    if (has_place(plot.floor)) y.push_back(plot.floor);
    return {axis_around(x, plot_left, plot_right), axis_around(y, plot_bottom, plot_top)};
}

/// Values within a decade that have a label: all that fit.
bool is_labelled(int digit, const LogAxis& axis) {
    const int decades = axis.last - axis.first;
    return digit == 1 || (decades <= 2 && (digit == 2 || digit == 5));
}

constexpr const char* thin = "stroke=\"#eeeeee\"";
constexpr const char* thick = "stroke=\"#bbbbbb\"";

std::string tick_text(int digit, int power) { return std::to_string(digit) + "e" + std::to_string(power); }

/// Calls visit(place, digit, power) for each of the values 1 ... 9 in every decade, the last end included.
template <class Visit>
void for_ticks(const LogAxis& axis, Visit visit) {
    for (int power = axis.first; power <= axis.last; ++power)
        for (int digit = 1; digit <= (power < axis.last ? 9 : 1); ++digit)
            visit(axis.place(digit * std::pow(10.0, power)), digit, power);
}

std::string grid(const Axes& axes) {
    std::string text;
    for_ticks(axes.x, [&](double x, int digit, int power) {
        text += svg_line(x, plot_top, x, plot_bottom, digit == 1 ? thick : thin);
        if (is_labelled(digit, axes.x)) text += svg_text(x, plot_bottom + 20.0, "middle", tick_text(digit, power));
    });
    for_ticks(axes.y, [&](double y, int digit, int power) {
        text += svg_line(plot_left, y, plot_right, y, digit == 1 ? thick : thin);
        if (is_labelled(digit, axes.y)) text += svg_text(plot_left - 8.0, y + 4.5, "end", tick_text(digit, power));
    });
    return text;
}

std::string frame_and_labels(const Plot& plot) {
    const double middle = 0.5 * (plot_top + plot_bottom);
    std::string text = "<rect" + svg_attribute("x", plot_left) + svg_attribute("y", plot_top) +
                       svg_attribute("width", plot_right - plot_left) + svg_attribute("height", plot_bottom - plot_top) +
                       " fill=\"none\" stroke=\"#444444\"/>\n";
    text += svg_text(0.5 * (plot_left + plot_right), 30.0, "middle", plot.title, " font-size=\"17\"");
    text += svg_text(0.5 * (plot_left + plot_right), plot_bottom + 48.0, "middle", plot.x_label);
    const std::string turned = " transform=\"rotate(-90 24 " + svg_number(middle) + ")\"";
    return text + svg_text(24.0, middle, "middle", plot.y_label, turned);
}

std::string floor_line(const Plot& plot, const Axes& axes) {
    if (!has_place(plot.floor)) return "";
    const double y = axes.y.place(plot.floor);
    return svg_line(plot_left, y, plot_right, y, "stroke=\"#444444\" stroke-dasharray=\"6 4\"") +
           svg_text(plot_right - 6.0, y - 6.0, "end", plot.floor_label);
}

std::string curve(const PlotSeries& series, std::size_t kind, const Axes& axes) {
    std::string places, markers;
    for (const PlotPoint& point : series.points) {
        if (!has_place(point)) continue;
        const double x = axes.x.place(point.x), y = axes.y.place(point.y);
        places += (places.empty() ? "" : " ") + svg_number(x) + "," + svg_number(y);
        markers += marker(kind, x, y, point.label);
    }
    return "<polyline" + svg_attribute("points", places) + " fill=\"none\" stroke-width=\"2\"" +
           svg_attribute("stroke", std::string(colours[kind % colours.size()])) + "/>\n" + markers;
}

std::string legend_entry(const PlotSeries& series, std::size_t kind) {
    const double y = plot_top + 12.0 + legend_line * static_cast<double>(kind);
    return svg_line(legend_left, y, legend_left + 28.0, y,
                    "stroke-width=\"2\"" + svg_attribute("stroke", std::string(colours[kind % colours.size()]))) +
           marker(kind, legend_left + 14.0, y, series.name) + svg_text(legend_left + 36.0, y + 4.5, "start", series.name);
}

}  // namespace

double LogAxis::place(double value) const {
    return from + (to - from) * (std::log10(value) - first) / static_cast<double>(last - first);
}

LogAxis axis_around(const std::vector<double>& values, double from, double to) {
    if (values.empty()) return {0, 1, from, to};
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    // Rounding of the logarithm must not open another decade.
    const int first = static_cast<int>(std::floor(std::log10(*min) + decade_rounding));
    const int last = static_cast<int>(std::ceil(std::log10(*max) - decade_rounding));
    return {first, std::max(last, first + 1), from, to};
}

std::string plot_svg(const Plot& plot) {
    const Axes axes = axes_of(plot);
    std::string text = svg_opening(plot_width, plot_height, plot.title);
    text += grid(axes) + frame_and_labels(plot) + floor_line(plot, axes);
    for (std::size_t k = 0; k < plot.series.size(); ++k) text += curve(plot.series[k], k, axes);
    for (std::size_t k = 0; k < plot.series.size(); ++k) text += legend_entry(plot.series[k], k);
    return text + "</svg>\n";
}

}  // namespace percale::scenes
