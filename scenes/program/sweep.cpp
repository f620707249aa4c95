#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>

#include "common/folder_lock.h"
#include "common/own_program.h"
#include "common/text.h"
#include "common/whole_file.h"
#include "export/kept_run.h"
#include "percale/error.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/study.h"
#include "study/batch_files.h"
#include "study/run_variants.h"
#include "study/study_table.h"
#include "study/worker.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

constexpr std::size_t reported_runs = 10;

/// A study file, or the folder of a study that was begun.
struct OpenStudy {
    Study study;
    StudyFolder folder;
};

OpenStudy opened(const StudyOptions& options) {
    if (std::filesystem::is_directory(options.file)) {
        if (!options.folder.empty()) throw SceneError("-o " + options.folder + ": the study's folder is named already");
        const StudyFolder folder(options.file);
        return {stored_study(folder.file("study.json")), folder};
    }
    Study study = read_study(options.file);
    const StudyFolder folder(options.folder.empty() ? default_folder(options.file) : options.folder);
    folder.begin(study);
    return {std::move(study), folder};
}

/// All runs, or FIRST-LAST where that is given.
std::vector<std::size_t> asked_runs(const StudyOptions& options, const OpenStudy& open) {
    std::vector<std::size_t> runs(open.study.runs.size());
    std::iota(runs.begin(), runs.end(), std::size_t{0});
    if (options.range.empty()) return runs;
    std::size_t first = 0, last = 0;
    int end = 0;
    const bool two = std::sscanf(options.range.c_str(), "%zu-%zu%n", &first, &last, &end) == 2 &&
                     options.range[static_cast<std::size_t>(end)] == 0;
    if (!two || first > last || last >= runs.size())
        throw SceneError("--run " + options.range + ": must be FIRST-LAST, 0 ... " + std::to_string(runs.size() - 1));
    std::erase_if(runs, [&](std::size_t run) { return run < first || run > last; });
    return runs;
}

void write_batch_files(const OpenStudy& open) {
    const BatchFiles files = batch_files(open.study, open.folder, own_program());
    for (const auto& [name, text] :
         {std::pair("slurm.sh", files.slurm), {"Makefile", files.makefile}, {"commands.txt", files.commands}})
        write_whole_file(open.folder.file(name), text);
}

/// What a command prints; throws SceneError with that where it fails.
std::string output_of(const std::string& command) {
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) throw SceneError(command + ": cannot be started");
    std::string text;
    char part[256];
    while (std::fgets(part, sizeof part, pipe) != nullptr) text += part;
    while (text.ends_with('\n')) text.pop_back();
    if (pclose(pipe) != 0) throw SceneError(command + ": " + (text.empty() ? "failed" : text));
    return text;
}

/// Submits the array, and behind it a job that gathers the tables.
int submit(const StudyOptions& options, const OpenStudy& open) {
    const std::string script = open.folder.file("slurm.sh");
    const std::string job = output_of("sbatch --parsable " + shell_word(script));
    const std::string collect = shell_word(own_program()) + " sweep " +
                                shell_word(std::filesystem::absolute(open.folder.path()).string()) + " --collect --quiet";
    const std::string after =
        output_of("sbatch --parsable --output=/dev/null --dependency=afterany:" + job + " --wrap " + shell_word(collect));
    if (!options.common.quiet)
        std::printf(
            "%zu runs as Slurm job %s, gathered into %s/study.csv by job %s; the same command without --slurm does here what is "
            "left\n",
            open.study.runs.size(), job.c_str(), open.folder.path().c_str(), after.c_str());
    return all_well;
}

void print_failures(const OpenStudy& open, const std::vector<std::size_t>& failed) {
    if (failed.empty()) return;
    std::string text = counted(static_cast<long>(failed.size()), "run") + " did not finish; the same command does them again:\n";
    for (std::size_t i = 0; i < std::min(failed.size(), reported_runs); ++i)
        text += "  " + open.folder.folder_of(failed[i]) + ": " + open.folder.complaint_of(failed[i]) + "\n";
    if (failed.size() > reported_runs) text += "  and " + std::to_string(failed.size() - reported_runs) + " more\n";
    std::fprintf(stderr, "percale: %s", text.c_str());
}

