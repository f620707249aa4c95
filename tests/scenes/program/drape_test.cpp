#include <algorithm>
#include <fstream>

#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "percale/mesh.h"
#include "tests/scenes/drape/open_seam.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/scenes/program/run_program.h"
#include "tests/support/catch.h"

namespace percale::program::test::drape_test {
namespace {

/// A small sheet 2 cm above a block that it overhangs on all sides, in units of 1/scale metres.
void write_pair(const TestFolder& folder, double scale) {
    TriangleMesh sheet = make_grid(0.2, 0.2, 9, 9), block = make_box(Vec3(0.1, 0.2, 0.1));
    for (Vec3& x : sheet.vertices) x = (x + Vec3(0.0, 0.12, 0.0)) * scale;
    for (Vec3& x : block.vertices) x *= scale;
    scenes::write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    scenes::write_obj(folder.path("block.obj"), block.vertices, block.triangles);
}

TriangleMesh read(const TestFolder& folder, const std::string& name) {
    std::ifstream in(folder.path(name));
    return scenes::read_obj(in, name);
}

/// The sheet, moved, as another file.
void write_moved_sheet(const TestFolder& folder, const std::string& name, const Vec3& by) {
    TriangleMesh moved = read(folder, "sheet.obj");
    for (Vec3& x : moved.vertices) x += by;
    scenes::write_obj(folder.path(name), moved.vertices, moved.triangles);
}

}  // namespace

TEST_CASE("a garment that settles is written at rest and clean") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const ProgramRun run =
        run_program({"drape", "sheet.obj", "block.obj", "-o", "draped.obj", "--friction", "0.8"}, folder.path());
    CAPTURE(run.out, run.error);
    CHECK(run.exit_code == 0);
    const TriangleMesh draped = read(folder, "draped.obj"), sheet = read(folder, "sheet.obj");
    CHECK(draped.triangles == sheet.triangles);
    CHECK(certify(draped, read(folder, "block.obj")).clean());
    CHECK(draped.vertices[0].y() < sheet.vertices[0].y() - 0.02);
    CHECK(folder.file_count() == 3);
}

TEST_CASE("a garment is draped until it is proven at rest, asked or not") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const auto draped = [&](const std::string& out, std::vector<std::string> more) {
        std::vector<std::string> arguments = {"drape", "sheet.obj", "block.obj", "-o", out, "--friction", "0.8"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramRun run = run_program(arguments, folder.path());
        CHECK(run.exit_code == 0);
        CHECK(run.out.find(out + ": at rest, ") != std::string::npos);
        return read(folder, out).vertices;
    };
    CHECK(draped("a.obj", {}) == draped("b.obj", {"--until-rest"}));
}

TEST_CASE("a pattern is sewn around the body first, and then hangs on it", "[slow]") {
    const TestFolder folder;
    const std::string data = PERCALE_DATA_DIR;
    const auto drape = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"drape", data + "/patterns/t_shirt.toml", data + "/meshes/mannequin.obj", "-o",
                                              "draped.obj"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments, folder.path());
    };
    const ProgramRun run = drape({"--fabric", "cotton", "--edge-length", "0.05", "--seconds", "30"});
    CAPTURE(run.out, run.error);
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("draped.obj: at rest, ") != std::string::npos);
    CHECK(run.out.find(" stitches, largest gap ") != std::string::npos);
    const TriangleMesh shirt = read(folder, "draped.obj");
    double lowest = 2.0;
    for (const Vec3& x : shirt.vertices) lowest = std::min(lowest, x.y());
    CHECK(lowest > 0.8);
    CHECK(lowest < 1.0);
    CHECK(refused(drape({"--garment-unit", "cm"}), "a pattern says its own unit"));
    CHECK(refused(drape({"--seconds", "1"}), "--seconds 1: sewing alone takes 1 s"));
}

