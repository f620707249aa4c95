#include <nlohmann/json.hpp>

#include "tests/scenes/program/started_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::checkpoint_test {

// Runs of the program that are left on their way and resumed.
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

/// The report without what a clock or the interruption says.
nlohmann::json figures(const TestFolder& folder, const std::string& name) {
    auto report = nlohmann::json::parse(folder.read(name + "/report.json"));
    for (const char* entry : {"cpu_s", "wall_s", "certificate_s", "peak_memory_bytes", "stages", "resumed_at_s"})
        report.erase(entry);
    return report;
}

/// Every file of a run but its report and its checkpoint has the same bytes.
bool same_files(const TestFolder& folder, const std::string& one, const std::string& other) {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path(one))) {
        const std::string file = std::filesystem::relative(entry.path(), folder.path(one)).string();
        if (!entry.is_regular_file() || file == "report.json" || file == "checkpoint.percale") continue;
        if (!folder.holds(other + "/" + file) || folder.read(one + "/" + file) != folder.read(other + "/" + file)) return false;
        ++count;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path(other))) {
        const std::string file = entry.path().filename().string();
        count -= entry.is_regular_file() && file != "report.json" && file != "checkpoint.percale" ? 1 : 0;
    }
    return count == 0;
}

ProgramRun run_box(const TestFolder& folder, std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "box.toml", "--replay-hash"});
    return run_program(more, folder.path());
}

/// A run of 20000 short steps: long enough to be interrupted.
const std::vector<std::string> long_run = {
    "run",   "sheet.toml", "--set",        "duration=0.4", "--set",         "step.time_step=2e-5",
    "--fps", "20",         "--checkpoint", "0.02",         "--replay-hash", "-o"};

std::vector<std::string> long_run_into(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = long_run;
    words.push_back(name);
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

void check_meshes(const TestFolder& folder, const std::string& name) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(name + "/frames"))) {
        if (entry.path().extension() != ".obj") continue;
        const std::string text = folder.read(name + "/frames/" + entry.path().filename().string());
        CHECK(std::count(text.begin(), text.end(), 'v') == 16);
        CHECK(std::count(text.begin(), text.end(), 'f') == 18);
        ++count;
    }
    CHECK(count >= 1);
}

}  // namespace

TEST_CASE("a run with checkpoints is the same as one without, and one that is resumed, here or elsewhere, too") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_box(folder, {"-o", "plain"}).exit_code == 0);
    REQUIRE(run_box(folder, {"-o", "out", "--checkpoint", "0.07"}).exit_code == 0);
    CHECK(same_files(folder, "plain", "out"));
    CHECK(figures(folder, "plain") == figures(folder, "out"));
    const ProgramRun elsewhere = run_box(folder, {"--resume", "out/checkpoint.percale", "-o", "other", "--threads", "2"});
    CHECK(elsewhere.exit_code == 0);
    CHECK(elsewhere.out.find("into other, resumed at 0.1") != std::string::npos);
    CHECK(same_files(folder, "plain", "other"));
    const ProgramRun here = run_box(folder, {"--resume", "out/checkpoint.percale"});
    CHECK(here.exit_code == 0);
    CHECK(same_files(folder, "plain", "out"));
    CHECK(figures(folder, "plain") == figures(folder, "out"));
    const auto report = nlohmann::json::parse(folder.read("out/report.json"));
    REQUIRE(report.at("resumed_at_s").size() == 1);
    CHECK(report.at("resumed_at_s")[0].get<double>() == Approx(0.15));
    CHECK(run_program({"replay", "plain", "other"}, folder.path()).exit_code == 0);
}

TEST_CASE("a run until rest that expects something of its steps is resumed, from its end, too", "[slow]") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box() + "[expect]\nlargest_strain = { below = 1.0 }\n");
    const std::vector<std::string> until_rest = {"--set", "duration=rest", "--fps", "7"};
    const auto run_until_rest = [&](std::vector<std::string> more) {
        more.insert(more.end(), until_rest.begin(), until_rest.end());
        return run_box(folder, more);
    };
    REQUIRE(run_until_rest({"-o", "plain"}).exit_code == 0);
    for (const std::string interval : {"0.5", "0.0166"}) {
        CAPTURE(interval);
        REQUIRE(run_until_rest({"-o", "out", "--checkpoint", interval}).exit_code == 0);
        const ProgramRun resumed = run_until_rest({"--resume", "out/checkpoint.percale", "-o", "other"});
        CAPTURE(resumed.error);
        CHECK(resumed.exit_code == 0);
        CHECK(same_files(folder, "plain", "other"));
        CHECK(figures(folder, "plain") == figures(folder, "other"));
    }
}

