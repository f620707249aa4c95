#include "compare/replay.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct ReplayOptions {
    std::string first, second;
};

int replay(const ReplayOptions& options) {
    const StepRows first = read_hashed_steps(options.first), second = read_hashed_steps(options.second);
    const ReplayDifference difference = compare_steps(first, second);
    if (difference.step != 0) {
        std::printf("step %zu at %s s: %s is %s in %s, %s in %s; %zu steps before it are the same\n", difference.step,
                    difference.time.c_str(), difference.what.c_str(), difference.first.c_str(), options.first.c_str(),
                    difference.second.c_str(), options.second.c_str(), difference.step - 1);
        return not_as_expected;
    }
    if (first.lines.size() != second.lines.size()) {
        std::printf("%s has %zu steps, %s %zu; the %zu of both are the same\n", options.first.c_str(), first.lines.size(),
                    options.second.c_str(), second.lines.size(), difference.steps_of_both);
        return not_as_expected;
    }
    std::printf("the same: %zu steps\n", first.lines.size());
    return all_well;
}

}  // namespace

void add_replay_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command =
        program.add_subcommand("replay", "Compare two runs step by step, in every bit; name the first difference");
    command->footer(
        "Exit code 0: the same, 1: they differ, 2: wrong input. Both runs need --replay-hash.\n"
        "Example: percale replay out1 out2");
    command->add_option("RUN", options->first, "Folder of a run, or its steps.csv")->required();
    command->add_option("OTHER", options->second, "The same of the run to compare with")->required();
    command->callback([options, &action] { action = [options] { return replay(*options); }; });
}

}  // namespace percale::program
