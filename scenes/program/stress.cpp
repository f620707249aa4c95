#include "stress/stress.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "common/text.h"
#include "common/whole_file.h"
#include "compare/compare.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/stop_signals.h"
#include "stress/stress_report.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

constexpr int reported_failures = 10;

struct StressOptions {
    CommonOptions common;
    std::string scene, folder;
    std::vector<std::string> schemes, time_steps, factors;
    int steps = usual_steps, cell = -1;
};

/// What only scenes take, and what only the matrix takes.
void check_kind(const StressOptions& options) {
    const auto only_scenes = [](const char* option, bool given) {
        if (given) throw SceneError(std::string(option) + ": only with a scene; the default matrix has its own");
    };
    if (!options.scene.empty()) {
        if (options.cell >= 0) throw SceneError("--cell: only cells of the default matrix have numbers");
        return;
    }
    only_scenes("--steps", !options.time_steps.empty());
    only_scenes("--factors", !options.factors.empty());
    if (!options.common.set.empty()) throw SceneError("--set: without a scene there is nothing to set");
    if (options.common.no_skip) throw SceneError("--no-skip: without a scene there is nothing to set");
    if (options.cell >= 0 && !options.schemes.empty())
        throw SceneError("--cell: the cell has its own scheme; leave out --schemes");
}

void check(const StressOptions& options) {
    check_kind(options);
    if (options.steps < 1 || options.steps > 1000000)
        throw SceneError("--most-steps " + std::to_string(options.steps) + " is outside the allowed range 1 ... 1000000");
    for (const double factor : read_numbers("--factors", options.factors))
        if (!(factor >= 1e-9 && factor <= 1e9))
            throw SceneError("--factors " + number_text(factor) + " is outside the allowed range 1e-9 ... 1e9");
    check_once("--schemes", options.schemes);
}

SceneStress settings_of(const StressOptions& options) {
    SceneStress settings{.schemes = options.schemes, .steps = options.steps};
    if (!options.time_steps.empty()) settings.time_steps = read_numbers("--steps", options.time_steps);
    if (!options.factors.empty()) settings.factors = read_numbers("--factors", options.factors);
    return settings;
}

/// The cells of the default matrix that are asked for.
std::vector<StressCell> wanted_cells(const StressOptions& options) {
    std::vector<StressCell> cells = stress_matrix();
    if (options.cell >= static_cast<int>(cells.size()))
        throw SceneError("--cell " + std::to_string(options.cell) + " is outside the allowed range 0 ... " +
                         std::to_string(cells.size() - 1));
    if (options.cell >= 0) return {cells[static_cast<std::size_t>(options.cell)]};
    const std::vector<std::string> words = scheme_words();
    for (const std::string& scheme : options.schemes)
        if (std::find(words.begin(), words.end(), scheme) == words.end())
            throw SceneError("--schemes " + scheme + ": no such scheme; valid: " + joined(words));
    if (options.schemes.empty()) return cells;
    std::erase_if(cells, [&](const StressCell& cell) {
        const std::string& word = words[static_cast<std::size_t>(cell.scheme)];
        return std::find(options.schemes.begin(), options.schemes.end(), word) == options.schemes.end();
    });
    return cells;
}

StressRun made_run(const StressOptions& options, const SceneSource& source, const StopSignals& signals) {
    StressHooks hooks;
    hooks.stop_asked = [&] { return signals.asked(); };
    std::optional<ProgressBar> bar;
    hooks.progress = [&](int made, int all) {
        if (!bar) bar.emplace(!options.common.quiet, all, ProgressUnit{.name = "cells", .decimals = 0});
        bar->show(made);
    };
    return options.scene.empty() ? stress_cells(wanted_cells(options), options.steps, hooks)
                                 : stress_scene(source, settings_of(options), hooks);
}

