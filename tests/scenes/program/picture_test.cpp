#include "meshes/obj_file.h"
#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"
#include "tests/scenes/program/run_program.h"

namespace percale::program::test::picture_test {
using percale::scenes::test::draws;
using percale::scenes::test::PngPixels;
using percale::scenes::test::read_png;

namespace {

/// A sheet that falls on a ball, 0.2 s: frames 0 ... 6.
void run_sheet(const TestFolder& folder, const std::string& frames = "obj", const std::string& fields = "[]") {
    folder.write(
        "sheet.toml",
        "duration = 0.2\n[fabric.f]\narea_density = 0.2\nthickness = 0.01\nsprings = { structural = 500.0, shear = 100.0 }\n"
        "[[cloth]]\nname = \"sheet\"\nfabric = \"f\"\ngrid = { size = [0.6, 0.6], vertices = [7, 7] }\n"
        "pose = { translation = [0.0, 0.25, 0.0] }\n"
        "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.2 } }\n"
        "[output]\nfps = 30.0\nfields = " +
            fields + "\n");
    const ProgramRun run = run_program({"run", "sheet.toml", "-o", "out", "--frames", frames, "--quiet"}, folder.path());
    CAPTURE(run.error);
    REQUIRE(run.exit_code == 0);
}

ProgramRun picture(const TestFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "picture");
    return run_program(arguments, folder.path());
}

const std::vector<std::string> small = {"out", "-o", "out.png", "--size", "96x72"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

}  // namespace

TEST_CASE("a run is drawn into a PNG of the size asked for, by either name of the command, the same at any number of threads") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder);
    const ProgramRun drawn = picture(folder, small);
    CAPTURE(drawn.error);
    CHECK(drawn.exit_code == 0);
    CHECK(drawn.out == "out.png: 96x72 pixels\n");
    const std::string bytes = folder.read("out.png");
    const PngPixels png = read_png(bytes);
    CHECK((png.width == 96 && png.height == 72 && png.channels == 3));
    CHECK(run_program({"render", "out", "-o", "again.png", "--size", "96x72", "--threads", "3", "--quiet"}, folder.path())
              .out.empty());
    CHECK(folder.read("again.png") == bytes);
    CHECK(picture(folder, with(small, {"--frame", "6"})).exit_code == 0);
    CHECK(folder.read("out.png") == bytes);
}

TEST_CASE("views, frames, backgrounds and hidden bodies make different pictures") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder);
    std::vector<std::string> seen;
    const std::vector<std::vector<std::string>> looks = {
        {},
        {"--frame", "0"},
        {"--time", "0.1"},
        {"--view", "top"},
        {"--azimuth", "90", "--elevation", "30"},
        {"--zoom", "2"},
        {"--target", "0.1,0.2,0"},
        {"--hide", "ball"},
        {"--colour", "sheet=00ff00"},
        {"--background", "white"},
        {"--background", "transparent"},
        {"--no-ground"},
        {"--wire"},
        {"--field", "distance"},
        {"--field", "distance", "--range", "0", "500"},
        {"--sheet", "2x1"},
        {"--frames", "0,3,6"},
    };
    for (const std::vector<std::string>& look : looks) {
        const ProgramRun drawn = picture(folder, with(small, look));
        CAPTURE(look, drawn.error);
        REQUIRE(drawn.exit_code == 0);
        seen.push_back(folder.read("out.png"));
        for (std::size_t k = 0; k + 1 < seen.size(); ++k) CHECK(seen[k] != seen.back());
    }
    CHECK(picture(folder, with(small, {"--frame", "3"})).exit_code == 0);
    const std::string third = folder.read("out.png");
    CHECK(picture(folder, with(small, {"--time", "0.1"})).exit_code == 0);
    CHECK(folder.read("out.png") == third);
}

TEST_CASE("fields of frames are drawn where a run has them, with the range reported, else how to get them is said") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder, "obj,ply", "[\"strain\", \"pressure\"]");
    for (const char* field : {"strain", "strain_warp", "strain_weft", "strain_shear", "pressure", "distance"}) {
        const ProgramRun drawn = picture(folder, with(small, {"--field", field}));
        CAPTURE(drawn.error);
        CHECK(drawn.exit_code == 0);
        CHECK(drawn.out.rfind(std::string(field) + ": ", 0) == 0);
    }
    const TestFolder plain;
    run_sheet(plain);
    CHECK(refused(picture(plain, with(small, {"--field", "strain"})),
                  "has no strain; run the scene with output.fields = [\"strain\"]"));
    CHECK(refused(picture(plain, with(small, {"--field", "presure"})), "did you mean 'pressure'"));
    CHECK_FALSE(plain.holds("out.png"));
}

