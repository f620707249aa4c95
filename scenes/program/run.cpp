#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "export/checkpoint.h"
#include "format/expectations.h"
#include "meshes/obj_file.h"
#include "page/run_page.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/stop_signals.h"
#include "run/run_verdict.h"
#include "run/scene_plan.h"
#include "run/start_fault.h"
#include "tolerances.h"

namespace percale::program {

namespace {

/// Pinches that `run` prints; the report has all.
constexpr std::size_t max_pinches_reported = 8;

using namespace percale::scenes;

struct RunOptions {
    CommonOptions common;
    std::string scene, folder;
    std::string checkpoint;  // s of simulated time between two checkpoints; "" = none are written
    std::string resume;      // checkpoint to go on from; "" = from the start
    bool verbose = false;
    bool report = false;  // the page, too
};

/// s; 0 where no checkpoints are asked for.
double checkpoint_interval(const RunOptions& options) {
    if (options.checkpoint.empty()) return 0.0;
    double seconds = 0.0;
    const char* end = options.checkpoint.data() + options.checkpoint.size();
    const auto [rest, error] = std::from_chars(options.checkpoint.data(), end, seconds);
    if (error == std::errc() && rest == end && seconds >= 1e-6 && seconds <= 1e6) return seconds;
    throw SceneError("--checkpoint " + options.checkpoint + ": must be a number, 1e-6 ... 1e6 s of simulated time");
}

std::string folder_of(const std::string& file) {
    const std::string folder = std::filesystem::path(file).parent_path().string();
    return folder.empty() ? "." : folder;
}

/// Prints what is known before the first step; returns how many moves at the start it reports.
std::size_t print_start(const RunOptions& options, const BuiltScene& built) {
    std::printf("%s: %s into %s", options.scene.c_str(), steps_text(built.scene).c_str(), options.folder.c_str());
    if (!options.resume.empty()) std::printf(", resumed at %.6g s", built.simulation.time());
    std::printf("\n");
    for (const Finding& warning : plan_findings(built, plan_of(built))) print_finding(warning);
    const std::size_t moves = print_start_moves(built.simulation);
    std::fflush(stdout);
    return moves;
}

/// Warns as soon as cloth would have torn: such cloth makes steps expensive, and a run may take long to its end.
void print_torn(const BuiltScene& built, const StepReport& report) {
    Finding torn = strain_warnings(built, report.largest_strain).front();
    torn.what = "at " + short_number(report.time) + " s " + torn.what;
    print_finding(torn);
    std::fflush(stdout);
}

/// Leaves what is wrong with a start beside the output folder; the name of the file, or nothing where it cannot be written.
std::string leave_picture(const RunOptions& options, const TriangleMesh& triangles) {
    std::string folder = options.folder;
    while (folder.ends_with('/')) folder.pop_back();
    try {
        write_obj(folder + "_start.obj", triangles.vertices, triangles.triangles);
    } catch (const SceneError&) {
        return "";  // the start itself is what has to be reported
    }
    return folder + "_start.obj";
}

BuiltScene built_scene(const RunOptions& options, const Checkpoint* from) {
    const Scene scene = load_scene(options.scene, scene_overrides(options.common));
    try {
        BuiltScene built = build_scene(scene);
        keep_plan(built);
        keep_cleaning(built);
        // What [expect] reads is in its settings, and was in those of the run that was left.
        if (from) check_same_run(options.resume, *from, built.scene, options.common.certify_steps, options.common.replay_hash);
        return built;
    } catch (const StartRefused& refused) {
        const std::string file = refused.triangles().triangles.empty() ? "" : leave_picture(options, refused.triangles());
        if (file.empty()) throw;
        fail_at(refused.place(), refused.reason() + " (the triangles concerned: " + file + ")");
    }
}

void print_summary(const RunOptions& options, const BuiltScene& built, const RunResult& result,
                   std::span<const ExpectationResult> expectations) {
    const Measures& m = result.measures;
    std::printf(
        "%s%s: %d steps, %.6g s simulated in %.3g s (steps %.3g s CPU, certificate %.3g s), largest strain %.3g, speed at end "
        "%.3g m/s",
        verdict_of_run(result).word.c_str(), result.rest && result.rest->at_rest ? " at rest" : "", result.totals.steps,
        result.totals.simulated_s, result.totals.wall_s, result.totals.cpu_s, result.totals.certificate_s, m.largest_strain,
        m.speed_at_end);
    if (built.scene.has_contact())
        std::printf(", %d intersecting pairs, %s", m.intersections, nearness_text(m.smallest_distance).c_str());
    std::printf("; %s/report.json\n", options.folder.c_str());
    // Contacts of cloth with itself count among them.
    const bool maybe_met = result.totals.contacts_most > 0 && !built.scene.cloth_that_meets_cloth();
    const bool finished = result.status == RunStatus::finished;
    if (finished && !built.obstacles.empty() && std::isinf(m.smallest_distance) && !maybe_met)
        print_finding(finding("never_met", {}, "no cloth ever met an obstacle", "is everything in its place, and in one unit?"));
    const std::span<const Pinch> pinches = result.totals.pinches;
    for (const Pinch& pinch : pinches.first(std::min(pinches.size(), max_pinches_reported)))
        print_finding(pinch_warning(pinch, built.scene));
    if (pinches.size() > max_pinches_reported)
        print_finding(finding("pinched", {}, "and so " + std::to_string(pinches.size() - max_pinches_reported) + " times more",
                              "report.json lists them"));
    for (const Finding& warning : end_warnings(built, result)) print_finding(warning);
    for (const ExpectationResult& expectation : expectations) std::printf("  %s\n", expectation.text.c_str());
}

/// One message on stderr for whatever is not well, and the exit code.
int verdict(const RunOptions& options, const RunResult& result, std::span<const ExpectationResult> expectations) {
    const RunVerdict verdict = verdict_of_run(result);
    const char* scene = options.scene.c_str();
    if (result.status == RunStatus::stopped) {
        const std::string checkpoint = options.folder + "/" + checkpoint_name;
        const bool there = !options.checkpoint.empty() && std::filesystem::is_regular_file(checkpoint);
        const std::string resumable = there ? "; go on with --resume " + checkpoint : "";
        std::fprintf(stderr, "percale: %s: %s; the report is written%s\n", scene, verdict.reason.c_str(), resumable.c_str());
        return stopped_by_signal;
    }
    std::string failed;
    for (const ExpectationResult& expectation : expectations)
        if (!expectation.passed) failed += "; " + expectation.text;
    if (!verdict.well()) {
        std::fprintf(stderr, "percale: %s: %s: %s%s\n", scene, verdict.word.c_str(), verdict.reason.c_str(), failed.c_str());
        return not_as_expected;
    }
    if (failed.empty()) return all_well;
    std::fprintf(stderr, "percale: %s: not as expected: %s\n", scene, failed.substr(2).c_str());
    return not_as_expected;
}

void leave_page(const RunOptions& options) {
    const std::string file = page_in(options.folder);
    const PageSummary page = write_run_page(options.folder, file);
    if (!options.common.quiet) std::printf("%s\n", page_summary_text(file, page).c_str());
}

int run(RunOptions options) {
    if (options.report) check_pages("--report");
    const double interval = checkpoint_interval(options);
    std::optional<Checkpoint> from;
    if (!options.resume.empty()) from = read_checkpoint(options.resume);
    if (options.folder.empty()) options.folder = from ? folder_of(options.resume) : default_folder(options.scene);
    const StopSignals signals;  // before the threads of the simulation
    BuiltScene built = signals.prepare([&] { return built_scene(options, from ? &*from : nullptr); });
    if (signals.asked()) {
        std::fprintf(stderr, "percale: %s: stopped before the first step; nothing was written\n", options.scene.c_str());
        return stopped_by_signal;
    }
    RunFolder folder(options.folder, built.scene, options.common.replay_hash);
    ProgressBar bar(!options.common.quiet && !options.verbose, built.scene.latest_end());
    std::size_t start_moves = 0;
    bool torn = false;  // it was said
    RunHooks hooks;
    hooks.begin = [&] {
        from ? folder.begin_from(from->folder, folder_of(options.resume)) : folder.begin();
        if (!options.common.quiet) start_moves = print_start(options, built);
    };
    hooks.frame = [&](const Frame& frame) { folder.add(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        folder.add(report, simulation);
        if (options.verbose) std::printf("%s\n", report.explanation().c_str());
        if (!options.common.quiet && !torn && report.largest_strain > torn_strain) {
            torn = true;
            bar.clear();
            print_torn(built, report);
        }
        bar.show(simulation.time());
    };
    hooks.stop_asked = [&] { return signals.asked(); };
    hooks.cancel = &signals.overdue();
    const std::string checkpoint = options.folder + "/" + checkpoint_name;
    const RunMarks marks{options.common.certify_steps, options.common.replay_hash};
    if (interval > 0.0)
        hooks.checkpoint = [&](const RunState& state) { save_run(checkpoint, built.scene, state, marks, folder); };
    const RunResult result = run_scene(built, hooks,
                                       {.certify_steps = options.common.certify_steps,
                                        .checkpoint_every = interval,
                                        .from = from ? &from->run : nullptr,
                                        .from_file = options.resume});
    bar.clear();
    if (!options.common.quiet) print_start_moves(built.simulation, start_moves, when_sewn);
    const std::vector<ExpectationResult> expectations =
        judge_run(expected_of(built.scene, options.common), result.measures, result.timed, built.scene);
    folder.finish(built, result, expectations);
    if (!options.common.quiet) print_summary(options, built, result, expectations);
    if (options.report) leave_page(options);
    return verdict(options, result, expectations);
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = program.add_subcommand("run", "Simulate a scene; write frames, report.json and steps.csv");
    command->footer("Example: percale run data/scenes/hang.toml -o out --set duration=1");
    command->add_option("SCENE", options->scene, "Scene file (TOML)")->required();
    command->add_option("-o", options->folder, "Output folder (default: the scene's name)")->type_name("DIR");
    add_common_options(*command, options->common);
    command
        ->add_flag("--verbose", options->verbose,
                   "Print a line for every step: its figures, and why substeps of it were solved again")
        ->excludes("--quiet");
    command->add_flag("--report", options->report, "Write the run as an HTML page, too: DIR/report.html (see percale report)");
    command
        ->add_option(
            "--checkpoint", options->checkpoint,
            "Every so many simulated seconds, and when stopped between steps, write DIR/checkpoint.percale to resume from")
        ->type_name("SECONDS");
    command
        ->add_option("--resume", options->resume,
                     "Go on from a checkpoint of this scene, in its folder unless -o names another; the result is the same")
        ->type_name("FILE");
    command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace percale::program
