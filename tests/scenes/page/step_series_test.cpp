#include "scenes/page/step_series.h"

#include <cmath>

#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::step_series_test {

namespace {

const std::string header =
    "time,dt,newton,linear,residual,contacts,smallest_distance,energy,status,contact_hash,state_hash,dropped\n";

std::string step_line(double time, int newton, const std::string& distance, const std::string& status = "ok") {
    return std::to_string(time) + ",0.1," + std::to_string(newton) + ",7,1e-9,3," + distance + ",nan," + status + ",aa,,\n";
}

const StepColumn& column_of(const StepSeries& series, const std::string& name) {
    for (const StepColumn& column : series.columns)
        if (column.name == name) return column;
    throw std::runtime_error("no column " + name);
}

}  // namespace

TEST_CASE("A short table of steps is kept step by step, what is not finite as nothing") {
    const TestFolder folder;
    folder.write("steps.csv", header + step_line(0.1, 2, "inf") + step_line(0.2, 5, "0.25") + step_line(0.3, 3, "0.5", "failed"));
    const StepSeries series = read_step_series(folder.path(), 100);
    CHECK(series.steps == 3);
    CHECK(series.every == 1);
    CHECK(series.time == std::vector<double>{0.1, 0.2, 0.3});
    CHECK(column_of(series, "newton").min == std::vector<double>{2, 5, 3});
    CHECK(column_of(series, "newton").max == std::vector<double>{2, 5, 3});
    CHECK(std::isnan(column_of(series, "smallest_distance").min[0]));
    CHECK(column_of(series, "smallest_distance").min[1] == 0.25);
    for (const double energy : column_of(series, "energy").max) CHECK(std::isnan(energy));
    CHECK(series.bad == std::vector<double>{0.3});
    CHECK(series.bad_steps == 1);
}

TEST_CASE("A long table keeps the smallest and the largest of each group of steps") {
    const TestFolder folder;
    std::string text = header;
    for (int i = 1; i <= 10; ++i) text += step_line(0.1 * i, i == 5 ? 50 : i, i == 2 ? "inf" : "0." + std::to_string(i));
    folder.write("steps.csv", text);
    const StepSeries series = read_step_series(folder.path(), 4);
    CHECK(series.steps == 10);
    CHECK(series.every == 3);
    REQUIRE(series.time.size() == 4);
    CHECK(series.time[0] == Approx(0.3));
    CHECK(series.time[3] == Approx(1.0));
    CHECK(column_of(series, "newton").min == std::vector<double>{1, 4, 7, 10});
    CHECK(column_of(series, "newton").max == std::vector<double>{3, 50, 9, 10});
    CHECK(column_of(series, "smallest_distance").min[0] == 0.1);
}

TEST_CASE("A run without steps has no series") {
    const TestFolder folder;
    folder.write("steps.csv", header);
    const StepSeries series = read_step_series(folder.path(), 4);
    CHECK(series.steps == 0);
    CHECK(series.time.empty());
}

TEST_CASE("A table that is missing or broken is refused with file and line") {
    const TestFolder folder;
    const auto refusal = [&](const std::string& text) {
        folder.write("steps.csv", text);
        return message_of([&] { read_step_series(folder.path(), 4); }).substr(folder.path().size() + 1);
    };
    CHECK(message_of([&] { read_step_series(folder.path("absent"), 4); }).find("absent/steps.csv: cannot be read") !=
          std::string::npos);
    CHECK(refusal("time,dt\n") == "steps.csv:1: is no table of steps: it has no column 'status'");
    CHECK(refusal(header + "0.1,0.1\n") == "steps.csv:2: has 2 columns, not 12");
    CHECK(refusal(header + step_line(0.1, 1, "0.5") + step_line(0.2, 1, "wide")) == "steps.csv:3: 'wide' is not a number");
    CHECK(refusal(header + step_line(0.1, 1, "")) == "steps.csv:2: '' is not a number");
}

}  // namespace percale::scenes::test::step_series_test
