#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "common/text.h"
#include "common/whole_file.h"
#include "export/junit.h"
#include "export/kept_run.h"
#include "export/reference_files.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/stop_signals.h"
#include "run/run_verdict.h"
#include "run/scene_plan.h"
#include "run/start_fault.h"
#include "study/run_variants.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct CheckOptions {
    CommonOptions common;
    std::vector<std::string> scenes;
    std::string junit;
    std::string resume;   // folder in which results are kept; "": none are
    std::string program;  // program_checksum, with `resume`
    int jobs = 1;
    bool update = false;
};

struct Outcome {
    CheckedScene scene;
    int exit_code = all_well;
    std::string ending;                    // "finished: 60 steps, 1 s"
    std::vector<std::string> start_moves;  // what was moved out of obstacles
    std::vector<std::string> updates;      // files of `matches` that were written
    std::string state_hash;                // of the last state
    bool kept = false;                     // from an earlier call
};

/// A scene's folder in that of --resume: its path in one word.
std::string kept_folder(const CheckOptions& options, const std::string& file) {
    std::string name = std::filesystem::path(file).lexically_normal().replace_extension().string();
    std::ranges::replace(name, '/', '_');
    return options.resume + "/" + name;
}

void judge_outcome(Outcome& outcome) {
    outcome.exit_code = outcome.scene.failed() > 0 ? not_as_expected : all_well;
    if (outcome.scene.status == status_word(RunStatus::stopped)) outcome.exit_code = stopped_by_signal;
}

/// What an earlier call found.
void take_kept(Outcome& outcome, const KeptRun& kept, std::span<const Expectation> expected) {
    const EndedRun& run = *kept.ended();
    outcome.kept = true;
    outcome.ending =
        "kept: " + run.status + " earlier: " + std::to_string(run.steps) + " steps, " + short_number(run.simulated_s, 6) + " s";
    outcome.scene.status = run.status;
    outcome.scene.reason = run.reason;
    outcome.scene.wall_s = run.wall_s;
    for (std::size_t i = 0; i < expected.size(); ++i)
        outcome.scene.expectations.push_back(
            {.expectation = expected[i], .value = {}, .passed = run.expectations[i].passed, .text = run.expectations[i].text});
    outcome.state_hash = kept.state_hash();
    judge_outcome(outcome);
}

/// "finished: 60 steps, 1 s, resumed at 0.5 s; run again: ball.obj has changed"
std::string ending_text(const std::string& status, const RunResult& result, const std::string& why_again) {
    std::string text =
        status + ": " + std::to_string(result.totals.steps) + " steps, " + short_number(result.totals.simulated_s, 6) + " s";
    if (!result.resumed_at.empty()) text += ", resumed at " + short_number(result.resumed_at.back(), 6) + " s";
    return why_again.empty() ? text : text + "; run again: " + why_again;
}

void run_into(Outcome& outcome, const CheckOptions& check, const StopSignals& signals) {
    const CommonOptions& options = check.common;
    Scene scene = load_scene(outcome.scene.file, scene_overrides(options));
    const std::vector<Expectation> expected = expected_of(scene, options);
    std::optional<KeptRun> kept;
    if (!check.resume.empty())
        kept.emplace(kept_folder(check, outcome.scene.file), scene, RunMarks{options.certify_steps, options.replay_hash},
                     check.program);
    if (kept && kept->ended()) return take_kept(outcome, *kept, expected);
    if (check.jobs > 1 && scene.step.threads == 0) scene.step.threads = 1;  // the jobs use the cores
    BuiltScene built = signals.prepare([&] {
        BuiltScene planned = build_scene(scene);
        keep_plan(planned);
        if (kept) keep_cleaning(planned);
        return planned;
    });
    for (const StartMove& move : built.simulation.start_repair()) outcome.start_moves.push_back(start_move_text(move));
    RunHooks hooks;
    hooks.stop_asked = [&] { return signals.asked(); };
    hooks.cancel = &signals.overdue();
    const RunResult result = kept ? kept->run(built, hooks, expected)
                                  : run_scene(built, hooks, {.certify_steps = options.certify_steps, .compare = !check.update});
    const RunVerdict verdict = verdict_of_run(result);
    outcome.scene.status = verdict.word;
    outcome.scene.reason = verdict.reason;
    outcome.ending = ending_text(verdict.word, result, kept ? kept->why_again() : "");
    outcome.scene.wall_s = result.totals.wall_s;
    outcome.scene.expectations = judge(expected, measure_values(result.measures), result.timed);
    if (check.update) {
        std::erase_if(outcome.scene.expectations, [](const ExpectationResult& r) { return r.expectation.measure == "matches"; });
        if (verdict.well()) outcome.updates = update_references(built, result);
    }
    outcome.state_hash = hexadecimal(built.simulation.state_hash());
    judge_outcome(outcome);
}

Outcome check_scene(const std::string& file, const CheckOptions& options, const StopSignals& signals) {
    Outcome outcome;
    outcome.scene.file = file;
    try {
        signals.job([&] { run_into(outcome, options, signals); });
    } catch (const SceneError& error) {
        outcome.scene.error = error.what();
        outcome.exit_code = wrong_input;
    } catch (const std::exception& error) {
        outcome.scene.error = file + ": internal error: " + error.what();
        outcome.exit_code = internal_error;
    }
    return outcome;
}

