#include "scenes/compare/compare_report.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/support/catch.h"

namespace percale::scenes::compare_report_test {
namespace {

ComparedRun finished_run(const Variant& variant, double error, double cpu_s) {
    ComparedRun run{variant, {}, {error, 2.0 * error, 0.5 * error, 0.1 * error, 3.0 * error, 0.0}};
    run.run.totals.cpu_s = cpu_s;
    run.run.steps = 120;
    return run;
}

/// A reference known to 1e-6 m; a coarse, a fine, a needless (dear and no better), a perfect and a failed run.
Comparison small_comparison() {
    Comparison comparison;
    comparison.title = "a <title>";
    comparison.duration = 0.5;
    comparison.reference.variant = {"rk4", 1e-4, 0.0};
    comparison.reference.uncertainty = scaled({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, 1e-6);
    comparison.reference.growth = 10.0;
    comparison.runs = {finished_run({"backward_euler", 1.0 / 60.0, 0.0}, 2e-2, 0.1), finished_run({"rk4", 0.01, 0.0}, 3e-4, 0.5),
                       finished_run({"tr_bdf2", 0.0, 1e-3}, 3e-4, 0.6), finished_run({"rk4", 0.005, 0.0}, 1e-8, 1.0)};
    comparison.runs.push_back(
        {{"symplectic_euler", 0.01, 0.0}, {VariantEnd::blew_up, "vertex 3, \"far\", left", {}, {}, 0, 0}, {}});
    return comparison;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

TEST_CASE("The cheapest run for an error is certain to keep it") {
    const Comparison comparison = small_comparison();
    CHECK(cheapest_within(comparison, 0.1) == &comparison.runs[0]);
    CHECK(cheapest_within(comparison, 2.01e-2) == &comparison.runs[0]);
    CHECK(cheapest_within(comparison, 2e-2) == &comparison.runs[1]);  // 2e-2 and what the reference may be off
    CHECK(cheapest_within(comparison, 1e-4) == &comparison.runs[3]);
    CHECK(cheapest_within(comparison, 1.02e-6) == &comparison.runs[3]);
    CHECK(cheapest_within(comparison, 1e-6) == nullptr);
}

TEST_CASE("Advice names a run for every decade once, and none below what the reference can resolve") {
    const std::vector<std::string> sentences = advice(small_comparison());
    REQUIRE(sentences.size() == 3);
    CHECK(sentences[0] == "for an error of 1e-1 m use backward_euler at 1/60 s (0.1 CPU s)");
    CHECK(sentences[1] == "for an error of 1e-2 m to 1e-3 m use rk4 at 1/100 s (0.5 CPU s)");
    CHECK(sentences[2] == "for an error of 1e-4 m to 1e-5 m use rk4 at 1/200 s (1 CPU s)");
    Comparison none = small_comparison();
    none.runs.erase(none.runs.begin(), none.runs.end() - 1);
    REQUIRE(advice(none).size() == 1);
    CHECK(advice(none)[0].find("no run") == 0);
}

TEST_CASE("The advice on a scheme that is exact for the scene ends at rounding") {
    Comparison exact = small_comparison();
    exact.runs.resize(1);
    exact.runs[0].error = exact.reference.uncertainty = scaled({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, 0.0);
    const std::vector<std::string> sentences = advice(exact);
    REQUIRE(sentences.size() == 1);
    CHECK(sentences[0].find("for an error of 1e-1 m to 1e-15 m use ") == 0);
}

TEST_CASE("The table has its columns under each other, and says where the reference resolves nothing") {
    const std::vector<std::string> lines = lines_of(comparison_table(small_comparison()));
    REQUIRE(lines.size() == 6);
    const std::size_t status = lines[0].find("status");
    for (std::size_t i = 1; i < lines.size(); ++i) CHECK(lines[i].substr(status, 7) == (i == 5 ? "blew up" : "finishe"));
    CHECK(lines[4].find("< 1e-06") != std::string::npos);
    CHECK(lines[1].find("2.00e-02") != std::string::npos);
    CHECK(lines[3].find("tolerance 0.001 m/s") != std::string::npos);
    CHECK(lines[5].find("blew up after 0 s") != std::string::npos);
}

TEST_CASE("A chaotic comparison shows and ranks invariants instead of positions") {
    Comparison comparison = small_comparison();
    comparison.reference.chaotic = true;
    const std::string heading = lines_of(comparison_table(comparison))[0];
    CHECK(heading.find("mass centre m") != std::string::npos);
    CHECK(heading.find("rms m") == std::string::npos);
    CHECK(reference_text(comparison.reference).find("chaotic") != std::string::npos);
    CHECK(comparison_plot(comparison).y_label.find("centre of mass") != std::string::npos);
    CHECK(comparison_plot(comparison).series[0].points[0].y == 1e-2);
}

TEST_CASE("Every line of the table for programs has the fields of its heading") {
    const std::vector<std::string> lines = lines_of(comparison_csv(small_comparison()));
    REQUIRE(lines.size() == 7);
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) CHECK(commas(lines[i]) == commas(lines[0]));
    CHECK(lines[1].find("rk4,1e-4,,reference,") == 0);
    CHECK(lines[2].find(",finished,120,0,0,0,0.1,0.02,0.04,0.01,0.002,0,0.06,") != std::string::npos);
    CHECK(lines[4].find("tr_bdf2,,0.001,finished") == 0);
    CHECK(lines[6].find("blew up") != std::string::npos);
    CHECK(lines[6].find("\"vertex 3, \"\"far\"\", left\"") != std::string::npos);
}

TEST_CASE("The diagram has a line a scheme, with what finished, no error below the reference's") {
    const Plot plot = comparison_plot(small_comparison());
    REQUIRE(plot.series.size() == 3);
    CHECK(plot.series[1].name == "rk4");
    REQUIRE(plot.series[1].points.size() == 2);
    CHECK(plot.series[1].points[0].x == 0.5);
    CHECK(plot.series[1].points[1].y == 1e-6);
    CHECK(plot.series[2].name == "tr_bdf2, adaptive");
    CHECK(plot.floor == 1e-6);
    CHECK(plot.x_label.find(", s") != std::string::npos);
    CHECK(plot.y_label.find(", m") != std::string::npos);
}

}  // namespace percale::scenes::compare_report_test
