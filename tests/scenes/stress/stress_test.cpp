#include "scenes/stress/stress.h"

#include "percale/error.h"
#include "tests/scenes/compare_scenes.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::stress_test {

TEST_CASE("Cells are run in their order, and again give the same figures") {
    const std::vector<StressCell> cells = {{.scheme = Scheme::rk4, .time_step = 1e-4, .stiffness = 1.0},
                                           {.scheme = Scheme::backward_euler, .time_step = 1.0, .stiffness = 1e6}};
    std::vector<std::size_t> ended;
    const StressRun run = stress_cells(cells, 4, {.stop_asked = never_stop, .ended = [&](std::size_t k) { ended.push_back(k); }});
    CHECK(ended == std::vector<std::size_t>{0, 1});
    REQUIRE(run.rows.size() == 2);
    CHECK(run.failures() == 0);
    for (std::size_t k = 0; k < 2; ++k) {
        const StressRow again = run_cell(cells[k], 4);
        CHECK(run.rows[k].verdict == StressVerdict::stable);
        CHECK(again.figures.gain == run.rows[k].figures.gain);
        CHECK(again.figures.strain == run.rows[k].figures.strain);
        CHECK(again.figures.newton_iterations == run.rows[k].figures.newton_iterations);
    }
}

TEST_CASE("Several cells at a time give the rows of one at a time, to the bit") {
    const std::vector<StressCell> matrix = stress_matrix();
    std::vector<StressCell> cells;
    for (std::size_t k = 0; k < matrix.size(); k += 101) cells.push_back(matrix[k]);
    const StressRun alone = stress_cells(cells, 3, {}), together = stress_cells(cells, 3, {.jobs = 4});
    for (std::size_t k = 0; k < cells.size(); ++k) {
        CHECK(together.rows[k].cell.number == cells[k].number);
        CHECK(together.rows[k].verdict == alone.rows[k].verdict);
        CHECK(together.rows[k].figures.gain == alone.rows[k].figures.gain);
        CHECK(together.rows[k].figures.strain == alone.rows[k].figures.strain);
        CHECK(together.rows[k].figures.linear_iterations == alone.rows[k].figures.linear_iterations);
    }
}

TEST_CASE("What a scheme does not take is refused with the reason, and no failure") {
    const StressRow row = run_cell({.scheme = Scheme::tr_bdf2, .contact = StressContact::projection}, 2);
    CHECK(row.verdict == StressVerdict::refused);
    CHECK(row.figures.said.find("projection") != std::string::npos);
}

TEST_CASE("A stop ends the run") {
    const std::vector<StressCell> cells(3);
    CHECK_THROWS_AS(stress_cells(cells, 1, {.stop_asked = [] { return true; }}), StudyStopped);
}

TEST_CASE("A scene is run with every scheme, step and factor, each at most so many steps") {
    const SceneStress settings{
        .schemes = {"symplectic_euler", "tr_bdf2"}, .time_steps = {1e-3, 0.05}, .factors = {1.0, 1e4}, .steps = 5};
    const StressRun run = stress_scene(source_of(falling_sheet()), settings, {.stop_asked = never_stop});
    REQUIRE(run.rows.size() == 8);
    CHECK(run.rows[0].figures.steps == 5);
    CHECK(run.rows[2].figures.steps == 2);  // the scene lasts 0.1 s
    CHECK(run.rows[0].figures.said.empty());
    CHECK(run.rows[3].figures.said.find("longest stable") != std::string::npos);
    CHECK(run.failures() == 0);
}

TEST_CASE("A scene that ends at rest is run with every scheme for its max_duration") {
    std::string text = falling_sheet();
    text.replace(text.find("0.1"), 3, "\"rest\"\nmax_duration = 0.1");
    const SceneStress settings{.schemes = {"rk4", "backward_euler"}, .time_steps = {0.05}, .factors = {1.0}, .steps = 5};
    const StressRun run = stress_scene(source_of(text), settings, {.stop_asked = never_stop});
    REQUIRE(run.rows.size() == 2);
    for (const StressRow& row : run.rows) {
        CHECK(row.figures.steps == 2);
        CHECK(row.verdict == StressVerdict::stable);
    }
}

TEST_CASE("A scene whose gravity changes is refused at the event") {
    const std::string text = falling_sheet() + "[[event]]\ntime = 0.05\ngravity = [0.0, 0.0, 0.0]\n";
    CHECK_THROWS_AS(stress_scene(source_of(text), {}, {}), SceneError);
}

}  // namespace percale::scenes::test::stress_test
