#include "report/plot_svg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/text.h"
#include "report/svg_text.h"

namespace percale::scenes {

namespace {

/// In units of an axis: what is a whole decade or tick up to rounding gets no further one.
constexpr double axis_rounding = 1e-9;

/// The distance from which two cells of an axis are two.
constexpr double distinct_cells = 1e-6;

/// Ticks of a linear axis, at most and about.
constexpr double wanted_ticks = 5.0;

// Pixels. Heights are those of panels that stand one, two or three in a row.
constexpr double frame_left = 90.0, frame_top = 50.0, frame_width = 760.0, right_margin = 20.0, axis_height = 70.0;
constexpr double panel_gap = 35.0, heading_height = 22.0, tick_length = 5.0;
constexpr std::array<double, 3> panel_heights = {420.0, 320.0, 230.0};
constexpr double legend_line = 24.0, legend_text = 36.0, letter_width = 8.2, legend_margin = 8.0;

// Dark enough on white; the first seven can be distinguished with any colour vision (Okabe and Ito 2008), the others by their
// markers, too.
constexpr std::array<const char*, 12> series_colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#b8860b",
                                                        "#56b4e9", "#7b3294", "#a50026", "#666666", "#1b7837", "#e377c2"};

bool is_logarithmic(AxisScale scale) { return scale == AxisScale::logarithmic; }
bool has_place(double value, AxisScale scale) { return std::isfinite(value) && (!is_logarithmic(scale) || value > 0.0); }

struct Axes {
    PlotAxis x, y;

    bool hold(const PlotPoint& point) const { return x.holds(point.x) && y.holds(point.y); }
};

/// What all panels have in common.
struct PlotPage {
    const Plot& plot;
    std::vector<const PlotSeries*> legend;  // the first series of each name
    std::size_t panels = 1, columns = 1;
    PlotAxis x, y;  // places are those of a panel

