#include "scenes/study/study_table.h"

#include <algorithm>

#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::study_table_test {
namespace {

void report(const TestFolder& folder, int run, const std::string& text) {
    const std::string name = "out/runs/0000" + std::to_string(run);
    std::filesystem::create_directories(folder.path(name));
    folder.write(name + "/report.json", text);
}

}  // namespace

TEST_CASE("a study's tables have a line a run: values, status, measures, expectations, and costs apart") {
    const TestFolder folder;
    const Study study = read_study(
        write_study(folder, "\"step.scheme\" = [\"rk4\", \"symplectic_euler\"]\n\"step.time_step\" = [0.01, 0.005]\n"));
    const StudyFolder runs(folder.path("out"));
    runs.begin(study);
    report(folder, 0,
           "{\"status\": \"finished\", \"largest_strain\": 0.25, \"lowest_vertex\": null, \"steps\": 10, \"cpu_s\": 0.5, "
           "\"expectations\": [{\"passed\": true}, {\"passed\": false}]}");
    report(folder, 3, "{\"status\": \"failed\", \"largest_strain\": 4.0, \"expectations\": []}");
    const StudyTables tables = study_tables(study, runs);
    CHECK(tables.done == 2);
    CHECK(tables.failed == 1);
    CHECK(tables.not_as_expected == 1);
    CHECK(tables.csv.starts_with("run,step.scheme,step.time_step,status,intersections,"));
    CHECK(std::count(tables.csv.begin(), tables.csv.end(), '\n') == 5);
    CHECK(tables.csv.find("\n0,rk4,0.01,finished,,,,0.25,,,,,,2,1\n") != std::string::npos);
    CHECK(tables.csv.find("\n1,rk4,0.005,missing,,,,,,,,,,,\n") != std::string::npos);
    CHECK(tables.csv.find("\n3,symplectic_euler,0.005,failed,,,,4,,,,,,0,0\n") != std::string::npos);
    CHECK(tables.csv.find("cpu") == std::string::npos);
    CHECK(tables.costs == "run,steps,cpu_s,wall_s,peak_memory_bytes\n0,10,0.5,,\n3,,,,\n");
    CHECK(tables.svg.find("largest_strain over step.time_step") != std::string::npos);
    for (const std::string& status : {std::string("crossed"), std::string("unsolved")}) {  // whatever else became of them
        report(folder, 3, "{\"status\": \"" + status + "\", \"expectations\": []}");
        CHECK(study_tables(study, runs).failed == 1);
    }
    CHECK(tables.svg.find("step.scheme = rk4") != std::string::npos);
}

}  // namespace percale::scenes::test::study_table_test
