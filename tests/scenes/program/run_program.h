#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/scenes/test_folder.h"

namespace percale::program::test {

using scenes::test::TestFolder;

struct ProgramRun {
    int exit_code = -1;
    std::string out, error;
};

inline std::string quoted(const std::string& word) {
    std::string result = "'";
    for (const char letter : word) result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return result + "'";
}

/// Runs the built program with these arguments in a folder. Output and errors are kept outside of it.
inline ProgramRun run_program(const std::vector<std::string>& arguments, const std::string& in_folder = "/tmp") {
    const TestFolder capture;
    std::string command = "cd " + quoted(in_folder) + " && exec " + quoted(PERCALE_PROGRAM);
    for (const std::string& argument : arguments) command += " " + quoted(argument);
    command += " >" + quoted(capture.path("out")) + " 2>" + quoted(capture.path("error"));
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), capture.read("out"), capture.read("error")};
}

inline int line_count(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

/// Whether a run was refused the way wrong input has to be: exit code 2, one message on stderr that holds `part`, no output.
inline bool refused(const ProgramRun& run, const std::string& part) {
    return run.exit_code == 2 && run.out.empty() && run.error.rfind("percale: ", 0) == 0 && line_count(run.error) == 1 &&
           run.error.find(part) != std::string::npos;
}

}  // namespace percale::program::test