void print_outcome(const CheckOptions& options, const Outcome& outcome) {
    const CheckedScene& scene = outcome.scene;
    if (!scene.error.empty()) std::fprintf(stderr, "percale: %s\n", scene.error.c_str());
    if (!scene.reason.empty())
        std::fprintf(stderr, "percale: %s: %s: %s\n", scene.file.c_str(), scene.status.c_str(), scene.reason.c_str());
    if (options.common.quiet) return;
    std::printf("%s: %s\n", scene.file.c_str(), scene.error.empty() ? outcome.ending.c_str() : "did not run");
    for (const std::string& move : outcome.start_moves) std::printf("  %s\n", move.c_str());
    if (scene.error.empty() && scene.expectations.empty())
        std::printf("  no expectations: the scene passes if its run finishes\n");
    for (const ExpectationResult& expectation : scene.expectations) std::printf("  %s\n", expectation.text.c_str());
    for (const std::string& update : outcome.updates) std::printf("  %s\n", update.c_str());
    if (options.common.replay_hash) std::printf("  state_hash %s\n", outcome.state_hash.c_str());
    std::fflush(stdout);
}

/// Checks all scenes and prints what is done in their order.
std::vector<Outcome> check_all(const CheckOptions& options, const StopSignals& signals) {
    const std::size_t count = options.scenes.size();
    std::vector<Outcome> outcomes(count);
    std::vector<bool> done(count, false);
    std::size_t printed = 0, checked = 0;
    ProgressBar bar(!options.common.quiet && count > 1, static_cast<double>(count), {"scenes", 0});
    const auto ended = [&](std::size_t i) {
        done[i] = true;
        ++checked;
        bar.clear();
        for (; printed < count && done[printed]; ++printed) print_outcome(options, outcomes[printed]);
        if (printed < count) bar.show(static_cast<double>(checked));
    };
    run_variants(count, {.jobs = options.jobs, .ended = ended},
                 [&](std::size_t i) { outcomes[i] = check_scene(options.scenes[i], options, signals); });
    return outcomes;
}

void check_options(const CheckOptions& options) {
    scene_overrides(options.common);  // a wrong --set is reported once, not for each scene
    if (!options.common.frames.empty() && options.common.frames != "none")
        throw SceneError("--frames " + options.common.frames + ": check writes no frames; percale run does");
    if (!options.junit.empty()) const WholeFile probe(options.junit);  // found before the work, not after it
    check_range("--jobs", options.jobs, 1, 256);
    if (options.resume.empty()) return;
    const OutputFolder probe(options.resume);
    std::map<std::string, std::string> scene_of;
    for (const std::string& file : options.scenes) {
        const auto [entry, added] = scene_of.try_emplace(kept_folder(options, file), file);
        if (!added)
            throw SceneError("--resume " + options.resume + ": " + entry->second + " and " + file +
                             " would be kept in one folder, " + entry->first);
    }
}

int check(CheckOptions options) {
    check_options(options);
    if (!options.resume.empty()) {
        options.common.frames = "none";
        options.program = program_checksum();
    }
    const StopSignals signals;
    const std::vector<Outcome> outcomes = check_all(options, signals);
    std::vector<CheckedScene> scenes;
    std::size_t finished = 0, expectations = 0, passed = 0, kept = 0;
    int worst = all_well;
    for (const Outcome& outcome : outcomes) {
        scenes.push_back(outcome.scene);
        finished += outcome.scene.finished() ? 1 : 0;
        kept += outcome.kept ? 1 : 0;
        expectations += outcome.scene.expectations.size();
        passed += static_cast<std::size_t>(outcome.scene.passed());
        worst = std::max(worst, outcome.exit_code);
    }
    if (!options.junit.empty()) write_whole_file(options.junit, junit_text(scenes));
    if (!options.common.quiet)
        std::printf("%zu of %zu scenes finished, %zu of %zu expectations passed%s\n", finished, scenes.size(), passed,
                    expectations, options.resume.empty() ? "" : ("; " + std::to_string(kept) + " kept from earlier").c_str());
    if (signals.asked() && !options.resume.empty())
        std::fprintf(stderr, "percale: %s: stopped; the same command goes on\n", options.resume.c_str());
    return worst;
}

}  // namespace

void add_check_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = program.add_subcommand("check", "Run scenes and compare them with their [expect] sections");
    command->footer(
        "Examples: percale check data/scenes/*.toml --jobs 2\n          percale check data/scenes/*.toml --resume checked");
    command->add_option("SCENE", options->scenes, "Scene files (TOML)")->required();
    command->add_option("--junit", options->junit, "Also write the outcome as JUnit XML")->type_name("FILE");
    command->add_flag("--update", options->update,
                      "Write the files that `matches` names from this run, instead of comparing with them");
    command
        ->add_option("--resume", options->resume,
                     "Keep results in DIR, and take up what is there: scenes that have ended are not run again, one that was "
                     "interrupted goes on; what was made from other files, expectations or settings, or by another program "
                     "(its file and the libpercale libraries it has loaded; not other libraries), is run anew")
        ->type_name("DIR")
        ->excludes("--update");
    command->add_option("--jobs", options->jobs, "Scenes run at a time (default 1)")->type_name("N");
    add_common_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace percale::program
