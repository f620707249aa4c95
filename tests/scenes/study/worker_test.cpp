#include "scenes/study/worker.h"

#include <csignal>

#include "scenes/study/run_variants.h"
#include "scenes/study/study_folder.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::worker_test {
namespace {

struct Worked {
    std::vector<std::size_t> runs;
    std::vector<WorkerEnd> ends;  // of those
    std::vector<std::size_t> left;
};

/// The runs of a study that are left, as processes.
Worked work_on(const TestFolder& folder, const Study& study, const std::string& program, int jobs,
               const std::function<bool()>& stop_asked = {}) {
    const StudyFolder runs(folder.path("out"));
    runs.begin(study);
    const std::vector<std::size_t> left = runs_left(runs, study);
    std::vector<WorkerEnd> ends(left.size());
    Worked worked;
    const VariantWork work{.jobs = jobs, .stop_asked = stop_asked, .ended = [&](std::size_t k) {
                               worked.runs.push_back(left[k]);
                               worked.ends.push_back(ends[k]);
                           }};
    run_variants(left.size(), work, [&](std::size_t k) {
        ends[k] = run_worker(run_words(study, runs, left[k], program), runs.log_of(left[k]), stop_asked);
    });
    worked.left = runs_left(runs, study);
    return worked;
}

}  // namespace

TEST_CASE("every run is a process that leaves its report, whatever the number at a time") {
    for (const int jobs : {1, 3}) {
        const TestFolder folder;
        const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005, 0.004, 0.002]\n"));
        const Worked worked = work_on(folder, study, PERCALE_PROGRAM, jobs);
        CHECK(worked.left.empty());
        REQUIRE(worked.ends.size() == 4);
        for (const WorkerEnd& end : worked.ends) CHECK((end.exit_code == 0 && end.signal == 0));
        CHECK_FALSE(folder.holds("out/runs/00000.log"));
        CHECK(folder.read("out/runs/00003/report.json").find("\"time_step\": 0.002") != std::string::npos);
    }
}

TEST_CASE("a run whose process is killed is left over and done by the next call alone") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n"));
    // A program that kills itself in one of the runs.
    const std::string script = folder.write("program.sh", "#!/bin/sh\ncase \"$*\" in *00001*) kill -9 $$ ;; esac\nexec '" +
                                                              std::string(PERCALE_PROGRAM) + "' \"$@\"\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    const Worked first = work_on(folder, study, script, 2);
    CHECK(first.left == std::vector<std::size_t>{1});
    REQUIRE(first.runs.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) CHECK(first.ends[k].signal == (first.runs[k] == 1 ? SIGKILL : 0));
    const Worked second = work_on(folder, study, PERCALE_PROGRAM, 2);
    CHECK(second.left.empty());
    CHECK(second.runs == std::vector<std::size_t>{1});
}

TEST_CASE("asked to stop, no other run is begun and those that run are left for the next call") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"duration\" = [500.0, 501.0, 502.0]\n"));
    int asked = 0;
    const Worked worked = work_on(folder, study, PERCALE_PROGRAM, 1, [&] { return ++asked > 20; });
    CHECK(worked.ends.size() == 1);
    CHECK(worked.left.size() == 3);
}

TEST_CASE("a program that cannot be started is an exit code, a log that cannot be written an error") {
    const TestFolder folder;
    const WorkerEnd end = run_worker({folder.path("none")}, folder.path("log"), {});
    CHECK((end.exit_code == 127 && end.signal == 0));
    CHECK_FALSE(folder.holds("log"));
    CHECK(message_of([&] { run_worker({PERCALE_PROGRAM}, folder.path("none/log"), {}); }).find("none/log: cannot be written") !=
          std::string::npos);
}

TEST_CASE("what a process prints is its log") {
    const TestFolder folder;
    CHECK(run_worker({PERCALE_PROGRAM, "run", "absent.toml"}, folder.path("log"), {}).exit_code == 2);
    CHECK(folder.read("log").starts_with("percale: absent.toml"));
}

}  // namespace percale::scenes::test::worker_test
