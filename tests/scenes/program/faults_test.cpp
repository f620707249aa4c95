#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/scenes/program/started_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::faults_test {

// What happens where the system does not do what it is asked: the table of faults in scenes/export/README.md.
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

/// Runs the program with files limited to so many blocks of 512 bytes.
ProgramRun run_limited(const TestFolder& folder, int blocks, const std::string& arguments) {
    const std::string command = "cd " + quoted(folder.path()) + " && ulimit -f " + std::to_string(blocks) + " && exec " +
                                quoted(PERCALE_PROGRAM) + " " + arguments + " >/dev/null 2>" + quoted(folder.path("error"));
    const int status = std::system(("sh -c " + quoted(command)).c_str());
    ProgramRun run{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), "", folder.read("error")};
    std::filesystem::remove(folder.path("error"));
    return run;
}

bool holds_part(const TestFolder& folder) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
        if (entry.path().extension() == ".part") return true;
    return false;
}

const std::string many_steps = "--set step.time_step=1e-4";

}  // namespace

TEST_CASE("a file that may not grow is an error with its name and the reason, and leaves nothing") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const ProgramRun run = run_limited(folder, 40, "run sheet.toml -o out " + many_steps);
    CHECK(refused(run, "out/steps.csv: cannot be written: File too large"));
    CHECK(folder.file_count() == 1);
    CHECK_FALSE(folder.holds("out"));
    std::string expectations = "[expect]\n";
    for (const char* measure : {"intersections", "deepest_penetration", "largest_strain", "speed_at_end", "energy_gain"})
        expectations += std::string(measure) + " = { below = 1e6 }\n";
    folder.write("sheet.toml", falling_sheet() + expectations);
    const ProgramRun check = run_limited(folder, 1, "check sheet.toml --junit out.xml");
    CHECK(check.exit_code == 2);
    CHECK(check.error.find("out.xml: cannot be written: File too large") != std::string::npos);
    CHECK_FALSE(folder.holds("out.xml"));
    CHECK_FALSE(holds_part(folder));
}

TEST_CASE("where a checkpoint was written, a full disk leaves what it needs, and the run is resumed from it") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const std::string arguments = "run sheet.toml --checkpoint 0.01 " + many_steps;
    REQUIRE(run_limited(folder, 100000, arguments + " -o plain").exit_code == 0);
    const ProgramRun run = run_limited(folder, 100, arguments + " -o out");
    CHECK(refused(run, "steps.csv: cannot be written: File too large"));
    CHECK_FALSE(folder.holds("out/report.json"));
    REQUIRE(folder.holds("out/checkpoint.percale"));
    CHECK(run_limited(folder, 100000, arguments + " --resume out/checkpoint.percale").exit_code == 0);
    CHECK(folder.read("out/steps.csv") == folder.read("plain/steps.csv"));
    CHECK_FALSE(holds_part(folder));
}

TEST_CASE("a checkpoint that cannot be written leaves the one before") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const std::string arguments = "run sheet.toml --checkpoint 0.02 -o out " + many_steps;
    REQUIRE(run_limited(folder, 100000, arguments).exit_code == 0);
    const std::string before = folder.read("out/checkpoint.percale");
    // A symbolic link is followed: the part of the checkpoint goes to a disk that is full.
    if (!std::filesystem::is_character_file("/dev/full")) return;
    std::filesystem::create_symlink("/dev/full", folder.path("out/checkpoint.percale.part"));
    const ProgramRun run = run_program({"run", "sheet.toml", "--checkpoint", "0.02", "--set", "step.time_step=1e-4", "--resume",
                                        "out/checkpoint.percale", "--quiet"},
                                       folder.path());
    CHECK(run.exit_code == 0);  // at its end no checkpoint is due
    CHECK(folder.read("out/checkpoint.percale") == before);
    const ProgramRun again = run_program(
        {"run", "sheet.toml", "--checkpoint", "0.02", "--set", "step.time_step=1e-4", "-o", "out", "--quiet"}, folder.path());
    CHECK(refused(again, "out/checkpoint.percale: cannot be written: No space left on device"));
    CHECK_FALSE(folder.holds("out/checkpoint.percale"));
    CHECK(folder.file_count() == 1);
}

TEST_CASE("places where no folder or file can be made are reported with the reason") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    folder.write("file", "mine");
    const auto run_into = [&](const std::string& out) { return run_program({"run", "sheet.toml", "-o", out}, folder.path()); };
    CHECK(refused(run_into("file/out"), "file/out: cannot be made: Not a directory"));
    if (std::filesystem::is_directory("/proc/self")) CHECK(refused(run_into("/proc/percale"), "/proc/percale: cannot be made: "));
    std::filesystem::create_directories(folder.path("out"));
    folder.write("out/frames", "mine");
    const ProgramRun run = run_program({"run", "sheet.toml", "-o", "out", "--quiet"}, folder.path());
    CHECK(refused(run, "out/frames: cannot be made: "));
    CHECK(folder.read("out/frames") == "mine");
    CHECK(folder.file_count() == 3);
    std::filesystem::create_directories(folder.path("folder/steps.csv"));
    CHECK(refused(run_program({"run", "sheet.toml", "-o", "folder", "--quiet"}, folder.path()), "steps.csv"));
}

TEST_CASE("without permission to write a folder the run is refused") {
    if (geteuid() == 0) return;  // who may do everything
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    std::filesystem::create_directories(folder.path("out"));
    chmod(folder.path("out").c_str(), 0555);
    CHECK(refused(run_program({"run", "sheet.toml", "-o", "out", "--quiet"}, folder.path()), "Permission denied"));
    chmod(folder.path("out").c_str(), 0755);
}