TEST_CASE("a seam that the body keeps open is named, with its gap and its place") {
    const TestFolder folder;
    scenes::test::write_open_seam(folder, "left side");
    const ProgramRun run = run_program({"drape", "strips.toml", "plate.obj", "-o", "out.obj", "--seconds", "2.2"}, folder.path());
    CAPTURE(run.out, run.error);
    CHECK(run.exit_code == 1);
    CHECK(run.error.find("not sewn: seam 'left side' of '") != std::string::npos);
    // Other sewing times are tried first.
    CHECK(run.out.find("strips.toml: sewn in 1 s: not sewn: seam 'left side'") != std::string::npos);
    CHECK(run.out.find("strips.toml: sewn in 2 s: ") == std::string::npos);  // its end is in 3 s
    CHECK(folder.holds("out.obj"));
}

TEST_CASE("when the time is up the garment is written all the same, and the speed named") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const ProgramRun run =
        run_program({"drape", "sheet.obj", "block.obj", "-o", "draped.obj", "--seconds", "0.05"}, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(run.error.find("m/s") != std::string::npos);
    CHECK(run.error.find("; draped.obj holds how it was then") != std::string::npos);
    CHECK(folder.holds("draped.obj"));
}

TEST_CASE("for a garment that is not on the body at the end the advice is to move it") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const ProgramRun run = run_program(
        {"drape", "sheet.obj", "block.obj", "-o", "draped.obj", "--seconds", "0.2", "--move", "2,0,0"}, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(run.error.find("percale: draped.obj: never met the body; use --move") == 0);
    CHECK(folder.holds("draped.obj"));
    const ProgramRun slid = run_program(
        {"drape", "sheet.obj", "block.obj", "-o", "slid.obj", "--seconds", "1.5", "--move", "0.13", "0", "0"}, folder.path());
    CHECK(slid.exit_code == 1);
    CHECK(slid.error.find("percale: slid.obj: fell off the body; use --move") == 0);
}

TEST_CASE("the advice for a garment whose pieces are not joined and fall is to mend it, and swapped files are reported once") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    using namespace scenes::test;
    const TriangleMesh open = both(free_sheet(), shifted(free_sheet(), {0.602, 0, 0}));
    scenes::write_obj(folder.path("open.obj"), open.vertices, open.triangles);
    const ProgramRun apart =
        run_program({"drape", "open.obj", "block.obj", "-o", "draped.obj", "--seconds", "0.2", "--move", "3,0,0"}, folder.path());
    CHECK(apart.exit_code == 1);
    CHECK(apart.error.find("never met the body; rims of it are joined by nothing where they meet, merge their vertices") !=
          std::string::npos);
    const ProgramRun swapped =
        run_program({"drape", "block.obj", "sheet.obj", "-o", "draped.obj", "--seconds", "0.01"}, folder.path());
    const std::size_t first = swapped.out.find("were their meshes swapped?");
    CHECK(first != std::string::npos);
    CHECK(swapped.out.find("were their meshes swapped?", first + 1) == std::string::npos);
}

TEST_CASE("numbers with decimal commas or units are refused, and what to write is said") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"drape", "sheet.obj", "block.obj", "-o", "draped.obj"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments, folder.path());
    };
    CHECK(refused(with({"--move", "0", "1,5", "0"}), "'1,5' is no number; decimals take a point: 1.5"));
    CHECK(refused(with({"--rotate", "0", "0", "1,5"}), "'1,5' is no number; decimals take a point: 1.5"));
    CHECK(refused(with({"--thickness", "5mm"}), "--thickness = 5mm; a number is written without its unit, in m: 0.005 (see"));
    CHECK(refused(with({"--thickness", "0,005"}), "--thickness = 0,005; decimals take a point: 0.005"));
    CHECK_FALSE(folder.holds("draped.obj"));
}

TEST_CASE("files in millimetres drape as the same files in metres do") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    CHECK(run_program({"drape", "sheet.obj", "block.obj", "-o", "metres.obj", "--seconds", "0.1"}, folder.path()).exit_code == 1);
    write_pair(folder, 1000.0);
    CHECK(run_program({"drape", "sheet.obj", "block.obj", "-o", "millimetres.obj", "--seconds", "0.1", "--garment-unit", "mm",
                       "--body-unit", "mm"},
                      folder.path())
              .exit_code == 1);
    const TriangleMesh a = read(folder, "metres.obj"), b = read(folder, "millimetres.obj");
    REQUIRE(a.vertices.size() == b.vertices.size());
    for (std::size_t i = 0; i < a.vertices.size(); ++i) CHECK((a.vertices[i] - b.vertices[i]).norm() < 1e-6);
}