/// The number of these runs that crossed or were unsolved; prints them.
std::size_t crossed_or_unsolved(const OpenStudy& open, std::span<const std::size_t> runs) {
    std::size_t found = 0;
    for (const std::size_t run : runs) {
        const std::string folder = open.folder.folder_of(run);
        const std::optional<EndedRun> ended = ended_run(folder);
        if (!ended || (ended->status != "crossed" && ended->status != "unsolved")) continue;
        if (++found <= reported_runs)
            std::fprintf(stderr, "percale: %s: %s: %s\n", folder.c_str(), ended->status.c_str(), ended->reason.c_str());
    }
    if (found > reported_runs) std::fprintf(stderr, "percale: and %zu more runs crossed or unsolved\n", found - reported_runs);
    return found;
}

/// Writes the tables of the runs that are done; returns the exit code.
int gather(const StudyOptions& options, const OpenStudy& open) {
    const StudyTables tables = study_tables(open.study, open.folder);
    write_whole_file(open.folder.file("study.csv"), tables.csv);
    write_whole_file(open.folder.file("costs.csv"), tables.costs);
    write_whole_file(open.folder.file("study.svg"), tables.svg);
    const std::size_t all = open.study.runs.size();
    if (!options.common.quiet)
        std::printf("%zu of %zu runs done, %zu failed, %zu not as expected; %s/study.csv, study.svg\n", tables.done, all,
                    tables.failed, tables.not_as_expected, open.folder.path().c_str());
    const std::size_t wrong = crossed_or_unsolved(open, asked_runs({}, open)) + tables.failed + tables.not_as_expected;
    return tables.done == all && wrong == 0 ? all_well : not_as_expected;
}

/// Makes these runs, each as a process; gives those that came to no end.
std::vector<std::size_t> make_runs(const StudyOptions& options, const OpenStudy& open, const std::vector<std::size_t>& runs,
                                   const StopSignals& signals) {
    const std::string program = own_program();
    const auto stop_asked = [&] { return signals.asked(); };
    ProgressBar bar(!options.common.quiet, static_cast<double>(runs.size()), {"runs", 0});
    std::vector<std::size_t> failed;
    double ended = 0.0;
    const VariantWork work{.jobs = options.jobs, .stop_asked = stop_asked, .ended = [&](std::size_t k) {
                               if (!open.folder.is_done(runs[k]) && !signals.asked()) failed.push_back(runs[k]);
                               bar.show(++ended);
                           }};
    run_variants(runs.size(), work, [&](std::size_t k) {
        run_worker(run_words(open.study, open.folder, runs[k], program), open.folder.log_of(runs[k]), stop_asked);
    });
    return failed;
}

}  // namespace

int sweep(const StudyOptions& options) {
    check_range("--jobs", options.jobs, 1, max_study_jobs);
    const OpenStudy open = opened(options);
    if (options.collect) return gather(options, open);
    const std::vector<std::size_t> asked = asked_runs(options, open);
    std::vector<std::size_t> runs = asked;
    std::erase_if(runs, [&](std::size_t run) { return open.folder.is_done(run); });
    if (options.range.empty()) write_batch_files(open);
    if (options.slurm) return submit(options, open);
    std::optional<FolderLock> lock;  // of those that do all runs: with --run others do theirs at the same time
    if (options.range.empty()) lock.emplace(open.folder.path());
    const StopSignals signals;
    const std::vector<std::size_t> failed = make_runs(options, open, runs, signals);
    print_failures(open, failed);
    const auto well = [&] { return failed.empty() && crossed_or_unsolved(open, asked) == 0 ? all_well : not_as_expected; };
    const int code = options.range.empty() ? gather(options, open) : well();  // the tables are of all runs
    const bool left = std::ranges::any_of(runs, [&](std::size_t run) { return !open.folder.is_done(run); });
    if (!signals.asked() || !left) return code;
    std::fprintf(stderr, "percale: %s: stopped; the same command goes on\n", options.file.c_str());
    return stopped_by_signal;
}

}  // namespace percale::program
