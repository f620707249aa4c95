#include "compare/compare.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "common/text.h"
#include "common/whole_file.h"
#include "compare/compare_report.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"
#include "program/stop_signals.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct CompareOptions {
    CommonOptions common;
    std::string scene, folder;
    std::vector<std::string> schemes, steps, tolerances;
    int repeats = 3;
    double reference_error = 1e-9;
};

CompareSettings settings_of(const CompareOptions& options) {
    if (options.repeats < 1 || options.repeats > 1000)
        throw SceneError("--repeats " + std::to_string(options.repeats) + " is outside the allowed range 1 ... 1000");
    if (!(options.reference_error >= 1e-14 && options.reference_error <= 1.0))
        throw SceneError("--reference-error " + number_text(options.reference_error) +
                         " is outside the allowed range 1e-14 ... 1 m");
    return {.schemes = options.schemes,
            .steps = read_numbers("--steps", options.steps),
            .tolerances = read_numbers("--tolerances", options.tolerances),
            .repeats = options.repeats,
            .reference_error = options.reference_error};
}

/// Checks every word and number as the key of the scene file that it stands for.
void check_settings(const CompareSettings& settings, const SceneSource& source) {
    check_once("--schemes", settings.schemes);
    check_as_key(source, "step.scheme", "--schemes", settings.schemes);
    check_as_key(source, "step.time_step", "--steps", settings.steps);
    check_as_key(source, "step.tolerance", "--tolerances", settings.tolerances);
}

void print(const Comparison& comparison, const std::string& folder) {
    std::fputs(comparison_table(comparison).c_str(), stdout);
    for (const std::string& sentence : advice(comparison)) std::printf("%s\n", sentence.c_str());
    std::printf("%s/compare.csv, %s/compare.svg\n", folder.c_str(), folder.c_str());
}

Comparison compared(const CompareOptions& options, const CompareSettings& settings, const SceneSource& source,
                    const StopSignals& signals) {
    CompareHooks hooks;
    hooks.stop_asked = [&] { return signals.asked(); };
    hooks.reference_made = [&](const Reference& reference) {
        if (options.common.quiet) return;
        std::fputs(reference_text(reference).c_str(), stdout);
        std::fflush(stdout);
    };
    return compare_scene(source, settings, hooks);
}

int compare_into(const std::string& folder, const CompareOptions& options, const CompareSettings& settings,
                 const SceneSource& source) {
    TableFiles{folder, "compare"};  // that they cannot be written is reported before anything is run
    const StopSignals signals;
    try {
        // Nothing is there yet that a kill would leave half made.
        const Comparison comparison = signals.prepare([&] { return compared(options, settings, source, signals); });
        TableFiles files(folder, "compare");
        files.table.out() << comparison_csv(comparison);
        files.diagram.out() << plot_svg(comparison_plot(comparison));
        files.commit();
        if (!options.common.quiet) print(comparison, folder);
        const bool any = std::any_of(comparison.runs.begin(), comparison.runs.end(),
                                     [](const ComparedRun& run) { return run.run.end == VariantEnd::finished; });
        return any ? all_well : not_as_expected;
    } catch (const ComparisonStopped&) {
        std::fprintf(stderr, "percale: %s: stopped; nothing is written\n", options.scene.c_str());
        return stopped_by_signal;
    }
}

int compare(const CompareOptions& options) {
    const CompareSettings settings = settings_of(options);
    const SceneSource source = scene_source(options.scene, options.common);
    check_settings(settings, source);
    demand_duration(source({}));
    build_scene(source({}));  // what is wrong with the scene itself is reported before anything is written
    return compare_into(options.folder.empty() ? default_folder(options.scene) : options.folder, options, settings, source);
}

}  // namespace

void add_compare_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = program.add_subcommand("compare", "Error of schemes and steps against their run time");
    command->footer(
        "Example: percale compare data/scenes/hang.toml --set duration=0.5 --schemes rk4,backward_euler "
        "--steps 1/60,1/240,1/3840 -o out");
    command->add_option("SCENE", options->scene, "Scene file (TOML)")->required();
    command->add_option("--schemes", options->schemes, "Words of step.scheme (default: all that take the scene)")
        ->delimiter(',')
        ->type_name("A,B");
    command->add_option("--steps", options->steps, "Time steps in s, 1/240 or 0.004 (default: four of each scheme)")
        ->delimiter(',')
        ->type_name("S1,S2");
    command->add_option("--tolerances", options->tolerances, "Tolerances of adaptive steps in m/s (step.tolerance)")
        ->delimiter(',')
        ->type_name("T1,T2");
    command->add_option("--repeats", options->repeats, "Runs of each; the fastest counts (default 3)")->type_name("N");
    command
        ->add_option("--reference-error", options->reference_error, "Error in m that the reference is refined to (default 1e-9)")
        ->type_name("M");
    command->add_option("-o", options->folder, "Output folder (default: the scene's name)")->type_name("DIR");
    command->add_option("--threads", options->common.threads, "Threads of the simulation (step.threads)")->type_name("N");
    command->add_flag("--quiet", options->common.quiet, "Print nothing but errors");
    add_scene_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace percale::program
