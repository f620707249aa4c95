#include "report/plot_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace percale::scenes {

namespace {

constexpr double width = 860.0, height = 540.0;  // pixels
constexpr double left = 90.0, right = 640.0, top = 50.0, bottom = 470.0;
constexpr double legend_left = 660.0, legend_line = 24.0;

// Dark enough on white; the first seven told apart with any colour vision (Okabe and Ito 2008), the others by their markers, too.
constexpr std::array<const char*, 12> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#b8860b",
                                                 "#56b4e9", "#7b3294", "#a50026", "#666666", "#1b7837", "#e377c2"};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

/// Text for XML; control characters, which it cannot hold, as question marks.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        if (letter == '&')
            result += "&amp;";
        else if (letter == '<')
            result += "&lt;";
        else if (letter == '>')
            result += "&gt;";
        else if (letter == '"')
            result += "&quot;";
        else
            result += static_cast<unsigned char>(letter) < 0x20 ? '?' : letter;
    }
    return result;
}

std::string attribute(const char* name, double value) { return std::string(" ") + name + "=\"" + number(value) + "\""; }
std::string attribute(const char* name, const std::string& value) { return std::string(" ") + name + "=\"" + value + "\""; }

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
    return "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) + attribute("y2", y2) + " " + style + "/>\n";
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const std::string& more = "") {
    return "<text" + attribute("x", x) + attribute("y", y) + attribute("text-anchor", anchor) + more + ">" + escaped(text) +
           "</text>\n";
}

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
    const std::string style = attribute("fill", kind % 10 < 5 ? colour : "white") + attribute("stroke", colour) +
                              " stroke-width=\"1.5\"><title>" + escaped(label) + "</title>";
    const auto corners = marker_corners(kind);
    if (corners.empty()) return "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", 4.5) + style + "</circle>\n";
    std::string points;
    for (const auto& [dx, dy] : corners) points += (points.empty() ? "" : " ") + number(x + dx) + "," + number(y + dy);
    return "<polygon" + attribute("points", points) + style + "</polygon>\n";
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
    return {axis_around(x, left, right), axis_around(y, bottom, top)};
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
        text += line(x, top, x, bottom, digit == 1 ? thick : thin);
        if (is_labelled(digit, axes.x)) text += text_at(x, bottom + 20.0, "middle", tick_text(digit, power));
    });
    for_ticks(axes.y, [&](double y, int digit, int power) {
        text += line(left, y, right, y, digit == 1 ? thick : thin);
        if (is_labelled(digit, axes.y)) text += text_at(left - 8.0, y + 4.5, "end", tick_text(digit, power));
    });
    return text;
}

std::string frame_and_labels(const Plot& plot) {
    const double middle = 0.5 * (top + bottom);
    std::string text = "<rect" + attribute("x", left) + attribute("y", top) + attribute("width", right - left) +
                       attribute("height", bottom - top) + " fill=\"none\" stroke=\"#444444\"/>\n";
    text += text_at(0.5 * (left + right), 30.0, "middle", plot.title, " font-size=\"17\"");
    text += text_at(0.5 * (left + right), bottom + 48.0, "middle", plot.x_label);
    const std::string turned = " transform=\"rotate(-90 24 " + number(middle) + ")\"";
    return text + text_at(24.0, middle, "middle", plot.y_label, turned);
}

std::string floor_line(const Plot& plot, const Axes& axes) {
    if (!has_place(plot.floor)) return "";
    const double y = axes.y.place(plot.floor);
    return line(left, y, right, y, "stroke=\"#444444\" stroke-dasharray=\"6 4\"") +
           text_at(right - 6.0, y - 6.0, "end", plot.floor_label);
}

std::string curve(const PlotSeries& series, std::size_t kind, const Axes& axes) {
    std::string places, markers;
    for (const PlotPoint& point : series.points) {
        if (!has_place(point)) continue;
        const double x = axes.x.place(point.x), y = axes.y.place(point.y);
        places += (places.empty() ? "" : " ") + number(x) + "," + number(y);
        markers += marker(kind, x, y, point.label);
    }
    return "<polyline" + attribute("points", places) + " fill=\"none\" stroke-width=\"2\"" +
           attribute("stroke", std::string(colours[kind % colours.size()])) + "/>\n" + markers;
}

std::string legend_entry(const PlotSeries& series, std::size_t kind) {
    const double y = top + 12.0 + legend_line * static_cast<double>(kind);
    return line(legend_left, y, legend_left + 28.0, y,
                "stroke-width=\"2\"" + attribute("stroke", std::string(colours[kind % colours.size()]))) +
           marker(kind, legend_left + 14.0, y, series.name) + text_at(legend_left + 36.0, y + 4.5, "start", series.name);
}

}  // namespace

double LogAxis::place(double value) const {
    return from + (to - from) * (std::log10(value) - first) / static_cast<double>(last - first);
}

LogAxis axis_around(const std::vector<double>& values, double from, double to) {
    if (values.empty()) return {0, 1, from, to};
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    // Rounding of the logarithm must not open another decade.
    const int first = static_cast<int>(std::floor(std::log10(*least) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(*most) - 1e-9));
    return {first, std::max(last, first + 1), from, to};
}

std::string plot_svg(const Plot& plot) {
    const Axes axes = axes_of(plot);
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"" +
                       attribute("width", width) + attribute("height", height) + " viewBox=\"0 0 " + number(width) + " " +
                       number(height) + "\" font-family=\"sans-serif\" font-size=\"14\">\n<title>" + escaped(plot.title) +
                       "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    text += grid(axes) + frame_and_labels(plot) + floor_line(plot, axes);
    for (std::size_t k = 0; k < plot.series.size(); ++k) text += curve(plot.series[k], k, axes);
    for (std::size_t k = 0; k < plot.series.size(); ++k) text += legend_entry(plot.series[k], k);
    return text + "</svg>\n";
}

}  // namespace percale::scenes
