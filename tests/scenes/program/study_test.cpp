#include "tests/scenes/program/run_program.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::program::test::study_test {
using percale::scenes::test::write_study;

namespace {

/// The program in a folder with a scene, sheet.toml, and a study of it, study.toml.
ProgramRun program(const TestFolder& folder, const std::vector<std::string>& arguments) {
    write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n");
    return run_program(arguments, folder.path());
}

}  // namespace

TEST_CASE("study of a study file, or of the folder of one, is a sweep") {
    const TestFolder folder, other;
    const ProgramRun run = program(folder, {"study", "study.toml", "-o", "out", "--jobs", "2"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("2 of 2 runs done, 0 failed, 0 not as expected; out/study.csv") != std::string::npos);
    REQUIRE(program(other, {"sweep", "study.toml", "-o", "out"}).exit_code == 0);
    CHECK(folder.read("out/study.csv") == other.read("out/study.csv"));
    CHECK(folder.read("out/study.svg") == other.read("out/study.svg"));
    std::filesystem::remove_all(folder.path("out/runs/00001"));
    CHECK(program(folder, {"study", "out", "--collect", "--quiet"}).exit_code == 1);
    CHECK(program(folder, {"study", "study.toml", "--preset", "sweep", "-o", "out", "--run", "1-1"}).exit_code == 0);
    CHECK(program(folder, {"study", "out", "--quiet"}).exit_code == 0);
    CHECK(folder.read("out/study.csv") == other.read("out/study.csv"));
}

TEST_CASE("study with a preset does what the command of its name does") {
    const TestFolder folder;
    const ProgramRun compared = program(folder, {"study", "sheet.toml", "--preset", "compare", "--schemes", "rk4", "--steps",
                                                 "1/100", "--repeats", "1", "--set", "duration=0.05"});
    CHECK(compared.exit_code == 0);
    CHECK(compared.out.find("reference: rk4 at ") == 0);
    CHECK(folder.read("sheet/compare.csv").find("\nrk4,0.01,,finished,5,") != std::string::npos);
    CHECK(folder.read("sheet/compare.svg").find("</svg>") != std::string::npos);
    const ProgramRun stressed = program(folder, {"study", "sheet.toml", "--preset", "stress", "--schemes", "rk4,backward_euler",
                                                 "--steps", "0.01", "--factors", "1,100", "--jobs", "2"});
    CHECK(stressed.exit_code == 0);
    CHECK(stressed.out.find("4 cells of at most 16 steps\n") == 0);
    const std::string table = folder.read("sheet/stress.csv"), map = folder.read("sheet/stress.svg");
    const ProgramRun alone =
        program(folder, {"stress", "sheet.toml", "--schemes", "rk4,backward_euler", "--steps", "0.01", "--factors", "1,100"});
    CHECK(alone.out == stressed.out);
    CHECK(folder.read("sheet/stress.csv") == table);
    CHECK(folder.read("sheet/stress.svg") == map);
    CHECK(program(folder, {"study", "--preset", "stress", "--cell", "700"}).exit_code == 0);
    CHECK(folder.holds("stress_cell_700/stress.csv"));
}

TEST_CASE("study refuses what has no preset, and options that the preset does not take") {
    const TestFolder folder;
    CHECK(refused(program(folder, {"study", "sheet.toml"}), "sheet.toml: is not a study file; for a scene use --preset compare"));
    CHECK(refused(program(folder, {"study", "absent.toml"}), "absent.toml"));
    CHECK(refused(program(folder, {"study"}), "FILE: is needed"));
    CHECK(refused(program(folder, {"study", "--preset", "compare"}), "FILE: is needed by --preset compare"));
    CHECK(refused(program(folder, {"study", "sheet.toml", "--preset", "stres"}), "did you mean 'stress'?"));
    CHECK(refused(program(folder, {"study", "sheet.toml", "--preset", "compare", "--slurm"}),
                  "--slurm: --preset compare does not take this option"));
    CHECK(refused(program(folder, {"study", "study.toml", "--schemes", "rk4"}), "--schemes: --preset sweep does not take"));
    CHECK(refused(program(folder, {"study", "sheet.toml", "--preset", "sweep"}), "unknown key 'duration' in a study"));
    CHECK(refused(program(folder, {"study", "--preset", "stress", "--jobs", "0"}), "1 ... 1024"));
    CHECK(folder.file_count() == 2);
}

TEST_CASE("the help of study names its presets, and each preset's help its own options alone") {
    const std::string study = run_program({"study", "--help"}).out, compare = run_program({"compare", "--help"}).out;
    for (const char* word : {"--preset", "compare, stress or sweep", "--schemes", "--factors", "--slurm"})
        CHECK(study.find(word) != std::string::npos);
    CHECK(compare.find("--schemes") != std::string::npos);
    for (const char* word : {"--preset", "--factors", "--slurm", "--jobs"}) CHECK(compare.find(word) == std::string::npos);
}

}  // namespace percale::program::test::study_test
