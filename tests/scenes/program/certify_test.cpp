#include <nlohmann/json.hpp>

#include "meshes/obj_file.h"
#include "percale/mesh.h"
#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::certify_test {
using percale::scenes::test::falling_sheet;
using percale::scenes::test::sheet_on_box;

namespace {

/// A 0.2 m sheet at a height, as a file; the box below it is 1 m wide and ends at height 0.
void write_sheet(const TestFolder& folder, const std::string& name, double height) {
    TriangleMesh sheet = make_grid(0.2, 0.2, 3, 3);
    for (Vec3& x : sheet.vertices) x.y() += height;
    scenes::write_obj(folder.path(name), sheet.vertices, sheet.triangles);
}

void write_box(const TestFolder& folder) {
    TriangleMesh box = make_box(Vec3(1.0, 1.0, 1.0));
    for (Vec3& x : box.vertices) x.y() -= 0.5;
    scenes::write_obj(folder.path("box.obj"), box.vertices, box.triangles);
}

/// The same sheet turned upright: half of it is in the box.
void write_crossing_sheet(const TestFolder& folder) {
    TriangleMesh sheet = make_grid(0.2, 0.2, 3, 3);
    for (Vec3& x : sheet.vertices) x = Vec3(x.x(), x.z() - 0.013, 0.03);
    scenes::write_obj(folder.path("crossing.obj"), sheet.vertices, sheet.triangles);
}

}  // namespace

TEST_CASE("a sheet above a box is clean, with its distance") {
    const TestFolder folder;
    write_box(folder);
    write_sheet(folder, "sheet.obj", 0.015625);
    const ProgramRun run = run_program({"certify", "box.obj", "sheet.obj", "--json"}, folder.path());
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(run.out);
    CHECK(json.at("clean") == true);
    CHECK(json.at("has_obstacles") == true);
    CHECK(json.at("intersections") == 0);
    CHECK(json.at("smallest_distance").get<double>() == Approx(0.015625));
    CHECK(json.at("worst_frame") == 0);
}

TEST_CASE("a sheet through a box is exit code 1, with pairs, vertices and depth") {
    const TestFolder folder;
    write_box(folder);
    write_sheet(folder, "sheet.obj", 0.5);
    write_crossing_sheet(folder);
    const ProgramRun run = run_program({"certify", "box.obj", "sheet.obj", "crossing.obj", "--json"}, folder.path());
    CHECK(run.exit_code == 1);
    const auto json = nlohmann::json::parse(run.out);
    CHECK(json.at("clean") == false);
    CHECK(json.at("intersections").get<int>() > 0);
    CHECK(json.at("deepest_penetration").get<double>() == Approx(0.113));
    CHECK(json.at("worst_frame") == 1);
    CHECK(json.at("frames")[0].at("smallest_distance").is_null());
    CHECK(json.at("frames")[1].at("vertices_inside") == 6);
    CHECK(run_program({"certify", "box.obj", "crossing.obj"}, folder.path()).out.find("NOT clean") != std::string::npos);
}

TEST_CASE("a sheet wholly inside crosses nothing and still is not clean") {
    const TestFolder folder;
    write_box(folder);
    write_sheet(folder, "sheet.obj", -0.25);
    const ProgramRun run = run_program({"certify", "box.obj", "sheet.obj", "--json"}, folder.path());
    CHECK(run.exit_code == 1);
    const auto json = nlohmann::json::parse(run.out);
    CHECK(json.at("intersections") == 0);
    CHECK(json.at("deepest_penetration").get<double>() == Approx(0.25));
}

TEST_CASE("the frames of a run are certified from its folder, and agree with its report") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_program({"run", "box.toml", "-o", "out"}, folder.path()).exit_code == 0);
    const ProgramRun run = run_program({"certify", "out", "--json"}, folder.path());
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(run.out);
    const auto report = nlohmann::json::parse(folder.read("out/report.json"));
    REQUIRE(json.at("frames").size() == report.at("frames").size());
    for (std::size_t i = 0; i < json.at("frames").size(); ++i)
        CHECK(json.at("frames")[i].at("smallest_distance") == report.at("frames")[i].at("smallest_distance"));
    CHECK(line_count(run_program({"certify", "out"}, folder.path()).out) == 8);
}

TEST_CASE("a frame that was changed after the run is found out") {
    const TestFolder folder;
    folder.write("box.toml", sheet_on_box());
    REQUIRE(run_program({"run", "box.toml", "-o", "out"}, folder.path()).exit_code == 0);
    write_sheet(folder, "out/frames/sheet_00003.obj", -0.1);
    const ProgramRun run = run_program({"certify", "out"}, folder.path());
    CHECK(run.exit_code == 1);
    CHECK(run.out.find("NOT clean") != std::string::npos);
}

TEST_CASE("a run without obstacles leaves nothing to check against") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    REQUIRE(run_program({"run", "sheet.toml", "-o", "out"}, folder.path()).exit_code == 0);
    const ProgramRun run = run_program({"certify", "out"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out == "6 frames and no obstacle: there is nothing to check against\n");
    const ProgramRun json = run_program({"certify", "out", "--json"}, folder.path());
    CHECK(nlohmann::json::parse(json.out).at("has_obstacles") == false);
    folder.write("out/frames/sheet_00003.obj", "v 0 0 nan\n");
    CHECK(refused(run_program({"certify", "out"}, folder.path()), "sheet_00003.obj"));
}

