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

}  // namespace

TEST_CASE("A logarithmic axis puts its ends where they belong and equal ratios at equal distances") {
    const LogAxis axis = axis_around({3e-4, 0.02, 5.0}, 100.0, 600.0);
    CHECK(axis.first == -4);
    CHECK(axis.last == 1);
    CHECK(std::abs(axis.place(1e-4) - 100.0) < 1e-9);
    CHECK(std::abs(axis.place(10.0) - 600.0) < 1e-9);
    CHECK(std::abs((axis.place(2.0) - axis.place(1.0)) - (axis.place(0.02) - axis.place(0.01))) < 1e-9);
    CHECK(axis.place(1.0) > axis.place(0.9));
}

TEST_CASE("A power of ten opens no decade of its own") {
    const LogAxis axis = axis_around({1e-3, 1e-1}, 0.0, 1.0);
    CHECK(axis.first == -3);
    CHECK(axis.last == -1);
    const LogAxis one = axis_around({1e-3}, 0.0, 1.0);
    CHECK(one.first == -3);
    CHECK(one.last == -2);
    CHECK(axis_around({}, 0.0, 1.0).last > axis_around({}, 0.0, 1.0).first);
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
    CHECK(x[1] == 640.0);  // 0.1 s, the right end
    CHECK(y[0] == 50.0);   // 1e-2 m, the top
    CHECK(std::abs(y[1] - (50.0 + 2.0 / 3.0 * 420.0)) < 0.06);
    CHECK(x[2] > 640.0);
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
    Plot plot{.title = "", .x_label = "", .y_label = "", .series = {}, .floor = 0.0, .floor_label = ""};
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

}  // namespace percale::scenes::plot_svg_test
