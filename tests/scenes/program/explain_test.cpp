#include <fstream>
#include <sstream>

#include "tests/scenes/program/run_program.h"
#include "tests/support/catch.h"

namespace percale::program::test::explain_test {

TEST_CASE("explain lists all keys, or one topic") {
    const ProgramRun all = run_program({"explain"});
    CHECK(all.exit_code == 0);
    CHECK(all.out.find("time_step") != std::string::npos);
    CHECK(all.out.find("area_density") != std::string::npos);
    const ProgramRun one = run_program({"explain", "step.time_step"});
    CHECK(one.exit_code == 0);
    CHECK(one.out.find("time_step") != std::string::npos);
    CHECK(one.out.find("area_density") == std::string::npos);
}

TEST_CASE("an unknown topic is refused with the nearest") { CHECK(refused(run_program({"explain", "tiem_step"}), "time_step")); }

TEST_CASE("the file of scene keys is what explain prints as Markdown") {
    const ProgramRun all = run_program({"explain", "--markdown"});
    CHECK(all.exit_code == 0);
    std::ifstream file(PERCALE_DATA_DIR "/../scenes/scene_keys.md");
    std::ostringstream text;
    text << file.rdbuf();
    CHECK(all.out == text.str());
    CHECK(all.out.find("\n| `time_step` | a number or \"auto\"") != std::string::npos);
    CHECK(refused(run_program({"explain", "step", "--markdown"}), "--markdown"));
}

}  // namespace percale::program::test::explain_test
