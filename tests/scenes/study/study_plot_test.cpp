#include "scenes/study/study_plot.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::study_plot_test {
namespace {

const std::string ranged_step = "\"step.time_step\" = { from = 0.001, to = 0.01, count = 4 }\n";
const std::string listed_bend = "\"fabric.sheet.springs.bend\" = [0.001, 0.01, 0.1]\n";
const std::string listed_density = "\"fabric.sheet.area_density\" = [0.2, 0.3]\n";
const std::string random_density = "\"fabric.sheet.area_density\" = { uniform = [0.1, 0.4] }\n";

Study study_of(const std::string& vary, const std::string& top = "") {
    const TestFolder folder;
    return read_study(write_study(folder, vary, top));
}

/// Values of all runs: their numbers and 1.
std::vector<std::optional<double>> some_values(const Study& study) {
    std::vector<std::optional<double>> values;
    for (std::size_t run = 0; run < study.runs.size(); ++run) values.emplace_back(1.0 + static_cast<double>(run));
    return values;
}

Plot plot_of(const Study& study) { return study_plot(study, some_values(study)); }

std::size_t point_count(const Plot& plot) {
    std::size_t count = 0;
    for (const PlotSeries& series : plot.series) count += series.points.size();
    return count;
}

bool all_marks(const Plot& plot, PlotMarks marks) {
    return std::ranges::all_of(plot.series, [&](const PlotSeries& series) { return series.marks == marks; });
}

std::set<std::string> names_of(const Plot& plot) {
    std::set<std::string> names;
    for (const PlotSeries& series : plot.series) names.insert(series.name);
    return names;
}

int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace

TEST_CASE("One key makes one line without a name, over a linear axis where its range is linear") {
    const Plot plot = plot_of(study_of(ranged_step));
    REQUIRE(plot.series.size() == 1);
    CHECK(plot.series[0].name.empty());
    CHECK(plot.series[0].points.size() == 4);
    CHECK(std::ranges::is_sorted(plot.series[0].points, {}, &PlotPoint::x));
    CHECK(plot.x_scale == AxisScale::linear);
    CHECK(plot.y_scale == AxisScale::linear);
    CHECK(all_marks(plot, PlotMarks::lines));
    CHECK(plot.panels.empty());
    CHECK(plot.x_label == "step.time_step");
}

TEST_CASE("Axes are logarithmic for a range or draw that is, for a list over decades, and for such a measure above 0") {
    const auto scale = [](const std::string& vary, const std::string& top = "") { return plot_of(study_of(vary, top)).x_scale; };
    CHECK(scale("\"step.time_step\" = { from = 0.001, to = 0.01, count = 4, scale = \"log\" }\n") == AxisScale::logarithmic);
    CHECK(scale("\"fabric.sheet.area_density\" = { log_uniform = [0.1, 0.4] }\n", "draws = 5\n") == AxisScale::logarithmic);
    CHECK(scale(random_density, "draws = 5\n") == AxisScale::linear);
    CHECK(scale(listed_bend) == AxisScale::logarithmic);
    CHECK(scale(listed_density) == AxisScale::linear);
    const Study study = study_of(listed_density);
    CHECK(study_plot(study, {1e-3, 0.1}).y_scale == AxisScale::logarithmic);
    CHECK(study_plot(study, {1e-3, 0.09}).y_scale == AxisScale::linear);
    CHECK(study_plot(study, {0.0, 0.1}).y_scale == AxisScale::linear);
    CHECK(study_plot(study, {-1e-3, 0.1}).y_scale == AxisScale::linear);
}

TEST_CASE("A second key makes a line for each of its values, a third a panel, all of a grid") {
    const Plot two = plot_of(study_of(ranged_step + listed_bend));
    CHECK(names_of(two) == std::set<std::string>{"fabric.sheet.springs.bend = 0.001", "fabric.sheet.springs.bend = 0.01",
                                                 "fabric.sheet.springs.bend = 0.1"});
    CHECK(two.panels.empty());
    const Plot three = plot_of(study_of(ranged_step + listed_bend + listed_density));
    CHECK(three.panels == std::vector<std::string>{"fabric.sheet.area_density = 0.2", "fabric.sheet.area_density = 0.3"});
    CHECK(three.series.size() == 6);
    CHECK(names_of(three) == names_of(two));
    CHECK(point_count(three) == 24);
    for (const PlotSeries& series : three.series) CHECK(series.points.size() == 4);
    CHECK((all_marks(two, PlotMarks::lines) && all_marks(three, PlotMarks::lines)));
}

TEST_CASE("A fourth key is in no place of its own, so that points are not joined") {
    const Plot plot = plot_of(study_of(ranged_step + listed_bend + listed_density + "\"duration\" = [0.1, 0.2]\n"));
    CHECK(plot.panels.size() == 2);
    CHECK(point_count(plot) == 48);
    CHECK(all_marks(plot, PlotMarks::points));
}

TEST_CASE("Random values are points, whichever key is random, and a random second or third key has three ranges") {
    const Plot over_random = plot_of(study_of(random_density + listed_bend,
                                              "draws = 5\nplot = [\"fabric.sheet.area_density\", "
                                              "\"largest_strain\"]\n"));
    CHECK(all_marks(over_random, PlotMarks::points));
    CHECK(names_of(over_random).size() == 3);
    const Study study = study_of(ranged_step + listed_bend + random_density, "draws = 5\n");
    const Plot plot = plot_of(study);
    CHECK(all_marks(plot, PlotMarks::points));
    REQUIRE(plot.panels.size() == 3);
    for (const std::string& name : plot.panels)
        CHECK(std::regex_match(name, std::regex("fabric\\.sheet\\.area_density = 0\\.[0-9]+ \\.\\.\\. 0\\.[0-9]+")));
    // 60 runs: 20 in each range, which part the values.
    std::vector<double> lowest(3, 1.0), highest(3, 0.0);
    std::vector<int> runs(3, 0);
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& point : series.points) {
            const double density = std::stod(study.runs[static_cast<std::size_t>(point.y - 1.0)][2]);
            lowest[series.panel] = std::min(lowest[series.panel], density);
            highest[series.panel] = std::max(highest[series.panel], density);
            ++runs[series.panel];
        }
    }
    CHECK(runs == std::vector<int>(3, 20));
    CHECK((highest[0] <= lowest[1] && highest[1] <= lowest[2]));
}