TEST_CASE("several runs are a sheet, meshes a picture, and a movie a folder of pictures") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder);
    CHECK(picture(folder, {"out", "./out/", "-o", "two.png", "--size", "120x60"}).exit_code == 0);
    const PngPixels two = read_png(folder.read("two.png"));
    // Both halves show the same run.
    for (int row = 0; row < 40; ++row)
        for (int column = 0; column < 59; ++column) CHECK_FALSE(two.at(column, row)[0] != two.at(column + 60, row)[0]);
    const TriangleMesh ball = make_sphere(0.3, 2);
    scenes::write_obj(folder.path("body.obj"), ball.vertices, ball.triangles);
    CHECK(picture(folder, {"body.obj", "out/frames/sheet_00000.obj", "-o", "meshes.png", "--size", "64x64"}).exit_code == 0);
    CHECK(picture(folder, {"out", "--movie", "film", "--size", "48x48"}).out == "film: 7 pictures\n");
    CHECK(
        (folder.holds("film/frame_00000.png") && folder.holds("film/frame_00006.png") && !folder.holds("film/frame_00007.png")));
    CHECK(picture(folder, {"out", "--movie", "short", "--frames", "2,4", "--size", "48x48"}).out == "short: 2 pictures\n");
}

TEST_CASE("what cannot be drawn is exit code 2 with one message, and nothing is left behind") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder);
    const int files = folder.file_count();
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{"--frame", "7"}, "--frame 7: 'out' has 7 frames, 0 ... 6"},
        {{"--frame", "-1"}, "has 7 frames"},
        {{"--frame", "1.5"}, "'1.5' is not a whole number"},
        {{"--frames", "0,9"}, "--frames 9: "},
        {{"--frames", "0,,2"}, "'' is not a whole number"},
        {{"--time", "0.3"}, "has frames from 0 to 0.2"},
        {{"--frame", "1", "--time", "0.1"}, "exclude each other"},
        {{"--frame", "1", "--frames", "0,1"}, "exclude each other"},
        {{"--sheet", "3x3"}, "has 7 frames only"},
        {{"--sheet", "3"}, "--sheet 3: must be two whole numbers"},
        {{"--sheet", "1x1", "--frames", "0,1"}, "2 frames do not fit a sheet of 1x1"},
        {{"--view", "botom"}, "no view 'botom'"},
        {{"--elevation", "91"}, "elevation is 91 degrees"},
        {{"--zoom", "0"}, "zoom is 0, must be above 0"},
        {{"--target", "1,2"}, "--target 1,2: must be three numbers"},
        {{"--target", "1,2,x"}, "x: is not a finite number"},
        {{"--hide", "bal"}, "did you mean 'ball'"},
        {{"--colour", "sheet"}, "must be NAME=RRGGBB"},
        {{"--colour", "sheet=red"}, "six hexadecimal digits"},
        {{"--background", "black"}, "no background 'black'"},
        {{"--range", "0", "1"}, "name it by --field"},
        {{"--field", "distance", "--range", "1", "1"}, "the lower one first"},
        {{"--movie", "film"}, "-o and --movie exclude each other"},
        {{"--threads", "65"}, "64"},
    };
    for (const auto& [more, part] : wrong) {
        const ProgramRun run = picture(folder, with(small, more));
        CAPTURE(more, run.error);
        CHECK(refused(run, part));
    }
    CHECK(refused(picture(folder, {"out", "-o", "out.png", "--size", "9x9"}), "16 ... 8192"));
    CHECK(refused(picture(folder, {"out", "-o", "out.png", "--size", "big"}), "'big' is not a whole number"));
    CHECK(refused(picture(folder, {"out"}), "-o OUT.png or --movie DIR must be given"));
    CHECK(refused(picture(folder, {"out", "-o", "out.jpg"}), "must end in .png"));
    CHECK(refused(picture(folder, {"absent", "-o", "out.png"}), "absent: no such file"));
    CHECK(refused(picture(folder, {"out", "sheet.toml", "-o", "out.png"}), "sheet.toml: is not the folder of a run"));
    CHECK(refused(picture(folder, {"out", "-o", "none/out.png", "--size", "48x48"}), "none/out.png: cannot be written"));
    CHECK(folder.file_count() == files);
}

TEST_CASE("frames in formats that cannot be drawn are refused with what to write instead") {
    if (!draws()) return;
    const TestFolder folder;
    run_sheet(folder, "glb");
    CHECK(refused(picture(folder, small), "write obj or ply too, as by --frames obj,glb"));
    run_sheet(folder, "none");
    CHECK(refused(picture(folder, small), "wrote no frames"));
}

TEST_CASE("a build without Embree says that it has no pictures") {
    if (scenes::pictures_missing().empty()) return;
    const TestFolder folder;
    CHECK(refused(picture(folder, small), "this build has no pictures: libembree-dev or libstb-dev was not found"));
}

}  // namespace percale::program::test::picture_test
