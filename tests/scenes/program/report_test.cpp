#include <filesystem>

#include "page/page_parts.h"
#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/skip.h"

namespace percale::program::test::report_test {
using percale::scenes::test::sheet_on_box;

namespace {

/// Whether this build has pages; a test without them says so.
bool can_report() {
    if (!percale::scenes::three_library().empty()) return true;
    percale::test::skip("this build has no three.js (libjs-three)");
    return false;
}

const std::string page_start = "<!DOCTYPE html>";

}  // namespace

TEST_CASE("report writes the page of a run into its folder, or to the file that is given") {
    if (!can_report()) return;
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_program({"run", "box.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    CHECK_FALSE(folder.holds("out/report.html"));
    const ProgramRun here = run_program({"report", "out"}, folder.path());
    CHECK(here.exit_code == 0);
    CHECK(here.error.empty());
    CHECK(here.out.find("out/report.html: 7 frames, ") == 0);
    CHECK(folder.read("out/report.html").starts_with(page_start));
    const ProgramRun there = run_program({"report", "out", "-o", "page.html", "--quiet", "--no-distance"}, folder.path());
    CHECK(there.exit_code == 0);
    CHECK(there.out.empty());
    CHECK(folder.read("page.html").size() < folder.read("out/report.html").size());
    CHECK(folder.read("page.html").find("\"name\":\"distance\"") == std::string::npos);
    CHECK(folder.read("out/report.html").find("\"name\":\"distance\"") != std::string::npos);
}

TEST_CASE("run --report leaves a page, also of a run whose expectations failed or that wrote no frames") {
    if (!can_report()) return;
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box() + "[expect]\nspeed_at_end = { above = 1e9 }\n");
    const ProgramRun failed = run_program({"run", "box.toml", "-o", "out", "--report"}, folder.path());
    CHECK(failed.exit_code == 1);
    CHECK(failed.out.find("out/report.html: 7 frames, ") != std::string::npos);
    CHECK(folder.read("out/report.html").find("\"passed\":false") != std::string::npos);
    const ProgramRun none = run_program({"run", "box.toml", "-o", "none", "--report", "--frames", "none"}, folder.path());
    CHECK(none.exit_code == 1);
    CHECK(none.out.find("none/report.html: no frames, ") != std::string::npos);
}

TEST_CASE("a run takes the page of the run before with it, and leaves what somebody else put there") {
    if (!can_report()) return;
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_program({"run", "box.toml", "-o", "out", "--report", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(folder.holds("out/report.html"));
    REQUIRE(run_program({"run", "box.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    CHECK_FALSE(folder.holds("out/report.html"));
    folder.write("out/report.html", "<!DOCTYPE html><p>mine</p>, and long enough to be taken for a page of ours");
    REQUIRE(run_program({"run", "box.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(folder.holds("out/report.html"));
}

TEST_CASE("report refuses what is no run, and what it cannot do, in one message and without a file") {
    if (!can_report()) return;
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    CHECK(refused(run_program({"report", "absent"}, folder.path()), "absent: is not the folder of a run"));
    CHECK(refused(run_program({"report", "box.toml"}, folder.path()), "box.toml: is not the folder of a run"));
    CHECK(refused(run_program({"report", "."}, folder.path()), "./report.json: cannot be read"));
    CHECK(refused(run_program({"report"}, folder.path()), "DIR"));
    REQUIRE(run_program({"run", "box.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    for (const char* size : {"1", "501", "-3", "nan"})
        CHECK(refused(run_program({"report", "out", "--most-megabytes", size}, folder.path()), "--most-megabytes"));
    CHECK(
        refused(run_program({"report", "out", "-o", "absent/page.html"}, folder.path()), "absent/page.html: cannot be written"));
    std::filesystem::remove(folder.path("out/obstacles/box_00000.obj"));
    CHECK(refused(run_program({"report", "out"}, folder.path()), "out/obstacles/box_00000.obj: is missing"));
    CHECK_FALSE(folder.holds("out/report.html"));
}

TEST_CASE("a build without three.js refuses report and run --report before anything is done") {
    if (!percale::scenes::three_library().empty()) {
        CHECK(run_program({"report", "--help"}).exit_code == 0);
        return;
    }
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    CHECK(refused(run_program({"report", "out"}, folder.path()), "percale report: this build writes no pages"));
    CHECK(refused(run_program({"run", "box.toml", "-o", "out", "--report"}, folder.path()), "libjs-three"));
    CHECK(folder.file_count() == 1);
}

}  // namespace percale::program::test::report_test
