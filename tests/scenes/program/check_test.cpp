#include <filesystem>

#include "tests/scenes/program/started_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::check_test {
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The output without what differs from call to call, which is how each scene's result came about.
std::string results(std::string text) {
    for (const std::string part : {"kept: finished earlier", ", resumed at", "; run again: "}) {
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part)) {
            const std::size_t end = part.front() == 'k' ? at + part.size() : text.find('\n', at);
            text.replace(at, end - at, part.front() == 'k' ? "finished" : "");
        }
    }
    return text.substr(0, text.rfind("; "));
}

}  // namespace

TEST_CASE("check says of every expectation whether it passed, and writes nothing") {
    const TestFolder folder;
    folder.write("good.toml", sheet_on_box() + "[expect]\nintersections = 0\nlargest_strain = { below = 0.5 }\n");
    const ProgramRun run = run_program({"check", "good.toml"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.error.empty());
    CHECK(run.out.rfind("good.toml: finished: 12 steps, 0.2 s\n", 0) == 0);
    CHECK(run.out.find("intersections 0") != std::string::npos);
    CHECK(run.out.find("< 0.5") != std::string::npos);
    CHECK(ends_with(run.out, "1 of 1 scenes finished, 2 of 2 expectations passed\n"));
    CHECK(folder.file_count() == 1);
}

TEST_CASE("check --update writes the files that are compared with, then they match, and the other expectations are judged") {
    const TestFolder folder;
    folder.write("scene.toml", falling_sheet() +
                                   "[[expect]]\nmatches = { file = \"end.obj\", within = 1e-12 }\n"
                                   "[[expect]]\nat = 0.05\nspeed_at_end = { below = 0.1 }\n");
    CHECK(run_program({"check", "scene.toml"}, folder.path()).exit_code == 2);
    const ProgramRun update = run_program({"check", "scene.toml", "--update"}, folder.path());
    CHECK(update.exit_code == 1);
    CHECK(update.out.find("  speed_at_end at 0.05 s 0.4905, expected < 0.1: failed\n") != std::string::npos);
    CHECK(update.out.find("  matches end.obj: written, 16 vertices\n") != std::string::npos);
    const ProgramRun again = run_program({"check", "scene.toml"}, folder.path());
    CHECK(again.exit_code == 1);
    CHECK(again.out.find("  matches end.obj 0, expected <= 1e-12: passed\n") != std::string::npos);
    const ProgramRun other = run_program({"check", "scene.toml", "--set", "step.time_step=0.005"}, folder.path());
    CHECK(other.out.find("  matches end.obj 0.002") != std::string::npos);
}

TEST_CASE("one failed expectation among many is exit code 1") {
    const TestFolder folder;
    folder.write("good.toml", falling_sheet() + "[expect]\nintersections = 0\n");
    folder.write("bad.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 0.05 }\nlowest_vertex = { above = 0.0 }\n");
    const ProgramRun run = run_program({"check", "good.toml", "bad.toml", "good.toml"}, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(ends_with(run.out, "3 of 3 scenes finished, 3 of 4 expectations passed\n"));
}

TEST_CASE("a wrong scene does not keep the others from running, but decides the exit code") {
    const TestFolder folder;
    folder.write("good.toml", falling_sheet() + "[expect]\nintersections = 0\n");
    folder.write("bad.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 0.05 }\n");
    const ProgramRun run = run_program({"check", "absent.toml", "bad.toml", "good.toml"}, folder.path());
    CHECK(run.exit_code == 2);
    CHECK(run.error.find("absent.toml") != std::string::npos);
    CHECK(run.out.find("absent.toml: did not run\n") != std::string::npos);
    CHECK(run.out.find("good.toml: finished: ") != std::string::npos);
    CHECK(ends_with(run.out, "2 of 3 scenes finished, 1 of 2 expectations passed\n"));
}

TEST_CASE("a scene without expectations is reported as such, and passes exactly if its run finishes") {
    const TestFolder folder;
    folder.write("free.toml", falling_sheet());
    const ProgramRun good = run_program({"check", "free.toml"}, folder.path());
    CHECK(good.exit_code == 0);
    CHECK(good.out.find("no expectations") != std::string::npos);
    CHECK(ends_with(good.out, "1 of 1 scenes finished, 0 of 0 expectations passed\n"));

    std::string dragged = sheet_on_box();
    dragged.insert(dragged.find("[[obstacle]]"), "pin = [0]\n");
    dragged += "\n[[event]]\ntime = 0.0\nmove = { cloth = \"sheet\", vertices = [0], to = [0.0, -0.2, 0.0], over = 0.1 }\n";
    folder.write("drag.toml", dragged);
    const ProgramRun bad = run_program({"check", "free.toml", "drag.toml"}, folder.path());
    CHECK(bad.exit_code == 1);
    CHECK(bad.out.find("drag.toml: failed: ") != std::string::npos);
    CHECK(bad.error.find("drag.toml: failed: ") != std::string::npos);
    CHECK(ends_with(bad.out, "1 of 2 scenes finished, 0 of 0 expectations passed\n"));
}

TEST_CASE("scenes that run side by side are printed in their order, with the same figures") {
    const TestFolder folder;
    std::vector<std::string> arguments = {"check", "--replay-hash"};
    for (int i = 0; i < 5; ++i) {
        const std::string name = "scene" + std::to_string(i) + ".toml";
        folder.write(name, sheet_on_box() + "[expect]\nintersections = 0\n");
        arguments.push_back(name);
    }
    const ProgramRun one = run_program(arguments, folder.path());
    arguments.insert(arguments.end(), {"--jobs", "3"});
    const ProgramRun three = run_program(arguments, folder.path());
    CHECK(one.exit_code == 0);
    CHECK(one.out == three.out);
    CHECK(one.out.find("state_hash ") != std::string::npos);
}

TEST_CASE("the option --set and --fps reach every scene") {
    const TestFolder folder;
    folder.write("a.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 0.2 }\n");
    folder.write("b.toml", folder.read("a.toml"));
    CHECK(run_program({"check", "a.toml", "b.toml"}, folder.path()).exit_code == 1);
    CHECK(run_program({"check", "a.toml", "b.toml", "--set", "duration=0.02", "--fps", "10"}, folder.path()).exit_code == 0);
}

TEST_CASE("the option --junit writes the same for machines") {
    const TestFolder folder;
    folder.write("bad.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 0.05 }\nintersections = 0\n");
    CHECK(run_program({"check", "bad.toml", "absent.toml", "--junit", "junit.xml", "--quiet"}, folder.path()).exit_code == 2);
    const std::string text = folder.read("junit.xml");
    CHECK(text.find("<testsuite name=\"bad.toml\" tests=\"3\" failures=\"1\" errors=\"0\"") != std::string::npos);
    CHECK(text.find("<testsuite name=\"absent.toml\" tests=\"1\" failures=\"0\" errors=\"1\"") != std::string::npos);
}

TEST_CASE("what check cannot do is refused") {
    const TestFolder folder;
    folder.write("a.toml", falling_sheet());
    CHECK(refused(run_program({"check", "a.toml", "--jobs", "0"}, folder.path()), "1 ... 256"));
    CHECK(refused(run_program({"check", "a.toml", "--frames", "obj"}, folder.path()), "check writes no frames"));
    CHECK(refused(run_program({"check", "a.toml", "--junit", "absent/junit.xml"}, folder.path()), "absent/junit.xml"));
    CHECK(run_program({"check", "a.toml", "--threads", "99"}, folder.path()).exit_code == 2);
    CHECK(run_program({"check", "a.toml", "--threads", "2"}, folder.path()).exit_code == 0);
    CHECK(run_program({"check", "a.toml", "--frames", "none"}, folder.path()).exit_code == 0);
}

TEST_CASE("with --certify-steps two more expectations are judged: no crossing and no depth after any step") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box() + "[expect]\nintersections = 0\n");
    const ProgramRun run = run_program({"check", "box.toml", "--certify-steps"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("intersections_at_every_step 0, expected = 0: passed") != std::string::npos);
    CHECK(run.out.find("deepest_penetration_at_every_step 0, expected = 0: passed") != std::string::npos);
    CHECK(ends_with(run.out, "1 of 1 scenes finished, 3 of 3 expectations passed\n"));
}

TEST_CASE("with --resume what has ended is kept, verdicts, hash and JUnit too, and only what is missing is run") {
    const TestFolder folder;
    folder.write("good.toml", sheet_on_box() + "[expect]\nintersections = 0\nsmallest_distance = { above = 0.001 }\n");
    folder.write("bad.toml",
                 falling_sheet() + "[expect]\nspeed_at_end = { below = 0.05 }\nsmallest_distance = { below = 1.0 }\n");
    const std::vector<std::string> two = {"check", "good.toml", "bad.toml", "--replay-hash", "--certify-steps"};
    const auto check = [&](std::vector<std::string> more) {
        more.insert(more.begin(), two.begin(), two.end());
        return run_program(more, folder.path());
    };
    const ProgramRun plain = check({});
    const ProgramRun first = check({"--resume", "kept", "--junit", "one.xml"});
    CHECK(first.exit_code == 1);
    CHECK(ends_with(first.out, "; 0 kept from earlier\n"));
    CHECK(results(first.out) + "\n" == plain.out);
    const ProgramRun second = check({"--resume", "kept", "--junit", "two.xml", "--jobs", "2"});
    CHECK(second.exit_code == 1);
    CHECK(second.error == first.error);
    CHECK(second.out.find("good.toml: kept: finished earlier: 12 steps, 0.2 s\n") != std::string::npos);
    CHECK(ends_with(second.out, "; 2 kept from earlier\n"));
    CHECK(results(second.out) == results(first.out));
    CHECK(folder.read("two.xml") == folder.read("one.xml"));
    std::filesystem::remove_all(folder.path("kept/bad"));
    const ProgramRun third = check({"--resume", "kept"});
    CHECK(third.out.find("bad.toml: finished: 10 steps") != std::string::npos);
    CHECK(ends_with(third.out, "; 1 kept from earlier\n"));
}

TEST_CASE("with --resume a scene is run again, and says why, where a file, a setting or an option has changed") {
    const TestFolder folder;
    const std::string mesh = "v 0 2 0\nv 0.3 2 0\nv 0 2 0.3\nv 0.3 2.05 0.3\nf 1 3 2\nf 2 3 4\n";
    std::string text = falling_sheet();
    text.replace(text.find("grid = "), text.find("\n", text.find("grid = ")) - text.find("grid = "), "mesh = \"sheet.obj\"");
    text.replace(text.find("shear = 0.5, "), 13, "");
    folder.write("sheet.obj", mesh);
    folder.write("a.toml", text);
    const auto check = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"check", "a.toml", "--resume", "kept"};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramRun run = run_program(words, folder.path());
        CHECK(run.exit_code == 0);
        return run.out.substr(0, run.out.find('\n'));
    };
    CHECK(check({}) == "a.toml: finished: 10 steps, 0.1 s");
    CHECK(check({"--threads", "2"}) == "a.toml: kept: finished earlier: 10 steps, 0.1 s");
    folder.write("sheet.obj", mesh + "# a comment\n");
    CHECK(check({}) == "a.toml: finished: 10 steps, 0.1 s; run again: sheet.obj has changed");
    CHECK(check({}) == "a.toml: kept: finished earlier: 10 steps, 0.1 s");
    CHECK(check({"--set", "duration=0.05"}) == "a.toml: finished: 5 steps, 0.05 s; run again: duration is 0.05, was 0.1");
    CHECK(check({"--set", "duration=0.05", "--certify-steps"}) ==
          "a.toml: finished: 5 steps, 0.05 s; run again: it was made without --certify-steps");
    folder.write("a.toml", text + "# a comment\n");
    CHECK(check({"--set", "duration=0.05", "--certify-steps"}) ==
          "a.toml: finished: 5 steps, 0.05 s; run again: a.toml has changed");
}

