#include "scenes/study/study.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "percale/error.h"
#include "scenes/common/whole_file.h"
#include "tests/scenes/study/study_files.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::study_test {
namespace {

std::string refused(const TestFolder& folder, const std::string& vary, const std::string& top = "") {
    try {
        read_study(write_study(folder, vary, top));
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was refused";
}

}  // namespace

TEST_CASE("runs are all combinations of lists and ranges, the last key fastest") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder,
                                               "\"fabric.sheet.springs.bend\" = [0.01, 0.1]\n"
                                               "\"step.time_step\" = { from = 0.001, to = 0.01, count = 3, scale = \"log\" }\n"
                                               "\"step.scheme\" = [\"rk4\"]\n"));
    CHECK(study.keys == std::vector<std::string>{"fabric.sheet.springs.bend", "step.time_step", "step.scheme"});
    REQUIRE(study.runs.size() == 6);
    CHECK(study.runs[0] == std::vector<std::string>{"0.01", "0.001", "\"rk4\""});
    CHECK(study.runs[2][1] == "0.01");
    CHECK(std::stod(study.runs[1][1]) == Approx(std::sqrt(1e-5)));
    CHECK(study.runs[3] == std::vector<std::string>{"0.1", "0.001", "\"rk4\""});
    CHECK(study.plot_key == "fabric.sheet.springs.bend");
    CHECK(study.forms == std::vector<std::string>{"list", "log", "list"});
    const std::vector<Override> overrides = overrides_of(study, 4);
    REQUIRE(overrides.size() == 4);
    CHECK(overrides[0].key == "fabric.sheet.springs.bend");
    CHECK(overrides[0].value == "0.1");
    CHECK(overrides[3].value == "none");
}

TEST_CASE("random values are drawn for each run, the same for the same seed and others for another") {
    const TestFolder folder;
    const std::string vary = "\"step.time_step\" = [0.005, 0.01]\n\"fabric.sheet.area_density\" = { uniform = [0.1, 0.4] }\n";
    const Study study = read_study(write_study(folder, vary, "draws = 5\nseed = 3\n"));
    REQUIRE(study.runs.size() == 10);
    CHECK(study.runs[4][0] == "0.005");
    CHECK(study.runs[5][0] == "0.01");
    std::set<std::string> values;
    for (const auto& run : study.runs) {
        values.insert(run[1]);
        CHECK((std::stod(run[1]) >= 0.1 && std::stod(run[1]) < 0.4));
    }
    CHECK(values.size() == 10);
    CHECK(read_study(write_study(folder, vary, "draws = 5\nseed = 3\n")).runs == study.runs);
    CHECK(read_study(write_study(folder, vary, "draws = 5\nseed = 4\n")).runs != study.runs);
}

TEST_CASE("values that a scene refuses are refused with the run before any is made") {
    const TestFolder folder;
    const std::string message = refused(folder, "\"step.time_step\" = [0.01, -1.0]\n");
    CHECK(message.find("run 1 of 2: ") != std::string::npos);
    CHECK(message.find("step.time_step = -1") != std::string::npos);
    CHECK(refused(folder, "\"step.time_stp\" = [0.01]\n").find("time_step") != std::string::npos);
}

