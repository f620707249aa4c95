#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::replay_test {
using percale::scenes::test::sheet_on_box;

namespace {

void run_into(const TestFolder& folder, const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "box.toml", "-o", name, "--replay-hash", "--quiet"});
    REQUIRE(run_program(more, folder.path()).exit_code == 0);
}

}  // namespace

TEST_CASE("replay says whether two runs are the same and names the first step that differs") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    run_into(folder, "a", {});
    run_into(folder, "b", {"--threads", "2"});
    run_into(folder, "short", {"--set", "duration=0.1"});
    run_into(folder, "slippery",
             {"--set", "obstacle.box.friction=0", "--set", "cloth.sheet.pose.rotation=[0.9998, 0.02, 0.0, 0.0]"});
    const ProgramRun same = run_program({"replay", "a", "b"}, folder.path());
    CHECK(same.exit_code == 0);
    CHECK(same.out == "the same: 12 steps\n");
    const ProgramRun shorter = run_program({"replay", "a", "short/steps.csv"}, folder.path());
    CHECK(shorter.exit_code == 1);
    CHECK(shorter.out == "a has 12 steps, short/steps.csv 6; the 6 of both are the same\n");
    const ProgramRun other = run_program({"replay", "a", "slippery"}, folder.path());
    CHECK(other.exit_code == 1);
    CHECK(other.out.find("step 1 at 0.0166") == 0);
    CHECK(other.out.find("s: state_hash is ") != std::string::npos);
    CHECK(other.error.empty());
}

TEST_CASE("replay refuses what holds no hashes") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    run_into(folder, "a", {});
    REQUIRE(run_program({"run", "box.toml", "-o", "plain", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(refused(run_program({"replay", "a", "plain"}, folder.path()), "plain/steps.csv:2: has no state_hash"));
    CHECK(refused(run_program({"replay", "absent", "a"}, folder.path()), "absent: cannot be read"));
    CHECK(refused(run_program({"replay", "a"}, folder.path()), "OTHER"));
}

}  // namespace percale::program::test::replay_test