TEST_CASE("with --resume a scene is judged anew, and says why, where its expectations have changed") {
    const TestFolder folder;
    const std::string text = falling_sheet() + "[expect]\nspeed_at_end = { below = 2.0 }\n";
    folder.write("a.toml", text);
    const auto check = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"check", "a.toml", "--resume", "kept"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words, folder.path());
    };
    const std::string finished = "a.toml: finished: 10 steps, 0.1 s",
                      again = finished + "; run again: expectations have changed\n";
    CHECK(check({}).exit_code == 0);
    const ProgramRun stricter = check({"--set", "expect.speed_at_end={below=0.05}"});
    CHECK(stricter.exit_code == 1);
    CHECK(stricter.out.starts_with(again));
    CHECK(stricter.out.find("  speed_at_end 0.981, expected < 0.05: failed\n") != std::string::npos);
    const ProgramRun more = check({"--set", "expect.lowest_vertex={above=0.0}"});
    CHECK(more.exit_code == 0);
    CHECK(more.out.starts_with(again));
    CHECK(more.out.find("2 of 2 expectations passed") != std::string::npos);
    CHECK(check({"--set", "expect.lowest_vertex={above=0.0}"}).out.starts_with("a.toml: kept: finished earlier"));
    folder.write("a.toml", text + "lowest_vertex = { above = 0.0 }\n");
    CHECK(check({}).out.starts_with(finished + "; run again: a.toml has changed\n"));
}

