#include "scenes/study/batch_files.h"

#include <algorithm>
#include <cstdlib>

#include "tests/scenes/message_of.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::batch_files_test {

TEST_CASE("a word reaches the program behind a shell as it was") {
    const TestFolder folder;
    for (const std::string word : {"plain", "with space", "it's", "$HOME `x` \"y\" \\", "new\nline"}) {
        const std::string command = "printf %s " + shell_word(word) + " > " + shell_word(folder.path("out"));
        REQUIRE(std::system(command.c_str()) == 0);
        CHECK(folder.read("out") == word);
    }
}

TEST_CASE("make does the runs that are left, each once") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005, 0.004]\n"));
    const StudyFolder runs(folder.path("a $tudy"));
    runs.begin(study);
    const BatchFiles files = batch_files(study, runs, PERCALE_PROGRAM);
    CHECK(std::count(files.commands.begin(), files.commands.end(), '\n') == 3);
    folder.write("a $tudy/Makefile", files.makefile);
    const std::string make = "make -s -j2 -C " + shell_word(runs.path()) + " > " + shell_word(folder.path("log")) + " 2>&1";
    REQUIRE(std::system(make.c_str()) == 0);
    CHECK(runs_left(runs, study).empty());
    std::filesystem::remove_all(runs.folder_of(1));
    REQUIRE(std::system(make.c_str()) == 0);
    CHECK(runs_left(runs, study).empty());
}

TEST_CASE("a Slurm array has at most 1,000 tasks, which do all runs, the last task those that are left") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"duration\" = { from = 0.1, to = 0.2, count = 2500 }\n"));
    const StudyFolder runs(folder.path("out"));
    // A program that writes down what it is asked for.
    const std::string program =
        folder.write("program.sh", "#!/bin/sh\necho \"$5\" >> " + shell_word(folder.path("asked")) + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string script = folder.write("slurm.sh", batch_files(study, runs, program).slurm);
    CHECK(folder.read("slurm.sh").find("#SBATCH --array=0-833\n") != std::string::npos);
    for (const char* task : {"0", "1", "833"})
        REQUIRE(std::system(("SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh " + shell_word(script)).c_str()) == 0);
    CHECK(folder.read("asked") == "0-2\n3-5\n2499-2499\n");
}

TEST_CASE("a folder or program whose name has a line end is refused: no Makefile and no list of commands holds it") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01]\n"));
    CHECK(message_of([&] { batch_files(study, StudyFolder(folder.path("a\nb")), "percale"); }).find("line end") !=
          std::string::npos);
    CHECK(message_of([&] { batch_files(study, StudyFolder(folder.path("ab")), "per\ncale"); }).find("line end") !=
          std::string::npos);
}

}  // namespace percale::scenes::test::batch_files_test