    bool named() const { return !plot.panels.empty(); }
    double width() const { return (frame_width - panel_gap * static_cast<double>(columns - 1)) / static_cast<double>(columns); }
    double height() const { return panel_heights[columns - 1]; }
    double bottom() const { return axes((panels - 1) / columns * columns).y.from; }
    Axes axes(std::size_t panel) const {
        Axes at{x, y};
        const double heading = named() ? heading_height : 0.0;
        at.x.from = frame_left + static_cast<double>(panel % columns) * (width() + panel_gap);
        at.x.to = at.x.from + width();
        at.y.to = frame_top + heading + static_cast<double>(panel / columns) * (height() + heading + panel_gap);
        at.y.from = at.y.to + height();
        return at;
    }
    std::size_t kind_of(const PlotSeries& series) const {
        return static_cast<std::size_t>(std::ranges::find(legend, series.name, &PlotSeries::name) - legend.begin());
    }
    std::string colour_of(const PlotSeries& series) const {
        return series.colour.empty() ? series_colours[kind_of(series) % series_colours.size()] : series.colour;
    }
};

bool has_cells(const Plot& plot) {
    return std::ranges::find(plot.series, PlotMarks::cells, &PlotSeries::marks) != plot.series.end();
}

bool has_line(const PlotSeries& series) { return series.marks == PlotMarks::lines || series.marks == PlotMarks::curve; }
bool has_markers(const PlotSeries& series) { return series.marks == PlotMarks::lines || series.marks == PlotMarks::points; }

PlotPage page_of(const Plot& plot) {
    PlotPage page{.plot = plot, .legend = {}, .x = {}, .y = {}};
    page.panels = std::max<std::size_t>(1, plot.panels.size());
    page.columns = std::min(page.panels, panel_heights.size());
    std::vector<double> x, y;
    for (const PlotSeries& series : plot.series) {
        if (page.kind_of(series) == page.legend.size()) page.legend.push_back(&series);
        if (series.marks == PlotMarks::curve) continue;
        for (const PlotPoint& point : series.points) {
            if (!has_place(point.x, plot.x_scale) || !has_place(point.y, plot.y_scale)) continue;
            x.push_back(point.x);
            y.push_back(point.y);
        }
    }
    if (plot.floor != 0.0 && has_place(plot.floor, plot.y_scale)) y.push_back(plot.floor);
    page.x = has_cells(plot) ? axis_of_cells(plot.x_scale, x) : axis_around(plot.x_scale, x);
    page.y = has_cells(plot) ? axis_of_cells(plot.y_scale, y) : axis_around(plot.y_scale, y);
    return page;
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

std::string point_text(double x, double y) { return svg_number(x) + "," + svg_number(y); }

/// The first five kinds are filled, the next five hollow.
std::string marker(std::size_t kind, const std::string& colour, double x, double y, const std::string& label) {
    const std::string style = svg_attribute("fill", kind % 10 < 5 ? colour : "white") + svg_attribute("stroke", colour) +
                              " stroke-width=\"1.5\"><title>" + svg_escaped(label) + "</title>";
    const auto corners = marker_corners(kind);
    if (corners.empty())
        return "<circle" + svg_attribute("cx", x) + svg_attribute("cy", y) + svg_attribute("r", 4.5) + style + "</circle>\n";
    std::string points;
    for (const auto& [dx, dy] : corners) points += (points.empty() ? "" : " ") + point_text(x + dx, y + dy);
    return "<polygon" + svg_attribute("points", points) + style + "</polygon>\n";
}

std::string rectangle(double left, double top, double width, double height, const std::string& style) {
    return "<rect" + svg_attribute("x", left) + svg_attribute("y", top) + svg_attribute("width", width) +
           svg_attribute("height", height) + style;
}

struct AxisTick {
    double value = 0.0;
    std::string text = {};  // "": it has none
    bool whole = true;      // a power of ten, or any tick of a linear axis
};

std::vector<AxisTick> linear_axis_ticks(const PlotAxis& axis) {
    std::vector<AxisTick> ticks;
    const double lowest = std::ceil(axis.first / axis.step - axis_rounding),
                 highest = std::floor(axis.last / axis.step + axis_rounding);
    for (double k = lowest; k <= highest; ++k) ticks.push_back({k * axis.step, multiple_text(k * axis.step, axis.step)});
    return ticks;
}

/// The values 1 ... 9 in every decade. Powers of ten have a text, in a small panel with many of them every second; where there is
/// room so have 2 and 5.
std::vector<AxisTick> log_axis_ticks(const PlotAxis& axis, bool small) {
    const double decades = axis.last - axis.first;
    const int begin = static_cast<int>(std::ceil(axis.first - axis_rounding)), stride = small && decades > 5.0 ? 2 : 1;
    std::vector<AxisTick> ticks;
    for (int power = begin - 1; power <= axis.last; ++power) {
        for (int digit = 1; digit <= 9; ++digit) {
            const double at = power + std::log10(digit);
            if (at < axis.first - axis_rounding || at > axis.last + axis_rounding) continue;
            const bool room = decades <= 2.0 && !small && (digit == 2 || digit == 5);
            const bool labelled = digit == 1 ? (power - begin) % stride == 0 : room;
            const std::string text = std::to_string(digit) + "e" + std::to_string(power);
            ticks.push_back({digit * std::pow(10.0, power), labelled ? text : "", digit == 1});
        }
    }
    return ticks;
}

std::vector<AxisTick> ticks_of(const PlotAxis& axis, bool small) {
    return is_logarithmic(axis.scale) ? log_axis_ticks(axis, small) : linear_axis_ticks(axis);
}

/// Lines at the ticks of a panel; texts at the left of the first one in a row and below the last one in a column.
std::string grid_lines(const PlotPage& page, std::size_t panel) {
    const auto [x_axis, y_axis] = page.axes(panel);
    const bool small = page.columns > 1, left = panel % page.columns == 0, below = panel + page.columns >= page.panels;
    const auto style = [](const AxisTick& tick) { return tick.whole ? "stroke=\"#bbbbbb\"" : "stroke=\"#eeeeee\""; };
    std::string text;
    for (const AxisTick& tick : ticks_of(x_axis, small)) {
        const double x = x_axis.place(tick.value), end = y_axis.from + (tick.text.empty() ? 0.0 : tick_length);
        text += svg_line(x, y_axis.to, x, end, style(tick));
        if (below && !tick.text.empty()) text += svg_text(x, y_axis.from + 20.0, "middle", tick.text);
    }
    for (const AxisTick& tick : ticks_of(y_axis, small)) {
        const double y = y_axis.place(tick.value), begin = x_axis.from - (tick.text.empty() ? 0.0 : tick_length);
        text += svg_line(begin, y, x_axis.to, y, style(tick));
        if (left && !tick.text.empty()) text += svg_text(x_axis.from - 8.0, y + 4.5, "end", tick.text);
    }
    return text;
}

/// A cell about (x, y).
std::string cell_drawn(const Axes& axes, const std::string& colour, double x, double y, const std::string& label) {
    const auto size = [](const PlotAxis& axis) { return std::abs(axis.to - axis.from) * axis.step / (axis.last - axis.first); };
    const double width = size(axes.x), height = size(axes.y);
    return rectangle(x - 0.5 * width, y - 0.5 * height, width, height,
                     svg_attribute("fill", colour) + " stroke=\"white\" stroke-width=\"0.5\"><title>" + svg_escaped(label) +
                         "</title></rect>\n");
}

std::string series_drawn(const PlotPage& page, const PlotSeries& series) {
    const Axes axes = page.axes(series.panel);
    const std::string colour = page.colour_of(series);
    std::string places, marks;
    for (const PlotPoint& point : series.points) {
        if (!axes.hold(point)) continue;
        const double x = axes.x.place(point.x), y = axes.y.place(point.y);
        places += (places.empty() ? "" : " ") + point_text(x, y);
        if (series.marks == PlotMarks::cells) marks += cell_drawn(axes, colour, x, y, point.label);
        if (has_markers(series)) marks += marker(page.kind_of(series), colour, x, y, point.label);
    }
    if (!has_line(series) || places.empty()) return marks;
    return "<polyline" + svg_attribute("points", places) + " fill=\"none\" stroke-width=\"2\"" + svg_attribute("stroke", colour) +
           "/>\n" + marks;
}

/// A name of the legend with its mark, its left end at x.
std::string legend_entry(const PlotPage& page, const PlotSeries& series, double x, double y) {
    const std::string colour = page.colour_of(series);
    std::string text;
    if (has_line(series)) text += svg_line(x, y, x + 28.0, y, "stroke-width=\"2\"" + svg_attribute("stroke", colour));
    if (has_markers(series)) text += marker(page.kind_of(series), colour, x + 14.0, y, series.name);
    if (series.marks == PlotMarks::cells) text += rectangle(x + 6.0, y - 8.0, 16.0, 16.0, svg_attribute("fill", colour) + "/>\n");
    return text + svg_text(x + legend_text, y + 4.5, "start", series.name);
}

struct DrawnLegend {
    std::string svg = {};
    double height = 0.0;  // below the diagram
};

double entry_width(const PlotSeries& series) { return legend_text + letter_width * static_cast<double>(series.name.size()); }

/// Names side by side, in as many lines as they need.
DrawnLegend legend_below(const PlotPage& page, const std::vector<const PlotSeries*>& entries) {
    DrawnLegend legend;
    double x = frame_left, y = page.bottom() + axis_height + 0.5 * legend_line;
    for (const PlotSeries* series : entries) {
        if (x > frame_left && x + entry_width(*series) > frame_left + frame_width) {
            x = frame_left;
            y += legend_line;
        }
        legend.svg += legend_entry(page, *series, x, y);
        x += entry_width(*series) + panel_gap;
    }
    legend.height = y + 0.5 * legend_line + legend_margin - page.bottom() - axis_height;
    return legend;
}

/// A corner of a panel for a box.
struct LegendCorner {
    double left = 0.0, top = 0.0;
    int hidden = 0;  // points
};

LegendCorner corner_for(const PlotPage& page, std::size_t panel, int number, double width, double height) {
    const Axes axes = page.axes(panel);
    LegendCorner corner{.left = number % 2 == 0 ? axes.x.to - width - legend_margin : axes.x.from + legend_margin,
                        .top = number < 2 ? axes.y.to + legend_margin : axes.y.from - height - legend_margin};
    for (const PlotSeries& series : page.plot.series) {
        if (series.panel != panel) continue;
        for (const PlotPoint& point : series.points) {
            if (!axes.hold(point)) continue;
            const double x = axes.x.place(point.x) - corner.left, y = axes.y.place(point.y) - corner.top;
            corner.hidden += x >= 0.0 && x <= width && y >= 0.0 && y <= height ? 1 : 0;
        }
    }
    return corner;
}

DrawnLegend legend_of(const PlotPage& page) {
    std::vector<const PlotSeries*> entries = page.legend;
    std::erase_if(entries, [](const PlotSeries* series) { return series->name.empty(); });
    if (entries.empty()) return {};
    double width = 0.0;
    for (const PlotSeries* series : entries) width = std::max(width, entry_width(*series) + 2.0 * legend_margin);
    const double height = legend_line * static_cast<double>(entries.size());
    const bool room = width + 2.0 * legend_margin <= page.width() && height + 2.0 * legend_margin <= page.height();
    if (!room || has_cells(page.plot)) return legend_below(page, entries);
    LegendCorner best = corner_for(page, 0, 0, width, height);
    for (std::size_t panel = 0; panel < page.panels; ++panel)
        for (int number = 0; number < 4; ++number)
            if (const LegendCorner corner = corner_for(page, panel, number, width, height); corner.hidden < best.hidden)
                best = corner;
    DrawnLegend legend{
        .svg = rectangle(best.left, best.top, width, height, " fill=\"white\" fill-opacity=\"0.85\" stroke=\"#bbbbbb\"/>\n")};
    for (std::size_t k = 0; k < entries.size(); ++k)
        legend.svg +=
            legend_entry(page, *entries[k], best.left + legend_margin, best.top + legend_line * (static_cast<double>(k) + 0.5));
    return legend;
}

/// The frame of a panel with its name, and the floor.
std::string panel_frame(const PlotPage& page, std::size_t panel) {
    const auto [x, y] = page.axes(panel);
    std::string text = rectangle(x.from, y.to, x.to - x.from, y.from - y.to, " fill=\"none\" stroke=\"#444444\"/>\n");
    if (page.named()) text += svg_text(0.5 * (x.from + x.to), y.to - 6.0, "middle", page.plot.panels[panel]);
    if (page.plot.floor == 0.0 || !has_place(page.plot.floor, page.plot.y_scale)) return text;
    const double floor = y.place(page.plot.floor);
    return text + svg_line(x.from, floor, x.to, floor, "stroke=\"#444444\" stroke-dasharray=\"6 4\"") +
           svg_text(x.to - 6.0, floor - 6.0, "end", page.plot.floor_label);
}

std::string plot_labels(const PlotPage& page) {
    const double across = frame_left + 0.5 * frame_width, middle = 0.5 * (frame_top + page.bottom());
    return svg_text(across, 30.0, "middle", page.plot.title, " font-size=\"17\"") +
           svg_text(across, page.bottom() + 48.0, "middle", page.plot.x_label) +
           svg_text(24.0, middle, "middle", page.plot.y_label, " transform=\"rotate(-90 24 " + svg_number(middle) + ")\"");
}

}  // namespace

double PlotAxis::place(double value) const {
    return from + (to - from) * ((is_logarithmic(scale) ? std::log10(value) : value) - first) / (last - first);
}

bool PlotAxis::holds(double value) const {
    const double at = has_place(value, scale) ? (place(value) - from) / (to - from) : -1.0;
    return at >= -axis_rounding && at <= 1.0 + axis_rounding;
}

PlotAxis axis_around(AxisScale scale, const std::vector<double>& values) {
    PlotAxis axis{.scale = scale};
    if (values.empty()) return axis;
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    const double low = is_logarithmic(scale) ? std::log10(*min) : *min, high = is_logarithmic(scale) ? std::log10(*max) : *max;
    // A single value, and values that differ by rounding, have a range of their size.
    const bool differ = high - low > axis_rounding * std::max(std::abs(low), std::abs(high));
    const double range = differ ? high - low : std::max(1e-3, std::abs(low));
    axis.step = is_logarithmic(scale) ? 1.0 : round_step(range / wanted_ticks);
    axis.first = axis.step * std::floor(low / axis.step + axis_rounding);
    axis.last = std::max(axis.step * std::ceil(high / axis.step - axis_rounding), axis.first + axis.step);
    return axis;
}

PlotAxis axis_of_cells(AxisScale scale, std::vector<double> values) {
    PlotAxis axis{.scale = scale};
    if (values.empty()) return axis;
    for (double& value : values) value = is_logarithmic(scale) ? std::log10(value) : value;
    std::ranges::sort(values);
    for (std::size_t k = 1; k < values.size(); ++k)
        if (const double apart = values[k] - values[k - 1]; apart > distinct_cells) axis.step = std::min(axis.step, apart);
    axis.first = values.front() - 0.5 * axis.step;
    axis.last = values.back() + 0.5 * axis.step;
    return axis;
}

std::string plot_svg(const Plot& plot) {
    const PlotPage page = page_of(plot);
    const DrawnLegend legend = legend_of(page);
    const double width = frame_left + frame_width + right_margin, height = page.bottom() + axis_height + legend.height;
    std::string text = svg_opening(width, height, plot.title) + plot_labels(page);
    for (std::size_t panel = 0; panel < page.panels; ++panel) text += grid_lines(page, panel) + panel_frame(page, panel);
    for (const PlotSeries& series : plot.series) text += series_drawn(page, series);
    return text + legend.svg + "</svg>\n";
}

}  // namespace percale::scenes
