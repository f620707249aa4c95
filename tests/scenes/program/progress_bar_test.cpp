#include "scenes/program/progress_bar.h"

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <string>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::progress_bar_test {
using percale::scenes::test::falling_sheet;

namespace {

struct TerminalRun {
    int exit_code = -1;
    std::string text;
};

/// Runs the program with a terminal as its output; nothing where the system has no pseudo-terminals to give.
std::optional<TerminalRun> run_on_terminal(const TestFolder& folder, const char* option) {
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child < 0) {
        WARN("not tested: no pseudo-terminal (is /dev/pts mounted?)");
        return std::nullopt;
    }
    if (child == 0) {
        if (chdir(folder.path().c_str()) == 0)
            execl(PERCALE_PROGRAM, PERCALE_PROGRAM, "run", "sheet.toml", "-o", "out", option, nullptr);
        _exit(99);
    }
    TerminalRun run;
    char buffer[4096];
    for (ssize_t size = read(terminal, buffer, sizeof buffer); size > 0; size = read(terminal, buffer, sizeof buffer))
        run.text.append(buffer, static_cast<std::size_t>(size));
    int status = 0;
    waitpid(child, &status, 0);
    close(terminal);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return run;
}

}  // namespace

TEST_CASE("on a terminal a bar shows the part that is done and the time that is left, and is wiped at the end") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const std::optional<TerminalRun> run = run_on_terminal(folder, "--replay-hash");
    if (!run) return;
    CHECK(run->exit_code == 0);
    // The first of ten steps: 10 % of 30 marks are 3.
    CHECK(run->text.find("[###...........................]  10 %  0.01 of 0.10 s  ETA 0:0") != std::string::npos);
    const std::size_t wiped = run->text.rfind("\r\033[K");
    REQUIRE(wiped != std::string::npos);
    CHECK(run->text.find("finished", wiped) != std::string::npos);
    CHECK(run->text.find("ETA", wiped) == std::string::npos);
}

TEST_CASE("a bar counts whole things, too") {
    CHECK(percale::program::progress_text(500.0, 2000.0, 10.0, {.name = "cells", .decimals = 0}) ==
          "[#######.......................]  25 %  500 of 2000 cells  ETA 0:30");
}

TEST_CASE("a quiet run draws no bar on a terminal") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const std::optional<TerminalRun> run = run_on_terminal(folder, "--quiet");
    if (!run) return;
    CHECK(run->exit_code == 0);
    CHECK(run->text.empty());
}

TEST_CASE("in a log every tenth that takes its time has a line, the end none") {
    for (const double seconds : {0.0, 1000.0}) {
        std::FILE* file = std::tmpfile();
        REQUIRE(file != nullptr);
        {
            percale::program::ProgressBar bar(true, 4.0, {}, {.file = file, .min_seconds = seconds});
            for (int k = 0; k <= 400; ++k) bar.show(0.01 * k);
        }
        std::rewind(file);
        std::vector<std::string> lines;
        for (char line[200]; std::fgets(line, sizeof line, file) != nullptr;) lines.emplace_back(line);
        std::fclose(file);
        if (seconds > 0.0) {
            CHECK(lines.empty());
            continue;
        }
        REQUIRE(lines.size() == 9);
        CHECK(lines[0].find("[###...........................]  10 %  0.40 of 4.00 s  ETA 0:00\n") == 0);
        CHECK(lines[8].find("]  90 %  3.60 of 4.00 s") != std::string::npos);
    }
}

TEST_CASE("a short run without a terminal shows no progress") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const ProgramRun run = run_program({"run", "sheet.toml", "-o", "out"}, folder.path());
    CHECK(run.error.empty());
    CHECK(run.out.find("ETA") == std::string::npos);
    CHECK(line_count(run.out) == 2);
}

}  // namespace percale::program::test::progress_bar_test
