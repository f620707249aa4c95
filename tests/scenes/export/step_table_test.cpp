#include "export/step_table.h"

#include <limits>
#include <sstream>
#include <vector>

#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::step_table_test {
namespace {

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> result(1);
    for (const char letter : line) {
        if (letter == ',')
            result.emplace_back();
        else
            result.back() += letter;
    }
    return result;
}

StepReport example() {
    StepReport report;
    report.status = StepStatus::halved;
    report.time = 0.1 + 0.2;
    report.dt = 1.0 / 60.0;
    report.newton_iterations = 3;
    report.linear_iterations = 41;
    report.residual = 1.0 / 3.0;
    report.contacts = 17;
    report.smallest_distance = 0.1 * 0.3;
    report.energy.kinetic = 0.1;
    report.energy.gravity = 0.2;
    report.energy.work = 7.0;
    report.contact_hash = 0xfedcba9876543210u;
    return report;
}

}  // namespace

TEST_CASE("the columns of a step table are those of the contract") {
    CHECK(step_table_header() ==
          "time,dt,newton,linear,residual,contacts,smallest_distance,energy,status,contact_hash,state_hash,dropped");
}

TEST_CASE("the last column says in words why substeps were redone, without a comma") {
    StepReport report = example();
    CHECK(cells(step_table_line(report, 0x1u)).back().empty());
    report.dropped = {.not_converged = 2, .blocked = 1};
    CHECK(cells(step_table_line(report, 0x1u)).back() == "2 not converged; 1 blocked");
}

TEST_CASE("every number of a step reads back as the same bits") {
    const StepReport report = example();
    const std::vector<std::string> row = cells(step_table_line(report, 0x1u));
    REQUIRE(row.size() == cells(step_table_header()).size());
    CHECK(std::stod(row[0]) == report.time);
    CHECK(std::stod(row[1]) == report.dt);
    CHECK(row[2] == "3");
    CHECK(row[3] == "41");
    CHECK(std::stod(row[4]) == report.residual);
    CHECK(row[5] == "17");
    CHECK(std::stod(row[6]) == report.smallest_distance);
    CHECK(std::stod(row[7]) == report.energy.total());
    CHECK(row[8] == status_word(StepStatus::halved));
    CHECK(row[9] == "fedcba9876543210");
    CHECK(row[10] == "0000000000000001");
}

TEST_CASE("a state hash that was not asked for is an empty cell") {
    const std::vector<std::string> row = cells(step_table_line(example(), std::nullopt));
    REQUIRE(row.size() == 12);
    CHECK(row[10].empty());
}

TEST_CASE("an infinite distance is written as inf") {
    StepReport report = example();
    report.smallest_distance = std::numeric_limits<double>::infinity();
    CHECK(cells(step_table_line(report, std::nullopt))[6] == "inf");
}

TEST_CASE("a step table has one line a step and is there only when finished") {
    const TestFolder folder;
    StepTable table(folder.path("steps.csv"));
    table.add(example(), 1);
    table.add(example(), 2);
    CHECK_FALSE(folder.holds("steps.csv"));
    table.finish();
    std::istringstream text(folder.read("steps.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0] == step_table_header());
    CHECK(lines[2] == step_table_line(example(), 2));
}

TEST_CASE("A table is read back cell by cell, without a last line that was cut off; other tables are refused with their line") {
    const TestFolder folder;
    const std::string file = folder.write("steps.csv", step_table_header() + "\n" + step_table_line(example(), 7) + "\n0.1,0.2");
    const StepRows rows = read_step_rows(file, "run writes it");
    REQUIRE(rows.lines.size() == 1);
    CHECK(rows.lines[0] == cells(step_table_line(example(), 7)));
    CHECK(rows.lines[0][rows.column("newton")] == "3");
    CHECK_THROWS_WITH(rows.column("mass"), Catch::Contains("steps.csv:1: is no table of steps: it has no column 'mass'"));
    CHECK_THROWS_WITH(read_step_rows(folder.path("none"), "run writes it"),
                      Catch::Contains("none: cannot be read; run writes it"));
    folder.write("steps.csv", "time,dt\n1,2\n1,2,3\n");
    CHECK_THROWS_WITH(read_step_rows(file, ""), Catch::Contains("steps.csv:3: has 3 columns, not 2"));
}

}  // namespace percale::scenes::test::step_table_test
