#include "scenes/drape/drape_scene.h"

#include <algorithm>
#include <fstream>

#include "scenes/meshes/obj_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::drape_scene_test {
namespace {

/// A sheet above a tall box, each point written as `own` says.
template <class Own>
DrapeOptions write_files(const TestFolder& folder, Own own) {
    TriangleMesh sheet = make_grid(0.4, 0.4, 5, 5), box = make_box(Vec3(0.3, 1.7, 0.2));
    for (Vec3& x : sheet.vertices) x = own(x + Vec3(0.1, 0.9, 0.2));
    for (Vec3& x : box.vertices) x = own(x);
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("box.obj"), box.vertices, box.triangles);
    DrapeOptions options;
    options.files = {folder.path("sheet.obj"), folder.path("box.obj")};
    options.outs = {folder.path("out.obj")};
    return options;
}

/// The line of the first finding of a kind; "" where there is none.
std::string find(const DrapeScene& made, const std::string& kind) {
    const auto found = std::ranges::find(made.findings, kind, &Finding::kind);
    return found == made.findings.end() ? "" : finding_line(*found);
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

}  // namespace

TEST_CASE("meshes in centimetres with z up make the scene that they make in metres with y up, and it is said") {
    const TestFolder folder;
    DrapeOptions options = write_files(folder, [](const Vec3& x) { return x; });
    options.move = {0.0, 0.1, 0.02};
    options.rotate = {0.0, 30.0, 0.0};
    const DrapeScene plain = drape_scene(options);
    CHECK(plain.findings.empty());
    CHECK_FALSE(plain.z_up);
    const BuiltScene built = build_scene(plain.scene);

    options = write_files(folder, [](const Vec3& x) { return Vec3(100.0 * Vec3(x.x(), -x.z(), x.y())); });
    options.move = {0.0, -0.02, 0.1};
    options.rotate = {0.0, 0.0, 30.0};
    const DrapeScene turned = drape_scene(options);
    CHECK(turned.z_up);
    REQUIRE(turned.findings.size() == 3);
    CHECK(turned.findings[0].kind == "guessed_up");
    CHECK(turned.findings[0].what.find("stands along z") != std::string::npos);
    CHECK(turned.findings[1].kind == "guessed_unit");
    CHECK(turned.findings[1].place == options.body());
    CHECK(turned.findings[1].what.find("170 units large, so its unit is taken as cm, which makes it 1.7 m (--body-unit m") !=
          std::string::npos);
    CHECK(turned.findings[2].kind == "guessed_unit");
    CHECK(turned.findings[2].place == options.files[0]);
    CHECK(turned.findings[2].what.find("40 units large and the body 1.7 m") != std::string::npos);
    for (const Finding& finding : turned.findings) CHECK(finding.severity == Severity::note);
    const BuiltScene again = build_scene(drape_scene(options).scene);
    CHECK(farthest(built.cloth_meshes[0].vertices, again.cloth_meshes[0].vertices) < 1e-6);
    std::vector<Vec3> box = again.obstacle_meshes[0].vertices;
    for (Vec3& x : box) x = transform(again.scene.obstacles[0].pose, x);
    CHECK(farthest(built.obstacle_meshes[0].vertices, box) < 1e-6);
}

TEST_CASE("what is said is not guessed, and garments grow by the scale") {
    const TestFolder folder;
    DrapeOptions options = write_files(folder, [](const Vec3& x) { return Vec3(x.x(), -x.z(), x.y()); });
    options.up = "y";
    options.scale = 1.5;
    options.garment_unit = options.body_unit = "m";
    const DrapeScene made = drape_scene(options);
    CHECK_FALSE(made.z_up);
    for (const Finding& finding : made.findings) CHECK_FALSE(finding.kind.starts_with("guessed_"));
    CHECK(made.scene.cloths[0].pose.scale == 1.5);
    CHECK(made.scene.cloths[0].pose.rotation.w == 1.0);
}

TEST_CASE("a garment that is closed and a body that is not were likely swapped") {
    const TestFolder folder;
    DrapeOptions options = write_files(folder, [](const Vec3& x) { return x; });
    CHECK(find(drape_scene(options), "swapped").empty());
    std::swap(options.files[0], options.files[1]);
    CHECK(find(drape_scene(options), "swapped").starts_with("warning: cloth 'box': it is a closed surface and obstacle "));
}

TEST_CASE("a garment of pieces that nothing joins is known, and said how to mend") {
    const TestFolder folder;
    const DrapeOptions options = write_files(folder, [](const Vec3& x) { return x; });
    CHECK_FALSE(drape_scene(options).comes_apart);
    const TriangleMesh open = both(free_sheet(), shifted(free_sheet(), {0.602, 0, 0}));
    write_obj(options.files[0], open.vertices, open.triangles);
    const DrapeScene made = drape_scene(options);
    CHECK(made.comes_apart);
    CHECK(find(made, "parts") ==
          "cloth 'sheet': it consists of 2 pieces that nothing joins; --garment-part takes one object or group of a file alone");
    const std::string rims = find(made, "near_rims");
    for (const char* part : {"warning: cloth 'sheet': 14 vertices of a rim", "; weld = ", "--weld of percale drape)"})
        CHECK(rims.find(part) != std::string::npos);
}

