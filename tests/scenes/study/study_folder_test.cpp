#include "scenes/study/study_folder.h"

#include "percale/error.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::study_folder_test {

TEST_CASE("a folder takes up its own study and refuses another") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n"));
    const StudyFolder runs(folder.path("out"));
    runs.begin(study);
    CHECK_NOTHROW(runs.begin(study));
    CHECK_THROWS_WITH(runs.begin(read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.004]\n"))),
                      Catch::Contains("out: holds another study"));
    folder.write("file", "");
    CHECK_THROWS_WITH(StudyFolder(folder.path("file")).begin(study), Catch::Contains("file: cannot be made"));
}

TEST_CASE("a run is done once its report is whole, failed or not, but not where it was stopped") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005, 0.004, 0.003]\n"));
    const StudyFolder runs(folder.path("out"));
    runs.begin(study);
    CHECK(runs.folder_of(12).ends_with("out/runs/00012"));
    const auto report = [&](std::size_t run, const std::string& text) {
        std::filesystem::create_directories(runs.folder_of(run));
        folder.write("out/runs/0000" + std::to_string(run) + "/report.json", text);
    };
    report(0, "{\"status\": \"finished\"}");
    report(1, "{\"status\": \"failed\"}");
    report(2, "{\"status\": \"stopped\"}");
    CHECK(runs_left(runs, study) == std::vector<std::size_t>{2, 3});
    report(3, "{\"status\": \"fini");
    CHECK_FALSE(runs.is_done(3));
    folder.write("out/runs/00003.log", "percale: no space\nmore\n");
    CHECK(runs.complaint_of(3) == "percale: no space");
    CHECK(runs.complaint_of(0).empty());
}

TEST_CASE("a run is made by its folder, one thread and the values of its keys") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n"));
    const StudyFolder runs(folder.path("out"));
    CHECK(run_words(study, runs, 1, "percale") ==
          std::vector<std::string>{"percale", "run", study.scene, "-o", runs.folder_of(1), "--quiet", "--set", "step.threads=1",
                                   "--set", "step.time_step=0.005", "--set", "output.frames=none"});
}

}  // namespace percale::scenes::test::study_folder_test