TEST_CASE("what cannot be draped is refused before anything is written") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const auto draped = [&](std::vector<std::string> options) {
        std::vector<std::string> arguments = {"drape", "sheet.obj", "block.obj", "-o", "out.obj"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_program(arguments, folder.path());
    };
    CHECK(refused(draped({"--seconds", "0"}), "--seconds"));
    CHECK(refused(draped({"--thickness", "-1"}), "thickness"));
    CHECK(refused(draped({"--friction", "-1"}), "friction"));
    CHECK(refused(draped({"--body-unit", "foot"}), "mm, cm, dm, m or inch"));
    CHECK(refused(run_program({"drape", "sheet.obj", "absent.obj", "-o", "out.obj"}, folder.path()),
                  "percale: absent.obj: 'body': no such file\n"));
    CHECK(refused(run_program({"drape", "sheet.obj", "block.obj", "-o", "out.ply"}, folder.path()),
                  "percale: -o out.ply: its name must end in .obj"));
    CHECK(refused(run_program({"drape", "sheet.obj", "block.obj", "-o", "absent/out.obj"}, folder.path()), "absent/out.obj"));
    CHECK(folder.file_count() == 2);
}

TEST_CASE("a garment that overlaps the body is moved out first, which is said") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    const ProgramRun run = run_program(
        {"drape", "block.obj", "block.obj", "-o", "out.obj", "--move", "0", "0.1", "0", "--seconds", "0.05"}, folder.path());
    CHECK(run.exit_code == 1);  // not at rest so soon
    CHECK(run.out.find("vertices of block moved out of body before the start, the farthest by ") != std::string::npos);
    CHECK(run.out.find(" 0 intersecting pairs") != std::string::npos);
}

TEST_CASE("a garment that is moved first falls as one that was there from the start") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    write_moved_sheet(folder, "moved.obj", {0.25, 0.5, 0.125});
    const std::vector<std::string> rest = {"block.obj", "--seconds", "0.1", "-o"};
    const auto draped = [&](std::vector<std::string> first, const std::string& out) {
        first.insert(first.begin(), "drape");
        first.insert(first.end(), rest.begin(), rest.end());
        first.push_back(out);
        CHECK(run_program(first, folder.path()).exit_code == 1);
        return read(folder, out).vertices;
    };
    CHECK(draped({"--move", "0.25", "0.5", "0.125", "sheet.obj"}, "a.obj") == draped({"moved.obj"}, "b.obj"));
}

TEST_CASE("a garment that crosses itself is untangled first, and without self-contact it is reported how often it does") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    // A second layer, tilted: at one side it is 3 mm below the first.
    TriangleMesh layers = read(folder, "sheet.obj");
    const std::size_t lower = layers.vertices.size(), triangles = layers.triangles.size();
    for (std::size_t v = 0; v < lower; ++v) {
        const Vec3 x = layers.vertices[v];
        layers.vertices.push_back(x + Vec3(0.003, 0.1 * (x.x() + 0.07), 0.004));
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        Triangle upper = layers.triangles[t];
        for (int& v : upper) v += static_cast<int>(lower);
        layers.triangles.push_back(upper);
    }
    scenes::write_obj(folder.path("layers.obj"), layers.vertices, layers.triangles);
    const std::vector<std::string> arguments = {"drape", "layers.obj", "block.obj", "--seconds", "0.05", "-o", "out.obj"};
    const ProgramRun with = run_program(arguments, folder.path());
    CAPTURE(with.out, with.error);
    CHECK(with.out.find("vertices of layers moved out of cloth that they crossed before the start") != std::string::npos);
    CHECK(with.out.find(" 0 intersecting pairs") != std::string::npos);
    CHECK(self_intersections(read(folder, "out.obj")).empty());
    std::vector<std::string> off = arguments;
    off.emplace_back("--no-self-contact");
    const ProgramRun without = run_program(off, folder.path());
    CAPTURE(without.out, without.error);
    CHECK(without.out.find("without self-contact: cloth crosses cloth in ") != std::string::npos);
    CHECK(without.out.find(" 0 intersecting pairs") != std::string::npos);
}