TEST_CASE("a mesh with stitches is sewn as a pattern is, without weight until it is, one without is not") {
    const TestFolder folder;
    DrapeOptions options = write_files(folder, [](const Vec3& x) { return x; });
    CHECK(drape_scene(options).scene.seams.empty());
    CHECK(drape_scene(options).scene.step.gravity != Vec3::Zero());
    std::ofstream(options.files[0], std::ios::app) << "stitch 0 4\nstitch 20 23 24 0.5\n";
    const DrapeScene made = drape_scene(options);
    REQUIRE(made.findings.size() == 1);
    CHECK(find(made, "stitches") == options.files[0] + " has 2 stitches, by which it is sewn");
    CHECK(made.scene.step.gravity == Vec3::Zero());
    const BuiltScene built = build_scene(made.scene);
    REQUIRE(built.seams.size() == 1);
    CHECK(built.seams[0].sewn.stitches == std::vector<Stitch>{{0, 4, 4, 0.0}, {20, 23, 24, 0.5}});
}

TEST_CASE("units are guessed so that things are 0.1 to some 10 m large") {
    CHECK(guessed_unit(1.8) == "m");
    CHECK(guessed_unit(180.0) == "cm");
    CHECK(guessed_unit(1800.0) == "mm");
    CHECK(guessed_unit(48.0, 1.75) == "cm");   // a skirt of 0.48 m
    CHECK(guessed_unit(480.0, 1.75) == "mm");  // not one of 4.8 m
    CHECK(guessed_unit(200.0, 1.75) == "cm");  // a robe
    CHECK(guessed_unit(20.0, 1.75) == "cm");   // a hat
    CHECK(guessed_unit(2.0, 0.1) == "m");      // a cloth over a cup
    CHECK(guessed_unit(60.0, 20.0) == "m");    // a tent
    CHECK(stands_along_z({0.5, 0.3, 1.8}));
    CHECK_FALSE(stands_along_z({0.5, 1.8, 0.3}));
    CHECK_FALSE(stands_along_z({1.0, 1.0, 1.0}));
    CHECK_FALSE(stands_along_z({1.2, 0.01, 1.2}));  // a sheet that lies
}

TEST_CASE("what doctor warns of is noted, and options that are wrong are refused") {
    const TestFolder folder;
    DrapeOptions options = write_files(folder, [](const Vec3& x) { return x; });
    options.fabric.thickness = 0.5;
    const DrapeScene made = drape_scene(options);
    REQUIRE_FALSE(made.findings.empty());
    CHECK(made.findings[0].kind == "thick_for_edges");
    CHECK(finding_line(made.findings[0]).starts_with("warning: cloth 'sheet': thickness 0.5 m is "));
    CHECK(made.findings[0].fix.empty());  // it is about the fabric, and the program has an option for it

    const auto refusal = [&](auto change) {
        DrapeOptions wrong = options;
        change(wrong);
        return message_of([&] { check_drape(wrong); });
    };
    CHECK(refusal([](DrapeOptions&) {}).empty());
    CHECK(refusal([](DrapeOptions& o) { o.up = "x"; }) == "--up x: must be y or z");
    CHECK(refusal([](DrapeOptions& o) { o.scale = 0.0; }).find("--scale: ") == 0);
    CHECK(refusal([](DrapeOptions& o) { o.body_unit = "foot"; }) == "--body-unit foot: must be mm, cm, dm, m or inch");
    CHECK(refusal([](DrapeOptions& o) { o.outs.clear(); }).find("it takes one for each garment") != std::string::npos);
}

TEST_CASE("garment and body may be objects of one file") {
    const TestFolder folder;
    DrapeOptions options;
    options.files.assign(2, folder.write("all.obj",
                                         "o sheet\nv 0 1 0\nv 0.5 1 0\nv 0 1 0.5\nf 1 3 2\no stand\nv 0 0 0\nv 0.5 0 0\n"
                                         "v 0 0 0.5\nv 0 -0.5 0\nf 4 6 5\nf 4 5 7\nf 4 7 6\nf 5 6 7\n"));
    options.outs = {folder.path("out.obj")};
    options.garment_part = "sheet";
    options.body_part = "stand";
    const BuiltScene built = build_scene(drape_scene(options).scene);
    CHECK(built.cloth_meshes[0].triangles.size() == 1);
    CHECK(built.obstacle_meshes[0].triangles.size() == 4);
    // The unit is the file's, whatever the size of the part.
    options.files.assign(2, folder.write("cm.obj",
                                         "o pin\nv 0 50 0\nv 5 50 0\nv 0 50 5\nf 1 3 2\no stand\nv 0 0 0\n"
                                         "v 170 0 0\nv 0 0 50\nv 0 -50 0\nf 4 6 5\nf 4 5 7\nf 4 7 6\nf 5 6 7\n"));
    options.garment_part = "pin";
    CHECK(drape_scene(options).scene.cloths[0].unit == 0.01);
    CHECK(drape_scene(options).scene.obstacles[0].unit == 0.01);
    options.body_part = "stands";
    CHECK(message_of([&] { build_scene(drape_scene(options).scene); }).find("did you mean 'stand'?") != std::string::npos);
}

}  // namespace percale::scenes::test::drape_scene_test