TEST_CASE("what is no study is refused with its place and what it should be") {
    const TestFolder folder;
    const auto contains = [&](const std::string& vary, const std::string& top, const std::string& wanted) {
        const std::string message = refused(folder, vary, top);
        CAPTURE(message, wanted);
        CHECK(message.find(wanted) != std::string::npos);
    };
    const std::string good = "\"step.time_step\" = [0.01]\n";
    contains(good, "sceene = 1\n", "unknown key 'sceene' in a study; did you mean 'scene'?");
    contains(good, "draws = 2\n", "draws is for random values, and [vary] has none");
    contains("\"step.time_step\" = { uniform = [0.01, 0.02] }\n", "draws = 0\n", "draws must be a whole number, 1 ... 1000000");
    contains("\"step.time_step\" = []\n", "", "is an empty list");
    contains("\"step.time_step\" = 0.01\n", "", "must be a list of values, a range");
    contains("\"step.time_step\" = { from = 0.1, count = 3 }\n", "", "this one lacks 'to'");
    contains("\"step.time_step\" = { from = 0.1, to = 0.2, count = 1 }\n", "", "count must be a whole number, 2 ...");
    contains("\"step.time_step\" = { from = 0.0, to = 0.2, count = 3, scale = \"log\" }\n", "", "of numbers above 0");
    contains("\"step.time_step\" = { from = 0.1, to = 0.2, cuont = 3 }\n", "", "did you mean 'count'?");
    contains("\"step.time_step\" = { uniform = [0.2, 0.1] }\n", "", "uniform ends before it begins");
    contains("\"step.time_step\" = { normal = [0.2] }\n", "", "normal must be a list of 2 numbers");
    contains(
        "\"step.time_step\" = { from = 1e-3, to = 1e-2, count = 2000 }\n\"duration\" = { from = 0.1, to = 0.2, count = 2000 }\n",
        "", "more than 1000000 runs");
    contains(good, "plot = [\"step.time_stp\", \"largest_strain\"]\n",
             "none of the keys that vary; did you mean 'step.time_step'?");
    contains(good, "plot = [\"step.time_step\", \"largest_stran\"]\n", "did you mean 'largest_strain'?");
    contains("\"step.scheme\" = [\"rk4\"]\n", "plot = [\"step.scheme\", \"largest_strain\"]\n", "are numbers");
    folder.write("none.toml", "scene = \"sheet.toml\"\n");
    CHECK_THROWS_WITH(read_study(folder.path("none.toml")), Catch::Contains("needs [vary]"));
    CHECK_THROWS_AS(read_study(folder.path("absent.toml")), SceneError);
}

TEST_CASE("how values were said is known: at random or not, evenly or evenly in the logarithm") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder,
                                               "\"step.time_step\" = { from = 0.005, to = 0.01, count = 2 }\n"
                                               "\"fabric.sheet.area_density\" = { log_uniform = [0.1, 0.4] }\n"
                                               "\"fabric.sheet.springs.bend\" = { normal = [0.1, 0.01] }\n",
                                               "draws = 2\n"));
    CHECK(study.forms == std::vector<std::string>{"linear", "log_uniform", "normal"});
    CHECK(is_random_form("uniform"));
    CHECK(is_random_form("normal"));
    CHECK(is_random_form("log_uniform"));
    CHECK_FALSE((is_random_form("list") || is_random_form("linear") || is_random_form("log")));
    CHECK((is_log_form("log") && is_log_form("log_uniform")));
    CHECK_FALSE((is_log_form("list") || is_log_form("linear") || is_log_form("uniform") || is_log_form("normal")));
}

TEST_CASE("a study file is known from a scene file, and what is no TOML is refused") {
    const TestFolder folder;
    CHECK(is_study_file(write_study(folder, "\"step.time_step\" = [0.01]\n")));
    CHECK(is_study_file(folder.write("begun.toml", "[vary]\n")));
    CHECK_FALSE(is_study_file(folder.path("sheet.toml")));
    CHECK_THROWS_AS(is_study_file(folder.write("broken.toml", "scene = [")), SceneError);
    CHECK_THROWS_AS(is_study_file(folder.path("absent.toml")), SceneError);
}

TEST_CASE("a study is stored with the settings of its scene and comes back") {
    const TestFolder folder;
    const Study study = read_study(write_study(folder, "\"step.time_step\" = [0.01, 0.005]\n", "frames = \"obj\"\n"));
    const std::string text = study_text(study);
    const Study again = stored_study(folder.write("study.json", text));
    CHECK(again.keys == study.keys);
    CHECK(again.runs == study.runs);
    CHECK(again.forms == study.forms);
    CHECK(again.frames == "obj");
    CHECK(again.plot_measure == study.plot_measure);
    std::string earlier = text;
    earlier.replace(earlier.find("\"forms\""), 7, "\"other\"");  // what had none
    CHECK(stored_study(folder.write("earlier.json", earlier)).forms == std::vector<std::string>{"list"});
    std::string sheet = folder.read("sheet.toml");
    sheet.replace(sheet.find("area_density = 0.2"), 18, "area_density = 0.3");
    folder.write("sheet.toml", sheet);
    CHECK(study_text(study) != text);
    CHECK_THROWS_WITH(stored_study(folder.write("bad.json", "{\"keys\": 3}")),
                      Catch::Contains("bad.json: is not what percale sweep has written"));
}

}  // namespace percale::scenes::test::study_test