TEST_CASE("garments are draped over each other from the inside out, each into its own file") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    write_moved_sheet(folder, "upper.obj", {0.004, 0.02, 0.003});
    const ProgramRun run = run_program(
        {"drape", "sheet.obj", "upper.obj", "block.obj", "-o", "a.obj", "-o", "b.obj", "--friction", "0.8", "--seconds", "2"},
        folder.path());
    CAPTURE(run.out, run.error);
    CHECK(run.out.find("sheet.obj, upper.obj onto block.obj") != std::string::npos);
    CHECK(run.out.find(" 0 intersecting pairs") != std::string::npos);
    const TriangleMesh a = read(folder, "a.obj"), b = read(folder, "b.obj"), block = read(folder, "block.obj");
    for (const TriangleMesh& cloth : {a, b}) CHECK(certify(cloth, block).clean());
    CHECK(certify(a, b).pairs.empty());
    // In the middle, over the block's top, one lies on the other.
    CHECK(b.vertices[40].y() > a.vertices[40].y() + 0.0025);
    CHECK(b.vertices[40].y() < a.vertices[40].y() + 0.02);

    const auto refusal = [&](std::vector<std::string> outs) {
        std::vector<std::string> arguments = {"drape", "sheet.obj", "upper.obj", "block.obj"};
        arguments.insert(arguments.end(), outs.begin(), outs.end());
        const ProgramRun refused_run = run_program(arguments, folder.path());
        CHECK(refused_run.exit_code == 2);
        return refused_run.error;
    };
    CHECK(refusal({"-o", "c.obj"}).find("it takes one for each garment") != std::string::npos);
    CHECK(refusal({"-o", "c.obj", "-o", "c.obj"}).find("is said twice") != std::string::npos);
    CHECK(refusal({"-o", "c.obj", "-o", "./block.obj"}).find("would overwrite block.obj") != std::string::npos);
    CHECK(folder.file_count() == 5);
}

TEST_CASE("a pattern without a seam gets its weight, too") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    folder.write("cloth.toml",
                 "unit = \"cm\"\n[[panel]]\nname = \"cloth\"\npoints = [[-10, -10], [10, -10], [10, 10], [-10, 10]]\n"
                 "at = [0, 14, 0]\nturn = [-90, 0, 0]\n");
    const ProgramRun run = run_program(
        {"drape", "cloth.toml", "block.obj", "-o", "out.obj", "--fabric", "cotton", "--friction", "0.8", "--seconds", "2.9"},
        folder.path());
    CAPTURE(run.out, run.error);
    double lowest = 1.0;
    for (const Vec3& x : read(folder, "out.obj").vertices) lowest = std::min(lowest, x.y());
    CHECK(lowest < 0.09);
}

TEST_CASE("what is wrong within a pattern is reported with its place, and the file once") {
    const TestFolder folder;
    write_pair(folder, 1.0);
    folder.write("cloth.toml",
                 "unit = \"cm\"\n[[panel]]\nname = \"cloth\"\npoints = [[-10, -10], [10, -10], [10, 10], [-10, 10]]\n"
                 "[[seam]]\nname = \"side\"\nsides = [[\"cloth.1\"], [\"cloth.9\"]]\n");
    const ProgramRun run = run_program({"drape", "cloth.toml", "block.obj", "-o", "out.obj"}, folder.path());
    CAPTURE(run.out, run.error);
    CHECK(run.exit_code == 2);
    CHECK(run.error.starts_with("percale: cloth.toml:7:24: panel"));
    CHECK(run.error.find("cloth.toml", 20) == std::string::npos);
    CHECK(line_count(run.error) == 1);
}

}  // namespace percale::program::test::drape_test
