#include "scenes/report/plot_svg.h"

#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace percale::scenes::plot_svg_test {
namespace {

Plot two_lines() {
    return {.title = "a <b> & \"c\"",
            .x_label = "CPU time, s",
            .y_label = "error, m",
            .series = {{"first", {{0.01, 1e-2, "one"}, {0.1, 1e-4, "two"}}}, {"second", {{0.05, 1e-3, "three"}}}},
            .floor = 1e-5,
            .floor_label = "reference"};
}

/// Names of elements still open at the end or closed wrongly; empty for a well-formed document.
std::vector<std::string> unbalanced(const std::string& xml) {
    static const std::regex tag("<(/?)([a-z]+)((?:\"[^\"]*\"|[^\">])*?)(/?)>");
    std::vector<std::string> open;
    for (std::sregex_iterator it(xml.begin(), xml.end(), tag), end; it != end; ++it) {
        if ((*it)[1].length() == 0 && (*it)[4].length() == 0) open.push_back((*it)[2]);
        if ((*it)[1].length() == 0) continue;
        if (open.empty() || open.back() != (*it)[2]) return {"/" + (*it)[2].str()};
        open.pop_back();
    }
    return open;
}

std::vector<double> numbers_in(const std::string& text, const std::string& attribute) {
    const std::regex wanted("[ ]" + attribute + "=\"(-?[0-9.]+)\"");
    std::vector<double> values;
    for (std::sregex_iterator it(text.begin(), text.end(), wanted), end; it != end; ++it) values.push_back(std::stod((*it)[1]));
    return values;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

PlotAxis placed(PlotAxis axis) {
    axis.from = 100.0;
    axis.to = 600.0;
    return axis;
}

int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

constexpr AxisScale logarithmic = AxisScale::logarithmic, linear = AxisScale::linear;

/// Four panels of 2 x 2 cells in two colours, with a curve that leaves them.
Plot map_of_cells() {
    Plot plot{.title = "map", .x_label = "x, s", .y_label = "y, m", .panels = {"a & b", "c", "d", "e"}};
    for (std::size_t panel = 0; panel < 4; ++panel) {
        PlotSeries low{.name = "low", .panel = panel, .marks = PlotMarks::cells, .colour = "#111111"}, high = low;
        high.name = "high";
        high.colour = "#222222";
        for (const double x : {1e-3, 1e-2}) {
            low.points.push_back({x, 1.0, "cell"});
            high.points.push_back({x, 10.0, "cell"});
        }
        plot.series.push_back(low);
        plot.series.push_back(high);
        plot.series.push_back({.name = "limit",
                               .points = {{1e-3, 10.0}, {1e-2, 1.0}, {1e5, 1.0}},
                               .panel = panel,
                               .marks = PlotMarks::curve,
                               .colour = "black"});
    }
    return plot;
}

}  // namespace

TEST_CASE("A logarithmic axis puts its ends where they belong and equal ratios at equal distances") {
    const PlotAxis axis = placed(axis_around(logarithmic, {3e-4, 0.02, 5.0}));
    CHECK(axis.first == -4.0);
    CHECK(axis.last == 1.0);
    CHECK(std::abs(axis.place(1e-4) - 100.0) < 1e-9);
    CHECK(std::abs(axis.place(10.0) - 600.0) < 1e-9);
    CHECK(std::abs((axis.place(2.0) - axis.place(1.0)) - (axis.place(0.02) - axis.place(0.01))) < 1e-9);
    CHECK(axis.place(1.0) > axis.place(0.9));
}

TEST_CASE("A power of ten opens no decade of its own") {
    const PlotAxis axis = axis_around(logarithmic, {1e-3, 1e-1});
    CHECK(axis.first == -3.0);
    CHECK(axis.last == -1.0);
    const PlotAxis one = axis_around(logarithmic, {1e-3});
    CHECK(one.first == -3.0);
    CHECK(one.last == -2.0);
    CHECK(axis_around(logarithmic, {}).last > axis_around(logarithmic, {}).first);
}

TEST_CASE("A linear axis ends at whole ticks, puts equal differences at equal distances, and holds 0 and what is below") {
    const PlotAxis axis = placed(axis_around(linear, {0.1, 0.35, 0.9}));
    CHECK(axis.first == Approx(0.0).margin(1e-12));
    CHECK(axis.last == Approx(1.0));
    CHECK(axis.step == Approx(0.2));
    CHECK(axis.place(0.5) - axis.place(0.25) == Approx(axis.place(0.25) - axis.place(0.0)));
    const PlotAxis around = axis_around(linear, {-3.0, 0.0, 4.0});
    CHECK(around.first == Approx(-4.0));
    CHECK(around.last == Approx(4.0));
    for (const double same : {0.0, 7.3, -1e-5}) {
        const PlotAxis one = axis_around(linear, {same, same});
        CHECK(one.last > one.first);
        CHECK((one.first <= same + 1e-12 && one.last >= same - 1e-12));
    }
}

TEST_CASE("A diagram is well-formed XML whatever its texts hold") {
    const std::string svg = plot_svg(two_lines());
    CHECK(unbalanced(svg).empty());
    CHECK(holds(svg, "a &lt;b&gt; &amp; &quot;c&quot;"));
    CHECK_FALSE(std::regex_search(svg, std::regex("&(?!(amp|lt|gt|quot);)")));
    CHECK(svg == plot_svg(two_lines()));
    CHECK(unbalanced(plot_svg({})).empty());
}

TEST_CASE("Every point is a marker inside the frame, at the crossing of its decades") {
    const std::string svg = plot_svg(two_lines());
    // Circles are the first line's: its two points and its legend entry.
    const std::vector<double> x = numbers_in(svg, "cx"), y = numbers_in(svg, "cy");
    REQUIRE(x.size() == 3);
    CHECK(x[0] == 90.0);   // 0.01 s, the left end
    CHECK(x[1] == 850.0);  // 0.1 s, the right end
    CHECK(y[0] == 50.0);   // 1e-2 m, the top
    CHECK(std::abs(y[1] - (50.0 + 2.0 / 3.0 * 420.0)) < 0.06);
    CHECK((x[2] > 90.0 && x[2] < 850.0));  // the legend is inside, too
    CHECK((y[2] > 50.0 && y[2] < 470.0));
    CHECK(holds(svg, "<title>two</title>"));
}

TEST_CASE("Decades have ticks, axes labels, lines a legend, the floor its name") {
    const std::string svg = plot_svg(two_lines());
    for (const char* text :
         {">1e-2<", ">1e-3<", ">1e-4<", ">1e-5<", ">1e-1<", ">CPU time, s<", ">error, m<", ">first<", ">second<", ">reference<"})
        CHECK(holds(svg, text));
    CHECK(holds(svg, ">2e-2<"));  // one decade: 2 and 5 are labelled, too
    CHECK_FALSE(holds(svg, ">2e-4<"));
}

TEST_CASE("Twelve lines look all different") {
    Plot plot;
    for (int k = 0; k < 12; ++k) plot.series.push_back({"line " + std::to_string(k), {{1.0, std::pow(10.0, k), ""}}});
    const std::string svg = plot_svg(plot);
    std::set<std::string> strokes;
    const std::regex line("<polyline[^>]* stroke=\"(#[0-9a-f]+)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), line), end; it != end; ++it) strokes.insert((*it)[1]);
    CHECK(strokes.size() == 12);
}

TEST_CASE("What has no place on a logarithmic axis is left out") {
    Plot plot = two_lines();
    const std::string before = plot_svg(plot);
    for (const double value : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        plot.series[0].points.push_back({1.0, value, "none"});
        plot.series[0].points.push_back({value, 1e-3, "none"});
    }
    CHECK(plot_svg(plot) == before);
}

TEST_CASE("On linear axes what is 0 or below has its place, and ticks are round numbers") {
    Plot plot = two_lines();
    plot.x_scale = plot.y_scale = linear;
    plot.floor = 0.0;
    plot.series = {{"one", {{-1.0, 0.0, "a"}, {0.0, 5.0, "b"}, {1.0, -5.0, "c"}}}};
    const std::string svg = plot_svg(plot);
    CHECK(numbers_in(svg, "cx") == std::vector<double>{90.0, 470.0, 850.0, numbers_in(svg, "cx")[3]});
    CHECK(numbers_in(svg, "cy")[0] == Approx(260.0).margin(0.06));  // the middle of -6 ... 6
    for (const char* text : {">-1.0<", ">-0.5<", ">0.0<", ">0.5<", ">1.0<", ">-4<", ">0<", ">4<"}) CHECK(holds(svg, text));
    CHECK_FALSE(holds(svg, "reference"));
}

TEST_CASE("Points have markers and no lines, a curve has a line and no markers") {
    Plot plot = two_lines();
    for (PlotSeries& series : plot.series) series.marks = PlotMarks::points;
    CHECK(count(plot_svg(plot), "<polyline") == 0);
    CHECK(count(plot_svg(plot), "<circle") == 3);
    plot.series[0].marks = PlotMarks::curve;
    plot.series[0].points = {{5.0, 1.0, ""}};
    CHECK(count(plot_svg(plot), "<polyline") == 0);  // of no points that the axes of the others hold
    plot.series[0].points = {{0.05, 1e-3, ""}, {0.05, 1e-4, ""}};
    CHECK(count(plot_svg(plot), "<polyline") == 1);
    CHECK(count(plot_svg(plot), "<circle") == 0);
}

TEST_CASE("The legend stands in the corner of a frame that hides no point, each name once") {
    Plot plot = two_lines();
    plot.floor = 0.0;
    plot.panels = {"left", "right"};
    const std::vector<PlotPoint> corners = {{1.0, 1.0, ""}, {1.2, 1.2, ""}, {1.2, 8.0, ""},
                                            {8.0, 1.2, ""}, {8.0, 8.0, ""}, {9.9, 9.9, ""}};
    plot.series.push_back({"third", corners, 0, PlotMarks::points});
    plot.series.push_back({"third", corners, 1, PlotMarks::points});
    std::erase_if(plot.series.back().points, [](const PlotPoint& point) { return point.x == 8.0 && point.y == 1.2; });
    plot.series.erase(plot.series.begin(), plot.series.begin() + 2);
    const std::string svg = plot_svg(plot);
    CHECK(count(svg, ">third</text>") == 1);
    // In the right panel's lower right corner, the only empty one: the panels are 370 pixels wide and 320 high from (90, 72).
    const std::regex legend("<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*fill-opacity");
    std::smatch place;
    REQUIRE(std::regex_search(svg, place, legend));
    CHECK(std::stod(place[1]) > 480.0 + 185.0);
    CHECK(std::stod(place[2]) > 72.0 + 160.0);
}

TEST_CASE("Where the legend has no room in a panel it stands below the diagram, in lines that fit") {
    Plot plot{.panels = {"a", "b", "c"}};
    for (int k = 0; k < 12; ++k) plot.series.push_back({"a name of thirty letters, no. " + std::to_string(k), {{1.0, 2.0, ""}}});
    const std::string svg = plot_svg(plot);
    CHECK_FALSE(holds(svg, "fill-opacity"));
    CHECK(unbalanced(svg).empty());
    const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*>a name of thirty letters");
    const std::vector<double> heights = numbers_in(svg.substr(svg.find("<svg")), "height");
    std::set<std::string> lines;
    for (std::sregex_iterator it(svg.begin(), svg.end(), text), end; it != end; ++it) {
        CHECK(std::stod((*it)[1]) < 850.0);
        CHECK((std::stod((*it)[2]) > 72.0 + 230.0 && std::stod((*it)[2]) < heights.at(0)));
        lines.insert((*it)[2]);
    }
    CHECK(lines.size() == 6);
}

TEST_CASE("Panels stand three in a row with the same axes, texts of ticks at the outer ones alone") {
    Plot plot{.x_label = "x", .y_label = "y", .x_scale = linear, .y_scale = linear, .panels = {"p0", "p1", "p2", "p3"}};
    for (std::size_t panel = 0; panel < 4; ++panel)
        plot.series.push_back({"s", {{0.0, 0.0, ""}, {1.0, 10.0 * static_cast<double>(panel), ""}}, panel});
    const std::string svg = plot_svg(plot);
    CHECK(count(svg, "fill=\"none\" stroke=\"#444444\"/>") == 4);  // frames
    CHECK(count(svg, "<polyline") == 4);
    for (const char* name : {">p0<", ">p1<", ">p2<", ">p3<"}) CHECK(count(svg, name) == 1);
    CHECK(count(svg, ">0.2<") == 3);  // below each column
    CHECK(count(svg, ">30<") == 2);   // left of each row
    const std::vector<double> x = numbers_in(svg, "cx");
    REQUIRE(x.size() == 9);
    CHECK((x[0] == 90.0 && x[2] == 355.0 && x[4] == 620.0 && x[6] == 90.0));
}

TEST_CASE("A map has all cells in their colours, names, labels and a line within each panel, its legend below") {
    const std::string svg = plot_svg(map_of_cells());
    CHECK(unbalanced(svg).empty());
    CHECK(count(svg, "<title>cell</title>") == 16);
    CHECK(count(svg, "fill=\"#111111\"") == 9);  // and the legend
    CHECK(count(svg, "fill=\"#222222\"") == 9);
    CHECK(count(svg, "a &amp; b") == 1);
    CHECK(count(svg, "<polyline") == 4);
    CHECK(count(svg, ">x, s<") == 1);
    CHECK(count(svg, ">limit<") == 1);
    CHECK_FALSE(holds(svg, "fill-opacity"));
}

TEST_CASE("Cells of a panel fill it without gaps or overlaps") {
    const std::string svg = plot_svg(map_of_cells());
    // Two columns of 115 pixels and two rows of 115 in a panel of 230 x 230 whose corner is at (90, 72).
    for (const char* place :
         {"x=\"90.0\" y=\"72.0\" width=\"115.0\" height=\"115.0\"", "x=\"205.0\" y=\"187.0\" width=\"115.0\" height=\"115.0\""})
        CHECK(count(svg, place) == 1);
    const PlotAxis axis = axis_of_cells(logarithmic, {1.0, 10.0, 1000.0, 10.0});
    CHECK(axis.step == Approx(1.0));
    CHECK(axis.first == Approx(-0.5));
    CHECK(axis.last == Approx(3.5));
}

}  // namespace percale::scenes::plot_svg_test
