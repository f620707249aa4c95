#include "scenes/sweep/study_workers.h"

#include <algorithm>
#include <csignal>

#include "percale/error.h"
#include "tests/scenes/sweep/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::study_workers_test {
namespace {

struct Worked {
    std::vector<WorkerEnd> ends;
    std::vector<std::size_t> left;
};

Worked work_on(const TestFolder& folder, const Study& study, StudyWork work) {
    const StudyFolder runs(folder.path("out"));
    runs.begin(study);
    Worked worked;
    work.ended = [&](const WorkerEnd& end) { worked.ends.push_back(end); };
    do_runs(study, runs, runs.left(study), work);
    worked.left = runs.left(study);
    return worked;
}

}  // namespace

TEST_CASE("every run is a process that leaves its report, whatever the number at a time") {
    for (const int jobs : {1, 3}) {
        const TestFolder folder;
        const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005, 0.004, 0.002]\n"));
        const Worked worked = work_on(folder, study, {.program = PERCALE_PROGRAM, .jobs = jobs, .ended = {}, .stop_asked = {}});
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
    const Worked first = work_on(folder, study, {.program = script, .jobs = 2, .ended = {}, .stop_asked = {}});
    CHECK(first.left == std::vector<std::size_t>{1});
    CHECK(std::ranges::any_of(first.ends, [](const WorkerEnd& end) { return end.run == 1 && end.signal == SIGKILL; }));
    const Worked second = work_on(folder, study, {.program = PERCALE_PROGRAM, .jobs = 2, .ended = {}, .stop_asked = {}});
    CHECK(second.left.empty());
    REQUIRE(second.ends.size() == 1);
    CHECK(second.ends[0].run == 1);
}

TEST_CASE("asked to stop, no other run is begun and those that run are left for the next call") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"duration\" = [500.0, 501.0, 502.0]\n"));
    int asked = 0;
    const Worked worked =
        work_on(folder, study, {.program = PERCALE_PROGRAM, .jobs = 1, .ended = {}, .stop_asked = [&] { return ++asked > 200; }});
    CHECK(worked.ends.size() == 1);
    CHECK(worked.left.size() == 3);
}

TEST_CASE("a program that cannot be started leaves all runs with their exit code") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01]\n"));
    const Worked worked = work_on(folder, study, {.program = folder.path("none"), .jobs = 1, .ended = {}, .stop_asked = {}});
    REQUIRE(worked.ends.size() == 1);
    CHECK(worked.ends[0].exit_code == 127);
    CHECK(worked.left.size() == 1);
}

}  // namespace percale::scenes::test::study_workers_test
