#include "program/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

const std::vector<std::string> commands = {"run",     "plan",   "check",  "explain", "certify", "drape",  "compare", "doctor",
                                           "picture", "render", "replay", "report",  "sew",     "stress", "sweep"};

/// Says what is wrong with a command name better than the parser, which takes it for a stray argument.
void check_command_name(const std::string& word) {
    if (word.empty() || word.front() == '-' || std::find(commands.begin(), commands.end(), word) != commands.end()) return;
    throw SceneError("no such command '" + word + "'" + scenes::suggestion(word, commands));
}

/// Three numbers after an option are words or have commas between them. With both, as in "0 1,5 0", a comma was meant as a point.
void check_commas(const std::vector<std::string>& words) {
    for (const char* option : {"--move", "--rotate"}) {
        const auto found = std::find(words.begin(), words.end(), option);
        if (words.end() - found < 3 || found[1].find(',') != std::string::npos) continue;
        for (const std::string& word : {found[2], words.end() - found > 3 ? found[3] : std::string()})
            if (const std::string advice = scenes::number_advice(word); !advice.empty())
                throw SceneError(std::string(option) + " " + found[1] + " " + found[2] + " ...: '" + word + "' is no number" +
                                 advice);
    }
}

/// "Could not convert: --thickness = 5mm" and what to write instead.
std::string conversion_text(const std::string& what) {
    const std::size_t value = what.find(" = ");
    return what + (value == std::string::npos ? "" : scenes::number_advice(what.substr(value + 3)));
}

/// Words that no option and no argument takes: the first that looks like an option, else the first, is named.
[[noreturn]] void fail_unexpected(const CLI::App& program) {
    const std::vector<std::string> words = program.remaining(true);
    const auto option = std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.starts_with("--"); });
    if (option == words.end()) throw SceneError("unexpected argument '" + words.at(0) + "' (see --help)");
    std::vector<std::string> valid;
    for (const CLI::App* command : program.get_subcommands())
        for (const CLI::Option* known : command->get_options())
            for (const std::string& name : known->get_lnames()) valid.push_back("--" + name);
    const std::string name = option->substr(0, option->find('='));
    throw SceneError("no such option '" + name + "'" + scenes::did_you_mean(name, valid) + " (see --help)");
}

/// What was printed has also arrived: a report cut off by a full disk must not look like a good one.
void check_output() {
    std::cout.flush();
    if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
    throw SceneError("the standard output cannot be written");
}

int parse_and_act(int argc, char** argv) {
    CLI::App program("Simulates cloth over mesh obstacles, rigid or bending.", "percale");
    program.footer("Example: percale run data/scenes/poncho_on_mannequin.toml\n`percale COMMAND --help` says more.");
    program.set_version_flag("--version", "percale " PERCALE_VERSION);
    program.require_subcommand(1);
    Action action;
    add_run_command(program, action);
    add_plan_command(program, action);
    add_check_command(program, action);
    add_explain_command(program, action);
    add_certify_command(program, action);
    add_drape_command(program, action);
    add_compare_command(program, action);
    add_doctor_command(program, action);
    add_picture_command(program, action);
    add_replay_command(program, action);
    add_report_command(program, action);
    add_sew_command(program, action);
    add_stress_command(program, action);
    add_sweep_command(program, action);
    if (argc > 1) check_command_name(argv[1]);
    check_commas({argv, argv + argc});
    try {
        program.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
        fail_unexpected(program);
    } catch (const CLI::ConversionError& error) {
        throw SceneError(conversion_text(error.what()) + " (see --help)");
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);
        throw SceneError(std::string(error.what()) + " (see --help)");
    }
    const int exit_code = action();
    check_output();
    return exit_code;
}

}  // namespace

int run_program(int argc, char** argv) {
    try {
        return parse_and_act(argc, argv);
    } catch (const SceneError& error) {
        std::fprintf(stderr, "percale: %s\n", error.what());
        return wrong_input;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "percale: internal error: %s\n", error.what());
        return internal_error;
    }
}

}  // namespace percale::program
