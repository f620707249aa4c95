#include "scenes/stress/stress_report.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"

namespace percale::scenes::test::stress_report_test {

namespace {

StressRow row(Scheme scheme, double time_step, StressVerdict verdict) {
    return {.cell = {.sweep = "base", .scheme = scheme, .time_step = time_step, .stiffness = 100.0},
            .figures = {},
            .verdict = verdict};
}

StressRun small_run() {
    StressRun run{.title = "small cloths", .steps = 16, .rows = {}};
    run.rows = {row(Scheme::rk4, 1e-3, StressVerdict::stable), row(Scheme::rk4, 1e-1, StressVerdict::silent),
                row(Scheme::tr_bdf2, 1e-3, StressVerdict::stable), row(Scheme::tr_bdf2, 1e-1, StressVerdict::gained)};
    for (std::size_t k = 0; k < run.rows.size(); ++k) run.rows[k].cell.number = static_cast<int>(k);
    return run;
}

}  // namespace

TEST_CASE("The summary counts verdicts and failures scheme by scheme") {
    const std::string text = stress_summary(small_run());
    CHECK(text ==
          "scheme   stable  refused  not_finite  gained  silent  failures\n"
          "rk4           1        0           0       0       1         1\n"
          "tr_bdf2       1        0           0       1       0         1\n");
    CHECK(std::count(text.begin(), text.end(), '\n') == 3);
}

TEST_CASE("Failures are reported with the number of their cell, as many as asked for") {
    CHECK(stress_failures(small_run(), 10).find("cell 1: rk4, 0.1 s, 1e+02 N/m") == 0);
    CHECK(stress_failures(small_run(), 10).find("cell 3: tr_bdf2") != std::string::npos);
    CHECK(stress_failures(small_run(), 1).find("cell 3") == std::string::npos);
}

TEST_CASE("The table has a line a cell, with as many fields as headings") {
    const std::string text = stress_csv(small_run());
    CHECK(std::count(text.begin(), text.end(), '\n') == 5);
    const std::size_t line = text.find('\n') + 1;
    const auto fields = [&](std::size_t from) {
        return std::count(text.begin() + static_cast<long>(from), text.begin() + static_cast<long>(text.find('\n', from)), ',');
    };
    CHECK(fields(0) == fields(line));
    CHECK(text.find("\n1,base,rk4,0.1,100,1,0.1,1,grid,thrown,none,silent,yes,yes,") != std::string::npos);
    StressRun of_scene = small_run();
    of_scene.of_scene = true;
    CHECK(stress_csv(of_scene).find("\n1,base,rk4,0.1,100,,,,,,,silent,yes,yes,") != std::string::npos);
}

TEST_CASE("The map has a panel a scheme, and the theoretical limit where a scheme has one") {
    const Plot map = stress_map(small_run());
    CHECK(map.panels == std::vector<std::string>{"rk4", "tr_bdf2"});
    // Of each scheme a series a verdict, and of rk4 alone the limit.
    REQUIRE(map.series.size() == 11);
    for (std::size_t k = 0; k < map.series.size(); ++k) {
        const PlotSeries& series = map.series[k];
        CAPTURE(k, series.name);
        CHECK(series.panel == (k < 6 ? 0u : 1u));
        CHECK(series.marks == (k == 5 ? PlotMarks::curve : PlotMarks::cells));
        const bool filled = k == 0 || k == 4 || k == 5 || k == 6 || k == 9;
        CHECK(series.points.size() == (filled ? 1u : 0u));
    }
    CHECK(map.series[4].name == "silent");
    CHECK(map.series[9].name == "gained");
    const double omega = std::sqrt(largest_square({.stiffness = 100.0}));
    CHECK(map.series[5].points[0].x * omega > 2.0);
    CHECK(map.series[5].points[0].x * omega < 3.2);
    StressRun of_scene = small_run();
    of_scene.of_scene = true;
    CHECK(stress_map(of_scene).series.size() == 10);
}

}  // namespace percale::scenes::test::stress_report_test
