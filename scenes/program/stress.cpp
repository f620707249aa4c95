#include "stress/stress.h"

#include <algorithm>

#include "common/text.h"
#include "percale/error.h"
#include "program/progress_bar.h"
#include "program/study.h"
#include "stress/stress_report.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

constexpr int reported_failures = 10;

/// Refuses what only scenes take, what only the matrix takes, and numbers that are out of range.
void check_stress(const StudyOptions& options) {
    const auto refuse = [](bool given, const char* why) {
        if (given) throw SceneError(why);
    };
    const bool matrix = options.file.empty();
    refuse(!matrix && options.cell >= 0, "--cell: only cells of the default matrix have numbers");
    refuse(matrix && !options.steps.empty(), "--steps: only with a scene; the default matrix has its own");
    refuse(matrix && !options.factors.empty(), "--factors: only with a scene; the default matrix has its own");
    refuse(matrix && !options.common.set.empty(), "--set: without a scene there is nothing to set");
    refuse(matrix && options.common.no_skip, "--no-skip: without a scene there is nothing to set");
    refuse(options.cell >= 0 && !options.schemes.empty(), "--cell: the cell has its own scheme; leave out --schemes");
    check_range("--jobs", options.jobs, 1, max_study_jobs);
    check_range("--most-steps", options.max_steps, 1, 1000000);
    for (const double factor : read_numbers("--factors", options.factors)) check_range("--factors", factor, 1e-9, 1e9);
    check_once("--schemes", options.schemes);
}

SceneStress stress_settings(const StudyOptions& options) {
    SceneStress settings{.schemes = options.schemes, .steps = options.max_steps};
    if (!options.steps.empty()) settings.time_steps = read_numbers("--steps", options.steps);
    if (!options.factors.empty()) settings.factors = read_numbers("--factors", options.factors);
    return settings;
}

/// The cells of the default matrix that are asked for.
std::vector<StressCell> wanted_cells(const StudyOptions& options) {
    std::vector<StressCell> cells = stress_matrix();
    if (options.cell >= 0) check_range("--cell", options.cell, 0, static_cast<double>(cells.size() - 1));
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

StressRun stressed(const StudyOptions& options, const SceneSource& source, const StopSignals& signals) {
    const SceneStress settings = stress_settings(options);
    const std::vector<StressCell> cells = options.file.empty() ? wanted_cells(options) : scene_cells(settings);
    ProgressBar bar(!options.common.quiet, static_cast<double>(cells.size()), {"cells", 0});
    double ended = 0.0;
    const VariantWork work{
        .jobs = options.jobs, .stop_asked = [&] { return signals.asked(); }, .ended = [&](std::size_t) { bar.show(++ended); }};
    return options.file.empty() ? stress_cells(cells, options.max_steps, work) : stress_scene(source, settings, work);
}

std::string stress_folder(const StudyOptions& options) {
    if (!options.folder.empty()) return options.folder;
    if (!options.file.empty()) return default_folder(options.file);
    return options.cell >= 0 ? "stress_cell_" + std::to_string(options.cell) : "stress";
}

std::string stress_text(const StressRun& run) {
    std::string text =
        counted(static_cast<long>(run.rows.size()), "cell") + " of at most " + std::to_string(run.steps) + " steps";
    text += run.of_scene ? "\n" : ", of explicit schemes " + std::to_string(explicit_factor * run.steps) + "\n";
    text += stress_summary(run) + stress_failures(run, reported_failures);
    if (run.failures() == 0 || run.of_scene) return text;
    return text + "failures: " + std::to_string(run.failures()) + "; `percale stress --cell N` repeats cell N\n";
}

}  // namespace

int stress(const StudyOptions& options) {
    check_stress(options);
    const SceneSource source = scene_source(options.file, options.common);
    if (options.file.empty()) {
        wanted_cells(options);
    } else {
        check_as_key(source, "step.scheme", "--schemes", options.schemes);
        check_as_key(source, "step.time_step", "--steps", read_numbers("--steps", options.steps));
        build_scene(source({}));  // what is wrong with the scene itself is reported before anything is written
    }
    return write_outcome(options, stress_folder(options), "stress", [&](const StopSignals& signals) {
        const StressRun run = stressed(options, source, signals);
        return StudyOutcome{stress_csv(run), plot_svg(stress_map(run)), stress_text(run), run.failures() == 0};
    });
}

}  // namespace percale::program