TEST_CASE("what cannot be read is exit code 2 with one message") {
    const TestFolder folder;
    write_box(folder);
    const auto certified = [&](const std::vector<std::string>& paths) {
        std::vector<std::string> arguments = {"certify"};
        arguments.insert(arguments.end(), paths.begin(), paths.end());
        return run_program(arguments, folder.path());
    };
    CHECK(refused(certified({"."}), "report.json"));
    CHECK(refused(certified({"box.obj"}), "box.obj"));
    CHECK(refused(certified({".", "box.obj"}), "folder"));
    CHECK(refused(certified({"box.obj", "absent.obj"}), "absent.obj"));
    for (const char* report :
         {"", "not ours", "[1, 2]", "{}", "{\"frames\": [{\"index\": \"x\"}]}", "{\"frames\": {\"a\": 1}}"}) {
        folder.write("report.json", report);
        const ProgramRun foreign = certified({"."});
        CHECK(refused(foreign, "report.json: is not the report of a run: "));
        CHECK(foreign.error.find("exception") == std::string::npos);
    }
    folder.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(refused(certified({"box.obj", "nan.obj"}), "nan.obj"));
    CHECK(refused(certified({"box.obj", "box.obj", "--distance-limit", "-1"}), "--distance-limit"));
    folder.write("sheet.toml", falling_sheet());
    REQUIRE(run_program({"run", "sheet.toml", "-o", "out", "--frames", "none"}, folder.path()).exit_code == 0);
    CHECK(refused(certified({"out"}), "no frames"));
    folder.write("report.json",
                 "{\"frames\": [{\"index\": 0, \"time\": 0, \"cloths\": [\"box\"], \"obstacles\": [], \"intersections\": 0, "
                 "\"deepest_penetration\": 0, \"smallest_distance\": null}]}");
    CHECK(refused(certified({"."}), "box: holds no frames that can be certified"));
}

TEST_CASE("cloth that meets cloth is certified against it, in a folder because its scene says so, else with --self") {
    const TestFolder folder;
    std::string scene = falling_sheet();
    scene.replace(scene.find("scheme = \"symplectic_euler\""), 27, "");
    scene.replace(scene.find("damping_form = \"velocity\""), 25, "");
    scene.replace(scene.find("area_density"), 0, "self_contact = true\n");
    folder.write("sheet.toml", scene);
    REQUIRE(run_program({"run", "sheet.toml", "-o", "out"}, folder.path()).exit_code == 0);
    const ProgramRun clean = run_program({"certify", "out", "--json"}, folder.path());
    CHECK(clean.exit_code == 0);
    CHECK(nlohmann::json::parse(clean.out).at("self_contact") == true);
    // A frame with one corner of the sheet pulled through its middle.
    TriangleMesh sheet = make_grid(0.3, 0.3, 4, 4);
    sheet.vertices[0] = Vec3(0.1, -0.05, 0.13);
    sheet.vertices[1] = Vec3(0.11, 0.05, 0.12);
    scenes::write_obj(folder.path("out/frames/sheet_00002.obj"), sheet.vertices, sheet.triangles);
    const ProgramRun crossing = run_program({"certify", "out", "--json"}, folder.path());
    CHECK(crossing.exit_code == 1);
    CHECK(nlohmann::json::parse(crossing.out).at("intersections").get<int>() > 0);
    write_box(folder);
    const std::string frame = "out/frames/sheet_00002.obj";
    CHECK(nlohmann::json::parse(run_program({"certify", "box.obj", frame, "--self", "--json"}, folder.path()).out)
              .at("intersections")
              .get<int>() > nlohmann::json::parse(run_program({"certify", "box.obj", frame, "--json"}, folder.path()).out)
                                .at("intersections")
                                .get<int>());
}

TEST_CASE("a folder is certified by the pairs of cloths that its report lists, and refused where it lists other cloths") {
    const TestFolder folder;
    const std::string cloth = "fabric = \"f\"\ngrid = { size = [0.3, 0.3], vertices = [4, 4] }\n";
    const std::string turned = "pose = { translation = [0.01, 0.02, 0.013], rotation = [0.6, 0.8, 0, 0] }\n";
    folder.write("two.toml",
                 "duration = 0.05\n[fabric.f]\nself_contact = true\nthickness = 0.002\n"
                 "springs = { structural = 100.0 }\n[[cloth]]\nname = \"a\"\n" +
                     cloth + "[[cloth]]\nname = \"b\"\n" + cloth + turned +
                     "[[pair]]\ncloths = [\"a\", \"b\"]\ncontact = false\n");
    REQUIRE(run_program({"run", "two.toml", "-o", "out"}, folder.path()).exit_code == 0);
    CHECK(run_program({"certify", "out"}, folder.path()).exit_code == 0);
    CHECK(run_program({"certify", "out", "--self"}, folder.path()).exit_code == 1);
    nlohmann::json report = nlohmann::json::parse(folder.read("out/report.json"));
    CHECK(report.at("frames")[0].at("self_contact") == nlohmann::json::parse("[[0, 0], [1, 1]]"));
    report.at("frames")[0].at("self_contact") = nlohmann::json::parse("[[0, 2]]");
    folder.write("out/report.json", report.dump());
    CHECK(refused(run_program({"certify", "out"}, folder.path()), "contact of no cloth"));
}

}  // namespace percale::program::test::certify_test
