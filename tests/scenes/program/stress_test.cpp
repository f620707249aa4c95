#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::stress_test {
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

ProgramRun stress(const TestFolder& folder, std::vector<std::string> more) {
    folder.write("sheet.toml", falling_sheet());
    more.insert(more.begin(), {"stress", "sheet.toml"});
    return run_program(more, folder.path());
}

}  // namespace

TEST_CASE("stress runs a scene with steps, factors and schemes and writes table and map") {
    const TestFolder folder;
    const ProgramRun run = stress(folder, {"--schemes", "rk4,backward_euler", "--steps", "1/1000,0.01", "--factors", "1,100",
                                           "--most-steps", "3", "--set", "gravity=[0, -1.62, 0]"});
    CHECK(run.exit_code == 0);
    CHECK(run.error.empty());
    CHECK(run.out.find("8 cells of at most 3 steps") == 0);
    CHECK(line_count(folder.read("sheet/stress.csv")) == 9);
    CHECK(folder.read("sheet/stress.csv").find(",scene,rk4,0.001,1,") != std::string::npos);
    CHECK(folder.read("sheet/stress.svg").find("</svg>") != std::string::npos);
}

TEST_CASE("stress repeats one cell of the default matrix") {
    const TestFolder folder;
    const ProgramRun run = run_program({"stress", "--cell", "700"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("1 cell of at most 16 steps") == 0);
    CHECK(line_count(folder.read("stress_cell_700/stress.csv")) == 2);  // beside the map of a whole matrix
}

TEST_CASE("stress names the schemes that refuse a scene with an obstacle, and that is no failure") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    const ProgramRun run = run_program(
        {"stress", "box.toml", "--schemes", "rk4,backward_euler", "--steps", "1/60", "--factors", "1", "--most-steps", "2"},
        folder.path());
    CHECK(run.exit_code == 0);
    CHECK(folder.read("box/stress.csv").find("takes no obstacles") != std::string::npos);
}

TEST_CASE("stress refuses words and numbers that mean nothing and leaves nothing") {
    const TestFolder folder;
    CHECK(refused(stress(folder, {"--schemes", "rk5"}), "rk5"));
    CHECK(refused(stress(folder, {"--steps", "2.0"}), "1e-7 ... 1"));
    CHECK(refused(stress(folder, {"--steps", "fast"}), "--steps fast: must be numbers"));
    CHECK(refused(stress(folder, {"--factors", "0"}), "--factors 0"));
    CHECK(refused(stress(folder, {"--most-steps", "0"}), "1 ... 1e6"));
    CHECK(refused(stress(folder, {"--cell", "1"}), "--cell"));
    CHECK(refused(run_program({"stress", "--cell", "99999"}, folder.path()), "0 ... "));
    CHECK(refused(run_program({"stress", "--schemes", "rk5"}, folder.path()), "no such scheme"));
    CHECK(refused(stress(folder, {"--factors", "1,2,1.0"}), "--factors 1.0: given twice"));
    CHECK(refused(stress(folder, {"--schemes", "rk4,rk4"}), "--schemes rk4: given twice"));
    CHECK(refused(run_program({"stress", "--set", "duration=1"}, folder.path()), "--set"));
    CHECK(refused(run_program({"stress", "--no-skip"}, folder.path()), "--no-skip"));
    CHECK(refused(run_program({"stress", "--steps", "1e-3"}, folder.path()), "--steps: only with a scene"));
    CHECK(refused(run_program({"stress", "--factors", "10"}, folder.path()), "--factors: only with a scene"));
    CHECK(refused(run_program({"stress", "--cell", "7", "--schemes", "rk4"}, folder.path()), "--cell"));
    CHECK(folder.file_count() == 1);
}

}  // namespace percale::program::test::stress_test