TEST_CASE("a check that is killed goes on with --resume: what had ended is kept, the scene in its midst resumed, the rest run",
          "[slow]") {
    const TestFolder folder;
    const std::string expect = "[expect]\nspeed_at_end = { below = 10.0 }\n";
    folder.write("short.toml", falling_sheet() + expect);
    folder.write("long.toml", falling_sheet() + expect);
    folder.write("later.toml", falling_sheet() + expect);
    // The one in the middle is long enough to be interrupted.
    std::string text = folder.read("long.toml");
    text.replace(text.find("time_step = 0.01"), 16, "time_step = 5e-6");
    folder.write("long.toml", text);
    const std::vector<std::string> words = {"check", "short.toml", "long.toml", "later.toml", "--replay-hash"};
    std::vector<std::string> resumed = words;
    resumed.insert(resumed.end(), {"--resume", "kept"});
    for (const int signal : {SIGKILL, SIGTERM}) {
        CAPTURE(signal);
        std::filesystem::remove_all(folder.path("kept"));
        {
            StartedRun run(folder, resumed);
            run.wait_for(folder, "kept/long/checkpoint.percale");
            CHECK(run.end(signal) == (signal == SIGKILL ? -1 : 130));
        }
        CHECK(folder.holds("kept/short/report.json"));
        CHECK(folder.holds("kept/long/report.json") == (signal == SIGTERM));
        const ProgramRun again = run_program(resumed, folder.path());
        CHECK(again.exit_code == 0);
        CHECK(again.out.find("short.toml: kept: finished earlier: 10 steps") != std::string::npos);
        CHECK(again.out.find("long.toml: finished: 20000 steps, 0.1 s, resumed at 0.") != std::string::npos);
        CHECK(again.out.find("later.toml: finished: 10 steps, 0.1 s") != std::string::npos);
        CHECK(results(again.out) + "\n" == run_program(words, folder.path()).out);
        CHECK_FALSE(folder.holds("kept/long/checkpoint.percale"));
    }
}

TEST_CASE("what check --resume cannot keep is refused before anything is run") {
    const TestFolder folder;
    folder.write("a_b.toml", falling_sheet());
    std::filesystem::create_directories(folder.path("a"));
    folder.write("a/b.toml", falling_sheet());
    CHECK(refused(run_program({"check", "a_b.toml", "a/b.toml", "--resume", "kept"}, folder.path()),
                  "a_b.toml and a/b.toml would be kept in one folder, kept/a_b"));
    CHECK(refused(run_program({"check", "a_b.toml", "--resume", "a_b.toml"}, folder.path()), "a_b.toml"));
    CHECK(run_program({"check", "a_b.toml", "--resume", "kept", "--update"}, folder.path()).exit_code == 2);
    CHECK_FALSE(folder.holds("kept"));
    const ProgramRun wrong = run_program({"check", "absent.toml", "a_b.toml", "--resume", "kept"}, folder.path());
    CHECK(wrong.exit_code == 2);
    CHECK(wrong.out.find("absent.toml: did not run\n") != std::string::npos);
    CHECK(wrong.out.find("a_b.toml: finished") != std::string::npos);
    CHECK_FALSE(folder.holds("kept/absent"));
}

}  // namespace percale::program::test::check_test