std::string folder_name(const StressOptions& options) {
    if (!options.folder.empty()) return options.folder;
    if (!options.scene.empty()) return default_folder(options.scene);
    return options.cell >= 0 ? "stress_cell_" + std::to_string(options.cell) : "stress";
}

void print(const StressOptions& options, const StressRun& run, const std::string& folder) {
    std::printf("%zu cell%s of at most %d steps", run.rows.size(), run.rows.size() == 1 ? "" : "s", run.steps);
    std::printf(run.of_scene ? "\n" : ", of explicit schemes %d\n", explicit_factor * run.steps);
    std::fputs(stress_summary(run).c_str(), stdout);
    std::fputs(stress_failures(run, reported_failures).c_str(), stdout);
    if (run.failures() > 0 && options.scene.empty())
        std::printf("failures: %d; `percale stress --cell N` repeats cell N\n", run.failures());
    std::printf("%s/stress.csv, %s/stress.svg\n", folder.c_str(), folder.c_str());
}

int stress(const StressOptions& options) {
    check(options);
    const SceneSource source = scene_source(options.scene, options.common);
    if (options.scene.empty()) {
        wanted_cells(options);
    } else {
        check_as_key(source, "step.scheme", "--schemes", options.schemes);
        check_as_key(source, "step.time_step", "--steps", read_numbers("--steps", options.time_steps));
        build_scene(source({}));  // what is wrong with the scene itself is reported before anything is written
    }
    const std::string name = folder_name(options);
    TableFiles{name, "stress"};  // that they cannot be written is reported before anything is run
    const StopSignals signals;
    try {
        const StressRun run = signals.prepare([&] { return made_run(options, source, signals); });
        TableFiles files(name, "stress");
        files.table.out() << stress_csv(run);
        files.diagram.out() << map_svg(stress_map(run));
        files.commit();
        if (!options.common.quiet) print(options, run, name);
        return run.failures() > 0 ? not_as_expected : all_well;
    } catch (const ComparisonStopped&) {
        std::fprintf(stderr, "percale: stress: stopped; nothing is written\n");
        return stopped_by_signal;
    }
}

}  // namespace

void add_stress_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<StressOptions>();
    CLI::App* command = program.add_subcommand("stress", "Where schemes are stable, and whether what is not says so");
    command->footer(
        "Without SCENE: small cloths, time steps of 1e-4 ... 1 s, stiffness of 1 ... 1e8 N/m, mass ratios to 1e6, damping, "
        "slivers,\n"
        "hard starts, contact. Exit code 1 if backward_euler or tr_bdf2 failed, or any scheme without a word.\n"
        "Example: percale stress data/scenes/hang.toml --schemes rk4,backward_euler --steps 1e-3,1e-2 --factors 1,100 -o out");
    command->add_option("SCENE", options->scene, "Scene file (TOML); without one the default matrix is run");
    command->add_option("--schemes", options->schemes, "Words of step.scheme (default: all)")->delimiter(',')->type_name("A,B");
    command->add_option("--steps", options->time_steps, "Time steps of a scene in s (default 1e-4 ... 1)")
        ->delimiter(',')
        ->type_name("S1,S2");
    command->add_option("--factors", options->factors, "Factors on a scene's stiffness (default 1e-2 ... 1e4)")
        ->delimiter(',')
        ->type_name("F1,F2");
    command
        ->add_option("--most-steps", options->steps,
                     "Steps of a cell, at most (default 16); of an explicit scheme in the default matrix 8 times as many")
        ->type_name("N");
    command->add_option("--cell", options->cell, "Only this cell of the default matrix, as stress.csv numbers them")
        ->type_name("N");
    command->add_option("-o", options->folder, "Output folder (default: the scene's name; stress, or stress_cell_N)")
        ->type_name("DIR");
    command->add_flag("--quiet", options->common.quiet, "Print nothing but errors");
    add_scene_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return stress(*options); }; });
}

}  // namespace percale::program
