#include "compare/replay.h"

#include "export/step_table.h"
#include "percale/error.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::replay_test {
namespace {

constexpr std::size_t contacts = 2, state = 3;

StepRows some_steps(int count) {
    StepRows steps{.file = "steps.csv", .header = {"time", "status", "contact_hash", "state_hash"}, .lines = {}};
    for (int n = 0; n < count; ++n)
        steps.lines.push_back({std::to_string(n), "ok", "c" + std::to_string(n), "s" + std::to_string(n)});
    return steps;
}

}  // namespace

TEST_CASE("the first step that differs is found, and by what it differs first") {
    const StepRows steps = some_steps(9);
    CHECK(compare_steps(steps, steps).step == 0);
    CHECK(compare_steps(steps, steps).steps_of_both == 9);
    for (std::size_t n = 0; n < steps.lines.size(); ++n) {
        StepRows other = steps;
        for (std::size_t later = n; later < other.lines.size(); ++later) other.lines[later][state] = "x";
        if (n % 2 == 0) other.lines[n][contacts] = "y";
        const ReplayDifference difference = compare_steps(steps, other);
        CHECK(difference.step == n + 1);
        CHECK(difference.time == std::to_string(n));
        CHECK(difference.what == (n % 2 == 0 ? "contact_hash" : "state_hash"));
        CHECK(difference.second == (n % 2 == 0 ? "y" : "x"));
    }
    const StepRows shorter = some_steps(4);
    CHECK(compare_steps(steps, shorter).step == 0);
    CHECK(compare_steps(shorter, steps).steps_of_both == 4);
}

TEST_CASE("steps are read from a table as the program writes it, from its folder and from a run that was killed") {
    const TestFolder folder;
    StepReport report;
    report.time = 0.5;
    report.contact_hash = 0xabc;
    {
        StepTable table(folder.path("steps.csv"));
        table.add(report, 0x123);
        table.finish();
    }
    const StepRows steps = read_hashed_steps(folder.path());
    REQUIRE(steps.lines.size() == 1);
    const auto cell = [&](const char* name) { return steps.lines[0][steps.column(name)]; };
    CHECK(cell("time") == "0.5");
    CHECK(cell("status") == "ok");
    CHECK(cell("contact_hash") == "0000000000000abc");
    CHECK(cell("state_hash") == "0000000000000123");
    const std::string whole = folder.read("steps.csv");
    std::filesystem::remove(folder.path("steps.csv"));
    folder.write("steps.csv.part", whole + whole.substr(whole.find('\n') + 1, 9));
    CHECK(read_hashed_steps(folder.path()).lines.size() == 1);
}

TEST_CASE("what is no table of steps, or has no state hashes, is refused with its line") {
    const TestFolder folder;
    const std::string header = step_table_header() + "\n", file = folder.path("steps.csv");
    CHECK_THROWS_WITH(read_hashed_steps(folder.path()), Catch::Contains(file + ": cannot be read"));
    folder.write("steps.csv", "a,b\n1,2\n");
    CHECK_THROWS_WITH(read_hashed_steps(file), Catch::Contains(file + ":1: is no table of steps: it has no column 'time'"));
    folder.write("steps.csv", header + "1,2\n");
    CHECK_THROWS_WITH(read_hashed_steps(file), Catch::Contains(file + ":2: has 2 columns, not 12"));
    folder.write("steps.csv", header + step_table_line({}, std::nullopt) + "\n");
    CHECK_THROWS_WITH(read_hashed_steps(file), Catch::Contains("--replay-hash"));
}

}  // namespace percale::scenes::test::replay_test
