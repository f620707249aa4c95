#include <signal.h>

#include <array>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "scenes/program/stop_signals.h"
#include "tests/scenes/program/run_program.h"
#include "tests/scenes/program/started_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::stop_signals_test {
using percale::scenes::test::falling_sheet;

namespace {

/// Starts a run of a falling sheet with other settings, and waits until it has written a frame.
std::unique_ptr<StartedRun> started(const TestFolder& folder, std::span<const std::string> settings) {
    folder.write("sheet.toml", falling_sheet());
    std::vector<std::string> arguments = {"run", "sheet.toml", "-o", "out", "--fps", "1"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    auto run = std::make_unique<StartedRun>(folder, arguments);
    run->wait_for(folder, "out/frames/sheet_00000.obj");
    REQUIRE(folder.holds("out/frames/sheet_00000.obj"));
    return run;
}

}  // namespace

TEST_CASE("a run that is interrupted or terminated finishes its step, writes its report and says so") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const TestFolder folder;
        CHECK(started(folder, std::array<std::string, 2>{"duration=10000", "step.time_step=1e-5"})->end(signal) == 130);
        const auto report = nlohmann::json::parse(folder.read("out/report.json"));
        CHECK(report.at("status") == "stopped");
        const int steps = report.at("steps");
        CHECK(steps >= 1);
        const std::string table = folder.read("out/steps.csv");
        CHECK(line_count(table) == steps + 1);
    }
}

/// A step takes a minute.
const std::array<std::string, 6> long_step{
    "cloth.sheet.grid.vertices=[401, 401]", "cloth.sheet.pin=[0, 400]", "step.scheme=backward_euler",
    "step.newton_tolerance=1e-10",          "step.time_step=1",         "duration=1000"};

TEST_CASE("a step that takes long is not waited for: it is taken back, and the report says when the run was stopped") {
    const TestFolder folder;
    const auto run = started(folder, long_step);
    const auto asked = std::chrono::steady_clock::now();
    CHECK(run->end(SIGTERM) == 130);
    // A second in a release build on a machine that is free; the step itself would take a minute.
    CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(20));
    const auto report = nlohmann::json::parse(folder.read("out/report.json"));
    CHECK(report.at("status") == "stopped");
    CHECK(report.at("reason") == "stopped at 0 of 1e+03 s, within a step");
    CHECK(report.at("steps") == 0);
    CHECK(line_count(folder.read("out/steps.csv")) == 1);
}

TEST_CASE("a comparison or a stress test whose steps take long is not waited for, and leaves nothing") {
    for (const char* command : {"compare", "stress"}) {
        const TestFolder folder;
        folder.write("sheet.toml", falling_sheet());
        std::vector<std::string> arguments = {command,     "sheet.toml",     "-o",      "out/deep", "--quiet",
                                              "--schemes", "backward_euler", "--steps", "1"};
        for (const std::string& setting : long_step) arguments.insert(arguments.end(), {"--set", setting});
        StartedRun run(folder, arguments);
        run.wait_for_signals();
        const auto asked = std::chrono::steady_clock::now();
        CHECK(run.end(SIGTERM) == 130);
        CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(20));
        CHECK(folder.file_count() == 1);
    }
}

TEST_CASE("a second signal ends a run at once") {
    const TestFolder folder;
    const auto run = started(folder, long_step);
    run->send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(520));
    CHECK(run->end(SIGINT) == 130);
}

TEST_CASE("what is prepared and cannot be asked ends with the program once a signal is overdue") {
    const TestFolder folder;
    for (const bool preparing : {true, false}) {
        const pid_t child = fork();
        if (child == 0) {
            const StopSignals signals;
            const auto wait = [&] {
                kill(getpid(), SIGTERM);
                while (preparing || !signals.overdue()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                return signals.asked() ? 5 : 6;
            };
            _exit(preparing ? signals.prepare(wait) : wait());
        }
        int status = 0;
        waitpid(child, &status, 0);
        CHECK(WEXITSTATUS(status) == (preparing ? 130 : 5));
    }
}

TEST_CASE("while one of several jobs is still at work, what another one prepares does not end the program") {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    if (child == 0) {
        const StopSignals signals;
        std::thread worker([&] {
            signals.job([&] {
                while (!signals.overdue()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                std::this_thread::sleep_for(std::chrono::milliseconds(300));
                if (write(ends[1], "x", 1) != 1) _exit(7);
            });
        });
        signals.job([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the other one has begun
            kill(getpid(), SIGTERM);
            signals.prepare([] { std::this_thread::sleep_for(std::chrono::minutes(5)); });
        });
        worker.join();
        _exit(8);
    }
    close(ends[1]);
    char letter = 0;
    CHECK(read(ends[0], &letter, 1) == 1);
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WEXITSTATUS(status) == 130);
    close(ends[0]);
}

TEST_CASE("two signals at once are one, on several threads too") {
    const TestFolder folder;
    // A step below symplectic Euler's limit (1.6 ms here): the sheet must not fail before the signals come.
    const std::array<std::string, 5> threads{"cloth.sheet.grid.vertices=[61, 61]", "cloth.sheet.pin=[0, 60]", "step.threads=3",
                                             "step.time_step=1e-4", "duration=1000"};
    const auto run = started(folder, threads);
    run->send(SIGINT);
    CHECK(run->end(SIGTERM) == 130);
    CHECK(nlohmann::json::parse(folder.read("out/report.json")).at("status") == "stopped");
}

}  // namespace percale::program::test::stop_signals_test
