#include "program/study.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <type_traits>

#include "common/nearest_name.h"
#include "common/text.h"
#include "common/whole_file.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"
#include "study/run_variants.h"
#include "study/study.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

/// A study that is also a command of its own.
struct Preset {
    const char *name, *sentence, *example;
    const char *file, *file_text;
    bool needs_file;
    std::vector<std::string> takes;  // beside its file, -o and --quiet
    int (*act)(const StudyOptions&);
};

const std::array<Preset, 3> presets = {
    {{"compare",
      "Error of schemes and steps against their run time",
      "Example: percale compare data/scenes/hang.toml --set duration=0.5 --schemes rk4,backward_euler --steps 1/60,1/240,1/3840 "
      "-o out",
      "SCENE",
      "Scene file (TOML)",
      true,
      {"--schemes", "--steps", "--tolerances", "--repeats", "--reference-error", "--threads", "--set", "--no-skip"},
      compare},
     {"stress",
      "Where schemes are stable, and whether what is not says so",
      "Without SCENE: small cloths, time steps of 1e-4 ... 1 s, stiffness of 1 ... 1e8 N/m, mass ratios to 1e6, damping, "
      "slivers,\n"
      "hard starts, contact. Exit code 1 if backward_euler or tr_bdf2 failed, or any scheme without a word.\n"
      "Example: percale stress data/scenes/hang.toml --schemes rk4,backward_euler --steps 1e-3,1e-2 --factors 1,100 -o out",
      "SCENE",
      "Scene file (TOML); without one the default matrix is run",
      false,
      {"--schemes", "--steps", "--factors", "--most-steps", "--cell", "--jobs", "--set", "--no-skip"},
      stress},
     {"sweep",
      "Run a scene with many values of its keys; one table of what comes out",
      "Examples: percale sweep study.toml -o study --jobs 8\n          percale sweep study.toml -o study --slurm",
      "STUDY",
      "Study file (TOML), or the folder of one that was begun",
      true,
      {"--jobs", "--slurm", "--run", "--collect"},
      sweep}}};

bool holds(const std::vector<std::string>& words, const std::string& word) {
    return std::ranges::find(words, word) != words.end();
}

/// Those of the options of studies that are taken.
void add_study_options(CLI::App& command, StudyOptions& options, const std::vector<std::string>& takes) {
    const auto add = [&](const char* name, auto& value, const char* type, const char* text) {
        if (!holds(takes, name)) return;
        CLI::Option* option = command.add_option(name, value, text)->type_name(type);
        if constexpr (std::is_same_v<decltype(value), std::vector<std::string>&>) option->delimiter(',');
    };
    add("--schemes", options.schemes, "A,B", "Words of step.scheme (default: all, of compare those that take the scene)");
    add("--steps", options.steps, "S1,S2",
        "Time steps of a scene in s, as 1/240 (default: compare 4 of each scheme, stress 1e-4 ... 1)");
    add("--tolerances", options.tolerances, "T1,T2", "Tolerances of adaptive steps in m/s (step.tolerance)");
    add("--factors", options.factors, "F1,F2", "Factors on a scene's stiffness (default 1e-2 ... 1e4)");
    add("--repeats", options.repeats, "N", "Runs of each; the fastest counts (default 3)");
    add("--reference-error", options.reference_error, "M", "Error in m that the reference is refined to (default 1e-9)");
    add("--most-steps", options.max_steps, "N",
        "Steps of a cell, at most (default 16; of explicit schemes in the matrix 8 times as many)");
    add("--cell", options.cell, "N", "Only this cell of the default matrix, as stress.csv numbers them");
    add("--jobs", options.jobs, "N", "Variants run at a time (default 1)");
    add("--run", options.range, "FIRST-LAST", "Only these runs, and no tables");
    add("--threads", options.common.threads, "N", "Threads of the simulation (step.threads)");
    if (holds(takes, "--slurm"))
        command.add_flag("--slurm", options.slurm, "Submit the runs as a Slurm job array instead of doing them here");
    if (holds(takes, "--collect")) command.add_flag("--collect", options.collect, "Only gather the tables of what is done");
    if (holds(takes, "--set")) add_scene_options(command, options.common);
    command
        .add_option("-o", options.folder,
                    "Output folder (default: the file's name; of stress without a file stress or stress_cell_N)")
        ->type_name("DIR");
    command.add_flag("--quiet", options.common.quiet, "Print nothing but errors");
}

