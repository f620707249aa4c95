#include <algorithm>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::compare_test {
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

ProgramRun compare(const TestFolder& folder, std::vector<std::string> more) {
    folder.write("sheet.toml", falling_sheet());
    more.insert(more.begin(), {"compare", "sheet.toml"});
    return run_program(more, folder.path());
}

}  // namespace

TEST_CASE("compare prints reference, table and advice and writes table and diagram into a folder of the scene's name") {
    const TestFolder folder;
    const ProgramRun run = compare(folder, {"--schemes", "rk4,backward_euler", "--steps", "1/100,0.005", "--repeats", "1"});
    CHECK(run.exit_code == 0);
    CHECK(run.error.empty());
    CHECK(run.out.find("reference: rk4 at ") == 0);
    CHECK(run.out.find("backward_euler  1/100 s") != std::string::npos);
    CHECK(run.out.find("for an error of 1e-1 m") != std::string::npos);
    CHECK(line_count(folder.read("sheet/compare.csv")) == 6);
    CHECK(folder.read("sheet/compare.svg").find("</svg>") != std::string::npos);
    CHECK(folder.file_count() == 3);
}

TEST_CASE("compare takes overrides, threads and a folder, and is quiet where asked") {
    const TestFolder folder;
    const ProgramRun run = compare(folder, {"--schemes", "rk4", "--steps", "0.01", "--set", "duration=0.02", "--threads", "2",
                                            "--quiet", "-o", "out/deep", "--repeats", "1"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.empty());
    CHECK(run.error.empty());
    CHECK(folder.read("out/deep/compare.csv").find("rk4,0.01,,finished,2,") != std::string::npos);
}

TEST_CASE("compare refuses words and numbers that mean nothing, names the nearest, and leaves nothing") {
    const TestFolder folder;
    CHECK(refused(compare(folder, {"--schemes", "rk4,backwards_euler"}), "did you mean 'backward_euler'?"));
    CHECK(refused(compare(folder, {"--steps", "1/60,fast"}), "--steps fast: must be numbers such as 0.004 or 1/240"));
    CHECK(refused(compare(folder, {"--steps", "2.0"}), "1e-7 ... 1"));
    CHECK(refused(compare(folder, {"--steps", "1/0"}), "--steps"));
    CHECK(refused(compare(folder, {"--schemes", "rk4,rk4"}), "--schemes rk4: given twice"));
    CHECK(refused(compare(folder, {"--steps", "1/60,0.01,1/60"}), "--steps 1/60: given twice"));
    CHECK(refused(compare(folder, {"--repeats", "0"}), "1 ... 1000"));
    CHECK(refused(compare(folder, {"--reference-error", "0"}), "1e-14 ... 1 m"));
    CHECK(refused(compare(folder, {"--set", "duratoin=1"}), "duration"));
    CHECK(refused(run_program({"compare", "none.toml"}, folder.path()), "none.toml"));
    CHECK(folder.file_count() == 1);
    CHECK_FALSE(folder.holds("sheet"));
}

TEST_CASE("compare with nothing that finished is a failure, reported in its rows") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    const ProgramRun run =
        run_program({"compare", "box.toml", "--schemes", "rk4", "--steps", "1/60", "--reference-error", "1", "--repeats", "1"},
                    folder.path());
    CHECK(run.exit_code == 1);
    CHECK(folder.read("box/compare.csv").find("rk4,0.016666666666666666,,refused,") != std::string::npos);
}

TEST_CASE("compare that cannot write its diagram says so before it runs anything, and leaves no table either") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("sheet/compare.svg"));
    const ProgramRun run = compare(folder, {"--schemes", "rk4", "--steps", "1e-7", "--set", "duration=1000"});
    CHECK(refused(run, "sheet/compare.svg: "));
    CHECK(folder.file_count() == 1);
}

TEST_CASE("compare compares a scene with an obstacle, explicit schemes refused in their rows") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    const ProgramRun run = run_program({"compare", "box.toml", "--schemes", "rk4,backward_euler", "--steps", "1/60", "--repeats",
                                        "1", "--reference-error", "0.1"},
                                       folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("refused: ") != std::string::npos);
    CHECK(run.out.find("finished") != std::string::npos);
}

}  // namespace percale::program::test::compare_test