TEST_CASE("what a killed run leaves is recognised and removed by the next run into its folder, and nothing else is") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    {
        StartedRun run(folder, {"run", "sheet.toml", "-o", "out", "--set", "duration=1000", "--set", "step.time_step=1e-5",
                                "--fps", "1000", "--checkpoint", "0.005"});
        run.wait_for(folder, "out/checkpoint.percale");
        CHECK(run.end(SIGKILL) == -1);
    }
    REQUIRE(folder.holds("out/steps.csv.part"));
    REQUIRE(folder.holds("out/frames/sheet_00005.obj"));
    folder.write("out/frames/sheet_00007.obj.part", "half");
    folder.write("out/frames/mine.obj", "mine");
    folder.write("out/frames/sheet_final.obj", "mine");
    folder.write("out/report.json.part", "half");
    folder.write("out/notes.part", "mine");
    REQUIRE(run_program({"run", "sheet.toml", "-o", "out", "--quiet", "--fps", "20"}, folder.path()).exit_code == 0);
    const auto report = nlohmann::json::parse(folder.read("out/report.json"));
    const int frames = static_cast<int>(report.at("frames").size());
    CHECK(frames == 3);
    CHECK(folder.read("out/frames/mine.obj") == "mine");
    CHECK(folder.read("out/frames/sheet_final.obj") == "mine");
    CHECK(folder.read("out/notes.part") == "mine");
    CHECK(folder.file_count() == 1 + 2 + frames + 3);
}

TEST_CASE("a second run into a folder is refused while the first lives, and a run that was killed leaves no lock") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    StartedRun first(folder, {"run", "sheet.toml", "-o", "out", "--set", "duration=1000", "--set", "output.fps=1000"});
    first.wait_for(folder, "out/frames/sheet_00003.obj");
    const ProgramRun second = run_program({"run", "sheet.toml", "-o", "out"}, folder.path());
    CHECK(refused(second, "out: another run writes into it"));
    CHECK(folder.holds("out/frames/sheet_00003.obj"));
    first.end(SIGKILL);
    CHECK(run_program({"run", "sheet.toml", "-o", "out"}, folder.path()).exit_code == 0);
    CHECK_FALSE(holds_part(folder));
}

TEST_CASE("what may give bytes for ever, or none, is refused at once by every command for every kind of file") {
    const TestFolder folder;
    const auto scene = [&](const std::string& name, const std::string& cloth, const std::string& rest) {
        folder.write(name,
                     "duration = 0.01\n[fabric.f]\nsprings = { structural = 100.0 }\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\n" +
                         cloth + "\n" + rest);
    };
    const std::string grid = "grid = { size = [1, 1], vertices = [5, 5] }";
    folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    std::filesystem::create_directories(folder.path("run"));
    for (const char* name : {"pipe.toml", "pipe.obj", "pipe.off", "pipe.ply", "pipe.stl", "pipe.glb", "pipe.gltf", "pipe.fbx",
                             "pipe.json", "pipe.pc2", "pipe.percale", "run/report.json", "run/steps.csv"})
        REQUIRE(mkfifo(folder.path(name).c_str(), 0600) == 0);
    std::vector<std::vector<std::string>> calls;
    for (const std::string format : {"obj", "off", "ply", "stl", "glb", "gltf", "fbx"}) {
        scene(format + ".toml", "mesh = \"pipe." + format + "\"", "");
        calls.push_back({"run", format + ".toml", "-o", "out"});
        calls.push_back({"doctor", "pipe." + format});
        calls.push_back({"picture", "pipe." + format, "-o", "out.png"});
        calls.push_back({"drape", "sheet.obj", "pipe." + format, "-o", "out.obj"});
    }
    scene("seams.toml", grid, "[[seam]]\nfile = \"pipe.json\"\n");
    scene("rest.toml", "mesh = \"sheet.obj\"\nrest = \"pipe.obj\"", "");
    scene("pattern.toml", "pattern = \"pipe.json\"", "");
    scene("cache.toml", grid, "[[obstacle]]\nname = \"o\"\nmesh = \"sheet.obj\"\ncache = \"pipe.pc2\"\n");
    scene("zero.toml", "mesh = \"/dev/zero\"", "");
    scene("matches.toml", grid, "[expect]\nmatches = { file = \"pipe.obj\", within = 1.0 }\n");
    for (const char* name :
         {"pipe.toml", "seams.toml", "rest.toml", "pattern.toml", "cache.toml", "zero.toml", "matches.toml", "/dev/zero"})
        calls.push_back({"check", name});
    calls.insert(calls.end(), {{"sew", "pipe.json", "-o", "out.obj"},
                               {"sew", "pipe.toml", "-o", "out.obj"},
                               {"sweep", "pipe.toml", "-o", "out"},
                               {"run", "--resume", "pipe.percale", "cache.toml"},
                               {"certify", "run"},
                               {"report", "run"},
                               {"replay", "run", "run"}});
    for (const std::vector<std::string>& call : calls) {
        CAPTURE(call);
        const ProgramRun run = run_program(call, folder.path());
        CHECK(run.exit_code == 2);
        CHECK(line_count(run.error) <= 1);
    }
    CHECK_FALSE(folder.holds("out"));
}

}  // namespace percale::program::test::faults_test