TEST_CASE("a run that was killed leaves whole files, and is resumed from its last checkpoint in the same bits") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    REQUIRE(run_program(long_run_into("plain"), folder.path()).exit_code == 0);
    {
        StartedRun run(folder, long_run_into("out"));
        run.wait_for(folder, "out/checkpoint.percale");
        CHECK(run.end(SIGKILL) == -1);
    }
    CHECK_FALSE(folder.holds("out/report.json"));
    CHECK_FALSE(folder.holds("out/steps.csv"));
    check_meshes(folder, "out");
    const ProgramRun resumed = run_program(long_run_into("out", {"--resume", "out/checkpoint.percale"}), folder.path());
    CHECK(resumed.error.empty());
    CHECK(resumed.exit_code == 0);
    CHECK(same_files(folder, "plain", "out"));
    CHECK(figures(folder, "plain") == figures(folder, "out"));
}

TEST_CASE("a run that is stopped writes a checkpoint of where it stopped, and says how to go on") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const TestFolder folder;
        folder.write("sheet.toml", falling_sheet());
        {
            StartedRun run(folder, long_run_into("out"));
            run.wait_for(folder, "out/checkpoint.percale");
            CHECK(run.end(signal) == 130);
        }
        const auto stopped = nlohmann::json::parse(folder.read("out/report.json"));
        CHECK(stopped.at("status") == "stopped");
        CHECK(line_count(folder.read("out/steps.csv")) == 1 + stopped.at("steps").get<int>());
        const ProgramRun resumed = run_program(long_run_into("out", {"--resume", "out/checkpoint.percale"}), folder.path());
        CHECK(resumed.exit_code == 0);
        const auto report = nlohmann::json::parse(folder.read("out/report.json"));
        CHECK(report.at("status") == "finished");
        CHECK(report.at("resumed_at_s")[0] == stopped.at("simulated_s"));
        CHECK(report.at("steps") == 20000);
        CHECK(line_count(folder.read("out/steps.csv")) == 20001);
    }
}

TEST_CASE("ten runs and runs on two and four threads are the same in every bit", "[slow]") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_box(folder, {"-o", "first", "--quiet"}).exit_code == 0);
    for (int n = 1; n < 10; ++n) {
        REQUIRE(run_box(folder, {"-o", "again", "--quiet"}).exit_code == 0);
        CHECK(run_program({"replay", "first", "again"}, folder.path()).exit_code == 0);
    }
    // So many vertices that threads share them out.
    const std::vector<std::string> large = {"--quiet", "--frames",     "none", "--set", "cloth.sheet.grid.vertices=[92, 92]",
                                            "--set",   "duration=0.05"};
    const auto run_large = [&](const std::string& name, const std::string& threads) {
        std::vector<std::string> words = large;
        words.insert(words.end(), {"-o", name, "--threads", threads});
        return run_box(folder, words).exit_code;
    };
    REQUIRE(run_large("one", "1") == 0);
    for (const std::string threads : {"2", "4"}) {
        REQUIRE(run_large("more", threads) == 0);
        CHECK(run_program({"replay", "one", "more"}, folder.path()).exit_code == 0);
    }
}

TEST_CASE("checkpoints of other runs, damaged ones and wrong intervals are refused, and nothing is written") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    folder.write("sheet.toml", falling_sheet());
    REQUIRE(run_box(folder, {"-o", "out", "--checkpoint", "0.05", "--quiet"}).exit_code == 0);
    const std::string file = "out/checkpoint.percale";
    const int files = folder.file_count();
    CHECK(refused(run_program({"run", "sheet.toml", "--replay-hash", "-o", "new", "--resume", file}, folder.path()),
                  file + ": is of another run and cannot be resumed: "));
    CHECK(refused(run_box(folder, {"-o", "new", "--resume", file, "--set", "duration=3"}),
                  "duration is 3.0, in the checkpoint 0.2"));
    CHECK(refused(run_program({"run", "box.toml", "-o", "new", "--resume", file}, folder.path()), "with --replay-hash"));
    CHECK(refused(run_box(folder, {"-o", "new", "--resume", "absent"}), "absent: cannot be read"));
    CHECK(refused(run_box(folder, {"-o", "new", "--resume", "box.toml"}), "box.toml: checkpoint: it is none"));
    for (const char* interval : {"0", "-1", "x", "1s", "nan", "1e9"}) {
        CAPTURE(interval);
        CHECK(refused(run_box(folder, {"-o", "new", "--checkpoint", interval}), "1e-6 ... 1e6 s"));
    }
    CHECK_FALSE(folder.holds("new"));
    CHECK(folder.file_count() == files);
    std::filesystem::remove(folder.path("out/steps.csv"));
    CHECK(refused(run_box(folder, {"--resume", file}), "steps.csv: cannot be read: No such file"));
    CHECK(folder.holds("out/report.json"));
}

}  // namespace percale::program::test::checkpoint_test
