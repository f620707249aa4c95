#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::run_test {
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

nlohmann::json report_in(const TestFolder& folder, const std::string& name) {
    return nlohmann::json::parse(folder.read(name + "/report.json"));
}

/// The last two columns of steps.csv: contact and state hash.
std::vector<std::string> hashes_in(const TestFolder& folder, const std::string& name) {
    std::istringstream table(folder.read(name + "/steps.csv"));
    std::vector<std::string> hashes;
    for (std::string line; std::getline(table, line);) hashes.push_back(line.substr(line.rfind(',', line.rfind(',') - 1)));
    return hashes;
}

}  // namespace

TEST_CASE("run writes into a folder of the scene's name where it is called") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("scenes"));
    folder.write("scenes/sheet on box.toml", sheet_on_box());
    const ProgramRun run = run_program({"run", "scenes/sheet on box.toml"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.error.empty());
    CHECK(line_count(run.out) == 2);
    const auto report = report_in(folder, "sheet on box");
    CHECK(report.at("status") == "finished");
    CHECK(report.at("intersections") == 0);
    CHECK(folder.holds("sheet on box/frames/sheet_00006.obj"));
    CHECK(folder.holds("sheet on box/obstacles/box_00000.obj"));
    CHECK_FALSE(folder.holds("sheet on box/obstacles/box_00001.obj"));
}