/// The preset that is named, or else that of the file's kind.
const Preset& preset_of(const StudyOptions& options) {
    if (options.preset.empty()) {
        if (options.file.empty()) throw SceneError("FILE: is needed; --preset stress alone has a study of its own");
        if (std::filesystem::is_directory(options.file) || is_study_file(options.file)) return presets.back();
        throw SceneError(options.file + ": is not a study file; for a scene use --preset compare or --preset stress");
    }
    const auto found = std::ranges::find(presets, options.preset, &Preset::name);
    if (found == presets.end()) {
        std::vector<std::string> names;
        for (const Preset& preset : presets) names.emplace_back(preset.name);
        throw SceneError("--preset " + options.preset + ": no such preset" + suggestion(options.preset, names));
    }
    if (found->needs_file && options.file.empty()) throw SceneError("FILE: is needed by --preset " + options.preset);
    return *found;
}

/// Throws SceneError for an option that was given and that the preset does not take.
void check_taken(const CLI::App& command, const Preset& preset) {
    std::vector<std::string> takes = preset.takes;
    takes.insert(takes.end(), {"--preset", "--quiet"});
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            if (option->count() > 0 && !holds(takes, "--" + name))
                throw SceneError("--" + name + ": --preset " + preset.name + " does not take this option; it takes " +
                                 joined(preset.takes));
}

}  // namespace

int write_outcome(const StudyOptions& options, const std::string& folder, const std::string& name,
                  const std::function<StudyOutcome(const StopSignals&)>& make) {
    TableFiles{folder, name};  // that they cannot be written is reported before anything is run
    const StopSignals signals;
    try {
        // Nothing is there yet that a kill would leave half made.
        const StudyOutcome outcome = signals.prepare([&] { return make(signals); });
        TableFiles files(folder, name);
        files.table.out() << outcome.csv;
        files.diagram.out() << outcome.svg;
        files.commit();
        const std::string path = folder + "/" + name;
        if (!options.common.quiet) std::printf("%s%s.csv, %s.svg\n", outcome.text.c_str(), path.c_str(), path.c_str());
        return outcome.well ? all_well : not_as_expected;
    } catch (const StudyStopped&) {
        std::fprintf(stderr, "percale: %s: stopped; nothing is written\n", (options.file.empty() ? name : options.file).c_str());
        return stopped_by_signal;
    }
}

void add_study_commands(CLI::App& program, Action& action) {
    std::vector<std::string> all;
    for (const Preset& preset : presets) {
        auto options = std::make_shared<StudyOptions>();
        CLI::App* command = program.add_subcommand(preset.name, preset.sentence);
        command->footer(preset.example);
        command->add_option(preset.file, options->file, preset.file_text)->required(preset.needs_file);
        add_study_options(*command, *options, preset.takes);
        command->callback([options, act = preset.act, &action] { action = [options, act] { return act(*options); }; });
        for (const std::string& option : preset.takes)
            if (!holds(all, option)) all.push_back(option);
    }
    auto options = std::make_shared<StudyOptions>();
    CLI::App* command = program.add_subcommand("study", "Run variants of a scene: the presets compare, stress and sweep");
    command->footer(
        "Without --preset a study file, or the folder of a study, is a sweep. Each preset takes the options of the command of "
        "its name.\nExamples: percale study study.toml --jobs 8\n          percale study data/scenes/hang.toml --preset compare");
    command->add_option("FILE", options->file, "Study file, its folder, or with --preset compare or stress a scene file");
    command->add_option("--preset", options->preset, "compare, stress or sweep")->type_name("NAME");
    add_study_options(*command, *options, all);
    command->callback([options, command, &action] {
        action = [options, command] {
            const Preset& preset = preset_of(*options);
            check_taken(*command, preset);
            return preset.act(*options);
        };
    });
}

}  // namespace percale::program
