#include "compare/compare.h"

#include <algorithm>
#include <cstdio>

#include "compare/compare_report.h"
#include "program/study.h"

namespace percale::program {

using namespace percale::scenes;

int compare(const StudyOptions& options) {
    check_range("--repeats", options.repeats, 1, 1000);
    check_range("--reference-error", options.reference_error, 1e-14, 1.0, " m");
    const CompareSettings settings{.schemes = options.schemes,
                                   .steps = read_numbers("--steps", options.steps),
                                   .tolerances = read_numbers("--tolerances", options.tolerances),
                                   .repeats = options.repeats,
                                   .reference_error = options.reference_error};
    const SceneSource source = scene_source(options.file, options.common);
    check_once("--schemes", settings.schemes);
    check_as_key(source, "step.scheme", "--schemes", settings.schemes);
    check_as_key(source, "step.time_step", "--steps", settings.steps);
    check_as_key(source, "step.tolerance", "--tolerances", settings.tolerances);
    demand_duration(source({}));
    build_scene(source({}));  // what is wrong with the scene itself is reported before anything is written
    const std::string folder = options.folder.empty() ? default_folder(options.file) : options.folder;
    return write_outcome(options, folder, "compare", [&](const StopSignals& signals) {
        CompareHooks hooks{.stop_asked = [&] { return signals.asked(); }, .reference_made = {}};
        hooks.reference_made = [&](const Reference& reference) {
            if (options.common.quiet) return;
            std::fputs(reference_text(reference).c_str(), stdout);
            std::fflush(stdout);
        };
        const Comparison comparison = compare_scene(source, settings, hooks);
        StudyOutcome outcome{comparison_csv(comparison), plot_svg(comparison_plot(comparison)), comparison_table(comparison)};
        for (const std::string& sentence : advice(comparison)) outcome.text += sentence + "\n";
        outcome.well =
            std::ranges::any_of(comparison.runs, [](const ComparedRun& run) { return run.run.end == VariantEnd::finished; });
        return outcome;
    });
}

}  // namespace percale::program
