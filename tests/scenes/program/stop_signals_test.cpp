#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/program/started_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

using namespace percale::program::test;
using percale::scenes::test::falling_sheet;

namespace {

/// Starts a run that would last for hours, and waits until it has written a frame.
pid_t start_endless_run(const TestFolder& folder) {
    folder.write("sheet.toml", falling_sheet());
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        const std::string scene = folder.path("sheet.toml"), out = folder.path("out");
        execl(PERCALE_PROGRAM, PERCALE_PROGRAM, "run", scene.c_str(), "-o", out.c_str(), "--set", "duration=10000", "--set",
              "step.time_step=1e-5", "--fps", "1", nullptr);
        _exit(99);
    }
    for (int i = 0; i < 500 && !folder.holds("out/frames/sheet_00000.obj"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return child;
}

int exit_code_after(pid_t child, int signal) {
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("a run that is interrupted or terminated finishes its step, writes its report and says so") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const TestFolder folder;
        CHECK(exit_code_after(start_endless_run(folder), signal) == 130);
        const auto report = nlohmann::json::parse(folder.read("out/report.json"));
        CHECK(report.at("status") == "stopped");
        const int steps = report.at("steps");
        CHECK(steps >= 1);
        const std::string table = folder.read("out/steps.csv");
        CHECK(line_count(table) == steps + 1);
    }
}

TEST_CASE("a second signal ends a run in the midst of its step, and leaves no report") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    // Its one step takes many seconds.
    const std::vector<std::string> long_step = {"run",   "sheet.toml",
                                                "-o",    "out",
                                                "--set", "cloth.sheet.grid.vertices=[401, 401]",
                                                "--set", "cloth.sheet.pin=[0, 400]",
                                                "--set", "step.time_step=0.1",
                                                "--set", "duration=0.1"};
    StartedRun run(folder, long_step);
    run.wait_for(folder, "out/frames/sheet_00000.obj");
    run.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(800));
    CHECK(run.end(SIGINT) == 130);
    CHECK_FALSE(folder.holds("out/report.json"));
}

TEST_CASE("two signals at once are one, on several threads too") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const std::vector<std::string> arguments = {"run",   "sheet.toml",
                                                "-o",    "out",
                                                "--set", "cloth.sheet.grid.vertices=[61, 61]",
                                                "--set", "cloth.sheet.pin=[0, 60]",
                                                "--set", "step.threads=3",
                                                "--set", "duration=1000"};
    StartedRun run(folder, arguments);
    run.wait_for(folder, "out/frames/sheet_00000.obj");
    run.send(SIGINT);
    CHECK(run.end(SIGTERM) == 130);
    CHECK(nlohmann::json::parse(folder.read("out/report.json")).at("status") == "stopped");
}
