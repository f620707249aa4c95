#include "scenes/common/folder_lock.h"
#include "tests/scenes/program/run_program.h"
#include "tests/scenes/program/started_run.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::program::test::sweep_test {
using percale::scenes::test::write_study;

TEST_CASE("sweep makes all runs and one table, and does what is left when it is called again") {
    const TestFolder folder;
    write_study(folder, "\"step.time_step\" = [0.01, 0.005, 0.002]\n");
    const ProgramRun run = run_program({"sweep", "study.toml", "-o", "out", "--jobs", "2"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("3 of 3 runs done, 0 failed, 0 not as expected; out/study.csv") != std::string::npos);
    const std::string table = folder.read("out/study.csv");
    for (const char* name :
         {"costs.csv", "study.svg", "slurm.sh", "Makefile", "commands.txt", "study.json", "runs/00002/report.json"})
        CHECK(folder.holds(std::string("out/") + name));
    std::filesystem::remove_all(folder.path("out/runs/00001"));
    CHECK(run_program({"sweep", "out", "--collect", "--quiet"}, folder.path()).exit_code == 1);
    CHECK(folder.read("out/study.csv") != table);
    CHECK(run_program({"sweep", "out", "--run", "0-1", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(run_program({"sweep", "out", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(folder.read("out/study.csv") == table);
}

TEST_CASE("runs that are not as expected are exit code 1, wrong words exit code 2 with nothing written") {
    const TestFolder folder;
    write_study(folder, "\"duration\" = [0.1, 0.5]\n");
    CHECK(run_program({"sweep", "study.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 1);
    CHECK(refused(run_program({"sweep", "study.toml", "-o", "new", "--jobs", "0"}, folder.path()), "1 ... 1024"));
    CHECK(refused(run_program({"sweep", "absent.toml", "-o", "new"}, folder.path()), "absent.toml"));
    CHECK(refused(run_program({"sweep", "out", "-o", "new"}, folder.path()), "is named already"));
    for (const char* range : {"1", "2-1", "0-2", "a-b", "0-1x"})
        CHECK(refused(run_program({"sweep", "out", "--run", range}, folder.path()), "must be FIRST-LAST, 0 ... 1"));
    CHECK_FALSE(folder.holds("new"));
    write_study(folder, "\"duration\" = [0.1, 0.6]\n");
    CHECK(refused(run_program({"sweep", "study.toml", "-o", "out"}, folder.path()), "holds another study"));
}

TEST_CASE("a study with a run that crossed names it and is exit code 1, for a part of the runs, too") {
    const TestFolder folder;
    write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n");
    REQUIRE(run_program({"sweep", "study.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    std::string report = folder.read("out/runs/00001/report.json");
    const std::string finished = "\"status\": \"finished\"";
    REQUIRE(report.find(finished) != std::string::npos);
    report.replace(report.find(finished), finished.size(), "\"status\": \"crossed\", \"reason\": \"3 pairs\"");
    folder.write("out/runs/00001/report.json", report);
    const ProgramRun all = run_program({"sweep", "out", "--collect", "--quiet"}, folder.path());
    CHECK(all.exit_code == 1);
    CHECK(all.error == "percale: out/runs/00001: crossed: 3 pairs\n");
    CHECK(folder.read("out/study.csv").find(",crossed,") != std::string::npos);
    CHECK(run_program({"sweep", "out", "--run", "0-0", "--quiet"}, folder.path()).exit_code == 0);
    const ProgramRun part = run_program({"sweep", "out", "--run", "1-1", "--quiet"}, folder.path());
    CHECK(part.exit_code == 1);
    CHECK(part.error == all.error);
}

TEST_CASE("runs of a study that a signal has stopped are no success, whether all were asked for or some") {
    for (const bool part : {true, false}) {
        const TestFolder folder;
        write_study(folder, "\"duration\" = [10000.0, 20000.0]\n");
        std::vector<std::string> arguments = {"sweep", "study.toml", "-o", "out", "--quiet"};
        if (part) arguments.insert(arguments.end(), {"--run", "0-1"});
        StartedRun run(folder, arguments);
        run.wait_for(folder, "out/runs/00000/steps.csv.part");
        CHECK(run.end(SIGTERM) == 130);
    }
}

TEST_CASE("a study has one sweep of all its runs at a time; parts of it may be done meanwhile") {
    const TestFolder folder;
    write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n");
    REQUIRE(run_program({"sweep", "study.toml", "-o", "out", "--quiet"}, folder.path()).exit_code == 0);
    const percale::scenes::FolderLock other(folder.path("out"));
    CHECK(refused(run_program({"sweep", "out", "--quiet"}, folder.path()), "out: another run writes into it"));
    CHECK(run_program({"sweep", "out", "--run", "0-0", "--quiet"}, folder.path()).exit_code == 0);
    CHECK(run_program({"sweep", "out", "--collect", "--quiet"}, folder.path()).exit_code == 0);
}

}  // namespace percale::program::test::sweep_test