TEST_CASE("a run until rest ends by itself, with a last frame, or fails and says how the cloth moves") {
    const TestFolder folder;
    folder.write("sheet.toml", sheet_on_box());
    const ProgramRun run = run_program({"run", "sheet.toml", "-o", "out", "--set", "duration=rest"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.starts_with("sheet.toml: until rest, at most 20 s; at most 1200 steps of 0.0167 s into out\n"));
    CHECK(run.out.find("finished at rest: ") != std::string::npos);
    const auto report = report_in(folder, "out");
    CHECK(report.at("status") == "finished");
    CHECK(report.at("rest").at("at_rest") == true);
    CHECK(report.at("rest").at("time_s") == report.at("simulated_s"));
    CHECK(report.at("frames").back().at("time") == report.at("simulated_s"));
    CHECK(folder.holds("out/" + report.at("frames").back().at("cloths").at(0).get<std::string>()));
    CHECK(report.at("settings").at("duration") == "rest");
    CHECK(report.at("settings").at("max_duration") == 20.0);
    const ProgramRun early =
        run_program({"run", "sheet.toml", "-o", "early", "--set", "duration=\"rest\"", "--set", "max_duration=0.3", "--quiet"},
                    folder.path());
    CHECK(early.exit_code == 1);
    CHECK(early.error.starts_with(
        "percale: sheet.toml: failed: not at rest (still for half a second, its forces balanced) after 0.3 s, the "));
    const auto failed = report_in(folder, "early");
    CHECK(failed.at("status") == "failed");
    CHECK(failed.at("rest").at("at_rest") == false);
    CHECK(failed.at("rest").at("fastest_cloth") == "sheet");
    CHECK(failed.at("rest").at("largest_speed") == failed.at("speed_at_end"));
    CHECK(refused(run_program({"run", "sheet.toml", "-o", "none", "--set", "duration=rest", "--no-skip"}, folder.path()),
                  "--no-skip"));
}

TEST_CASE("no text says that a distance is inf") {
    const TestFolder folder;
    std::string far = sheet_on_box();
    far.replace(far.find("0.015"), 5, "9.000");
    folder.write("far.toml", far + "[expect]\nsmallest_distance = { above = 0.1 }\n");
    const ProgramRun run = run_program({"run", "far.toml", "-o", "out"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("0 intersecting pairs, never near;") != std::string::npos);
    CHECK(run.out.find("warning: no cloth ever met an obstacle") != std::string::npos);
    CHECK(run.out.find("smallest_distance infinite, expected > 0.1: passed") != std::string::npos);
    CHECK(report_in(folder, "out").at("smallest_distance").is_null());
}

TEST_CASE("a run in which cloth would have torn says so, and whose pins stay behind a body", "[slow]") {
    const TestFolder folder;
    const std::string scene =
        "duration = 0.5\ngravity = [0, 0, 0]\n[fabric.f]\nsprings = { structural = 5, bend = 0.01 }\n"
        "[[cloth]]\nname = \"net\"\nfabric = \"f\"\ngrid = { size = [1, 1], vertices = [9, 9] }\n"
        "pin = \"boundary\"\n[[obstacle]]\nname = \"ram\"\nshape = { sphere = { radius = 0.1 } }\n"
        "motion = [{ time = 0, translation = [0, -0.2, 0] }, { time = 0.5, translation = [0, 2, 0] }]\n";
    folder.write("net.toml", scene);
    const ProgramRun run = run_program({"run", "net.toml", "-o", "out"}, folder.path());
    const std::size_t at_once = run.out.find("warning: at 0."), at_end = run.out.find("warning: the largest strain is ");
    CHECK(at_once < run.out.find("finished: "));
    CHECK(run.out.find("s the largest strain is 1", at_once) < at_end);  // 1 and more, as soon as it is known
    CHECK(at_end != std::string::npos);
    CHECK(run.out.find("the pins of net stay in the world, pin = { box = ..., to = \"ram\" }") != std::string::npos);
}

TEST_CASE("a disk that is full while frames or steps are written leaves no file of the run") {
    if (!std::filesystem::is_character_file("/dev/full")) return;
    for (const std::string file : {"frames/sheet_00003.obj", "steps.csv", "report.json"}) {
        CAPTURE(file);
        const TestFolder folder;
        folder.write("box.toml", sheet_on_box());
        std::filesystem::create_directories(folder.path("out/frames"));
        folder.write("out/frames/mine.obj", "mine");
        std::filesystem::create_symlink("/dev/full", folder.path("out/" + file + ".part"));
        const ProgramRun run = run_program({"run", "box.toml", "-o", "out", "--quiet"}, folder.path());
        CHECK(refused(run, file + ": cannot be written: No space left on device"));
        CHECK(folder.read("out/frames/mine.obj") == "mine");
        CHECK(folder.file_count() == 2);
    }
}

TEST_CASE("a failed expectation is exit code 1, the run still finished and every file there") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 0.05 }\nintersections = 0\n");
    const ProgramRun run = run_program({"run", "sheet.toml", "-o", "out"}, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(line_count(run.error) == 1);
    CHECK(run.error.find("speed_at_end") != std::string::npos);
    const auto report = report_in(folder, "out");
    CHECK(report.at("status") == "finished");
    REQUIRE(report.at("expectations").size() == 2);
    for (const auto& expectation : report.at("expectations"))
        CHECK(expectation.at("passed") == (expectation.at("measure") == "intersections"));
}

TEST_CASE("a step that ends badly is exit code 1, status failed and a reason") {
    const TestFolder folder;
    std::string text = sheet_on_box();
    text.insert(text.find("[[obstacle]]"), "pin = [0]\n");
    text += "\n[[event]]\ntime = 0.0\nmove = { cloth = \"sheet\", vertices = [0], to = [0.0, -0.2, 0.0], over = 0.1 }\n";
    folder.write("drag.toml", text);
    const ProgramRun run = run_program({"run", "drag.toml", "-o", "out"}, folder.path());
    CHECK(run.exit_code == 1);
    const auto report = report_in(folder, "out");
    CHECK(report.at("status") == "failed");
    CHECK(run.error.find(report.at("reason").get<std::string>()) != std::string::npos);
    CHECK(report.at("intersections") == 0);
}

TEST_CASE("a run whose steps were not solved says so in one line, is status unsolved and exit code 1, whatever is expected") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box() + "[expect]\nintersections = 0\n");
    const std::vector<std::string> hurried = {"--set", "step.newton_iterations=2", "--set", "step.newton_tolerance=1e-12",
                                              "--quiet"};
    std::vector<std::string> arguments = {"run", "box.toml", "-o", "out"};
    arguments.insert(arguments.end(), hurried.begin(), hurried.end());
    const ProgramRun run = run_program(arguments, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(line_count(run.error) == 1);
    const auto report = report_in(folder, "out");
    CHECK(report.at("status") == "unsolved");
    CHECK(report.at("expectations").at(0).at("passed") == true);
    CHECK(run.error == "percale: box.toml: unsolved: " + report.at("reason").get<std::string>() + "\n");
    CHECK(report.at("reason").get<std::string>().find("taken unsolved (not_converged or tolerance_missed)") != std::string::npos);
    arguments = {"check", "box.toml"};
    arguments.insert(arguments.end(), hurried.begin(), hurried.end());
    const ProgramRun check = run_program(arguments, folder.path());
    CHECK(check.exit_code == 1);
    CHECK(check.error == run.error);
}