TEST_CASE("A key with more than twelve values has three ranges, too, and its points are not joined; one of words has no place") {
    const Plot plot =
        plot_of(study_of("\"step.time_step\" = [0.01, 0.005]\n\"duration\" = { from = 0.1, to = 0.2, count = 13 }\n"));
    CHECK(names_of(plot).size() == 3);
    CHECK(all_marks(plot, PlotMarks::points));
    CHECK(point_count(plot) == 26);
    std::string words;
    for (int k = 0; k < 13; ++k) words += "\"sheet " + std::to_string(k) + "\", ";
    const Plot titled = plot_of(study_of("\"step.time_step\" = [0.01, 0.005]\n\"title\" = [" + words + "]\n"));
    CHECK(names_of(titled) == std::set<std::string>{""});
    CHECK(all_marks(titled, PlotMarks::points));
}

TEST_CASE("Runs without a value are left out, and a study whose keys have no numbers has an empty plot") {
    const Study study = study_of(ranged_step + listed_density);
    std::vector<std::optional<double>> values = some_values(study);
    for (std::size_t run = 0; run < values.size(); run += 2) values[run] = std::nullopt;
    const Plot plot = study_plot(study, values);
    CHECK(point_count(plot) == 4);
    CHECK(names_of(plot) == std::set<std::string>{"fabric.sheet.area_density = 0.3"});
    CHECK(plot_of(study_of("\"step.scheme\" = [\"rk4\", \"symplectic_euler\"]\n")).series.empty());
}

TEST_CASE("The drawing of three keys has a frame a panel, axes with round numbers, a mark a run and the legend within") {
    const std::string svg = plot_svg(plot_of(study_of(ranged_step + listed_bend + listed_density)));
    CHECK(count(svg, "fill=\"none\" stroke=\"#444444\"/>") == 2);
    CHECK(count(svg, "<polyline") == 6);
    CHECK(count(svg, "<title>run ") == 24);
    for (const char* tick : {">0.002<", ">0.004<", ">0.010<"}) CHECK(count(svg, tick) == 2);
    CHECK(count(svg, ">fabric.sheet.springs.bend = 0.1</text>") == 1);
    CHECK(count(svg, "fill-opacity") == 1);
    const Study random = study_of(ranged_step + listed_bend + random_density, "draws = 5\n");
    const std::string scattered = plot_svg(plot_of(random));
    CHECK(count(scattered, "<polyline") == 0);
    CHECK(count(scattered, "<title>run ") == 60);
    CHECK(count(scattered, "fill=\"none\" stroke=\"#444444\"/>") == 3);
}

}  // namespace percale::scenes::test::study_plot_test
