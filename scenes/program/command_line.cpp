#include "program/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
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
                                           "picture", "render", "replay", "report",  "sew",     "stress", "study",   "sweep"};

/// Says what is wrong with a command name better than the parser, which takes it for a stray argument.
void check_command_name(const std::string& word) {
    if (word.empty() || word.front() == '-' || std::find(commands.begin(), commands.end(), word) != commands.end()) return;
    throw SceneError("no such command '" + word + "'" + scenes::suggestion(word, commands));
}

/// "help" and "help run" are "--help" and "run --help".
std::vector<std::string> with_help_option(std::vector<std::string> words) {
    if (words.empty() || words.front() != "help") return words;
    words.erase(words.begin());
    if (!words.empty() && words.front() == "help") words.erase(words.begin());
    words.emplace_back("--help");
    return words;
}

bool is_number(const std::string& word) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    return !word.empty() && end == word.c_str() + word.size() && std::isfinite(number);
}

std::vector<std::string> split_at_commas(const std::string& word) {
    std::vector<std::string> parts;
    std::istringstream rest(word);
    for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
    return parts;
}

/// The parser takes whatever follows, and says little of it. Numbers may have commas between them, "0,1.5,0".
void check_three_numbers(const std::vector<std::string>& words, const std::string& option) {
    const auto found = std::find_if(words.begin(), words.end(),
                                    [&](const std::string& word) { return word == option || word.starts_with(option + "="); });
    std::vector<std::string> three(found, words.end());
    if (three.empty() || three == std::vector{option}) return;
    if (three[0] == option) {
        three.erase(three.begin());
    } else {
        three[0].erase(0, option.size() + 1);
    }
    if (three[0].find(',') != std::string::npos) {
        three = split_at_commas(three[0]);
    } else {
        three.resize(std::min<std::size_t>(three.size(), 3));
    }
    const auto wrong = std::find_if_not(three.begin(), three.end(), is_number);
    if (wrong == three.end() && three.size() == 3) return;
    const std::string what = wrong == three.end()
                                 ? std::to_string(three.size()) + (three.size() == 1 ? " is given" : " are given")
                                 : "'" + *wrong + "' is no number" + scenes::number_advice(*wrong);
    throw SceneError(option + " takes three numbers, as in " + option + " 0 1.5 0, but " + what);
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
    add_doctor_command(program, action);
    add_picture_command(program, action);
    add_replay_command(program, action);
    add_report_command(program, action);
    add_sew_command(program, action);
    add_study_commands(program, action);
    std::vector<std::string> words = with_help_option({argv + 1, argv + argc});
    if (!words.empty()) check_command_name(words.front());
    const bool drapes = !words.empty() && words.front() == "drape";
    if (drapes) check_three_numbers(words, "--move"), check_three_numbers(words, "--rotate");
    std::reverse(words.begin(), words.end());  // as the parser takes them
    try {
        program.parse(words);
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