TEST_CASE("wrong input is exit code 2, and no folder is made") {
    const TestFolder folder;
    CHECK(refused(run_program({"run", "absent.toml", "-o", "out"}, folder.path()), "absent.toml"));
    folder.write("empty.toml", "");
    CHECK(run_program({"run", "empty.toml", "-o", "out"}, folder.path()).exit_code == 2);
    folder.write("unknown.toml", falling_sheet() + "[expect]\nlargest_strian = 3\n");
    CHECK(refused(run_program({"run", "unknown.toml", "-o", "out"}, folder.path()), "largest_strain"));
    std::string inside = sheet_on_box();
    inside.replace(inside.find("0.015"), 5, "-0.01");
    folder.write("inside.toml", inside);
    CHECK(refused(run_program({"run", "inside.toml", "-o", "out", "--set", "step.start=refuse"}, folder.path()), "box"));
    folder.write("reference.toml", falling_sheet() + "[expect]\nmatches = { file = \"absent.obj\", within = 1e-3 }\n");
    CHECK(refused(run_program({"run", "reference.toml", "-o", "out"}, folder.path()), "absent.obj"));
    CHECK_FALSE(folder.holds("out"));
    CHECK(folder.holds("out_start.obj"));
    CHECK(folder.file_count() == 5);
}

TEST_CASE("an output folder that cannot be made is wrong input") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    CHECK(refused(run_program({"run", "sheet.toml", "-o", "sheet.toml"}, folder.path()), "sheet.toml"));
    CHECK(folder.read("sheet.toml") == falling_sheet());
}

TEST_CASE("state hashes repeat from run to run and are left out unless asked for") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    CHECK(run_program({"run", "box.toml", "-o", "a", "--replay-hash"}, folder.path()).exit_code == 0);
    CHECK(run_program({"run", "box.toml", "-o", "b", "--replay-hash"}, folder.path()).exit_code == 0);
    CHECK(run_program({"run", "box.toml", "-o", "c"}, folder.path()).exit_code == 0);
    const std::vector<std::string> a = hashes_in(folder, "a"), c = hashes_in(folder, "c");
    REQUIRE(a.size() == 13);
    CHECK(a == hashes_in(folder, "b"));
    for (std::size_t i = 1; i < a.size(); ++i) {
        CHECK(a[i].size() == 18);
        CHECK(c[i] == ",,");
    }
}

TEST_CASE("the tree that finds contacts changes no bit of a run") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    for (const std::string detector : {"fcl", "brute_force", "bullet"})
        CHECK(
            run_program({"run", "box.toml", "-o", detector, "--replay-hash", "--set", "step.detector=" + detector}, folder.path())
                .exit_code == 0);
    CHECK(hashes_in(folder, "fcl") == hashes_in(folder, "brute_force"));
    CHECK(hashes_in(folder, "fcl") == hashes_in(folder, "bullet"));
}

TEST_CASE(
    "run moves cloth out of obstacles first and says so, refused starts leave a picture beside the folder and nothing else") {
    const TestFolder folder;
    std::string inside = sheet_on_box();
    inside.replace(inside.find("0.015"), 5, "-0.01");
    folder.write("inside.toml", inside);
    const ProgramRun run = run_program({"run", "inside.toml", "-o", "out"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("36 vertices of sheet moved out of box before the start, the farthest by 0.0") != std::string::npos);
    CHECK(report_in(folder, "out").at("start_repair").at(0).at("vertices_moved") == 36);
    CHECK(report_in(folder, "out").at("intersections") == 0);
    CHECK_FALSE(folder.holds("out_start.obj"));

    const ProgramRun refused = run_program({"run", "inside.toml", "-o", "no/", "--set", "step.start=refuse"}, folder.path());
    CHECK(refused.exit_code == 2);
    CHECK(line_count(refused.error) == 1);
    CHECK(refused.error.find("inside.toml:15:1: the cloth starts inside box: 36 vertices") != std::string::npos);
    CHECK(refused.error.find("(the triangles concerned: no_start.obj)") != std::string::npos);
    CHECK_FALSE(folder.holds("no"));
    const std::string picture = folder.read("no_start.obj");
    CHECK(std::count(picture.begin(), picture.end(), 'f') == 50);
}

}  // namespace percale::program::test::run_test
