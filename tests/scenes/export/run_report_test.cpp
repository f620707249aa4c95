#include "export/run_report.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "common/finding_json.h"
#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "percale/error.h"
#include "scenes/run/run_verdict.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_report_test {
using nlohmann::ordered_json;

namespace {

BuiltScene built(const std::string& text, const std::vector<Override>& overrides = {}) {
    return build_scene(parse_scene(text, "test.toml", overrides));
}

ordered_json report_of(const BuiltScene& scene, const RunResult& result, const std::vector<FrameRecord>& frames = {},
                       const std::vector<ExpectationResult>& expectations = {}) {
    return ordered_json::parse(run_report_text(scene, result, frames, expectations));
}

bool skips(const ordered_json& report, const std::string& what) {
    for (const ordered_json& part : report.at("skipped"))
        if (part.at("what") == what) return !part.at("why").get<std::string>().empty();
    return false;
}

}  // namespace

TEST_CASE("a report holds every entry that users may rely on") {
    BuiltScene scene = built(sheet_on_box());
    const RunResult result = run_scene(scene);
    const ordered_json json = report_of(scene, result);
    for (const char* key : {"status",
                            "simulated_s",
                            "steps",
                            "rejected_steps",
                            "halvings",
                            "unsolved_steps",
                            "sleeping_steps",
                            "smallest_step_s",
                            "largest_step_s",
                            "newton_iterations",
                            "linear_iterations",
                            "largest_residual",
                            "linear_solver",
                            "cpu_s",
                            "wall_s",
                            "certificate_s",
                            "peak_memory_bytes",
                            "stages",
                            "obstacles",
                            "pinched",
                            "scheme",
                            "warnings",
                            "findings",
                            "skipped",
                            "contacts_most",
                            "contact_stiffness",
                            "energy",
                            "expectations",
                            "settings",
                            "version",
                            "intersections",
                            "deepest_penetration",
                            "smallest_distance",
                            "worst_frame",
                            "largest_strain",
                            "speed_at_end",
                            "rms_speed_at_end",
                            "energy_gain",
                            "lowest_vertex",
                            "frames"}) {
        INFO(key);
        CHECK(json.contains(key));
    }
    for (const char* key : {"refresh", "evaluate", "force", "setup", "solve", "cut", "measure"})
        CHECK(json.at("stages").at(key).is_number());
    CHECK(json.at("status") == "finished");
    CHECK_FALSE(json.contains("reason"));
    CHECK(json.at("title") == "sheet on a box");
    CHECK(json.at("steps") == result.totals.steps);
    CHECK(json.at("cpu_s").get<double>() == result.totals.cpu_s);
    CHECK(json.at("energy").at("elastic").get<double>() == result.totals.energy.elastic);
    CHECK(json.at("lowest_vertex").get<double>() == result.measures.lowest_vertex);
    CHECK(json.at("peak_memory_bytes").get<double>() > 1e5);
    CHECK(json.at("linear_solver") == "cg");
}

TEST_CASE("a report says what is left of each obstacle mesh and what was dropped") {
    const TestFolder folder;
    folder.write("flap.obj", "v 0 -5 0\nv 1 -5 0\nv 0 -5 1\nv 0 -5 0\nv 2 -5 0\nv 9 9 9\nf 1 3 2\nf 4 3 2\nf 1 2 5\n");
    folder.write("scene.toml", sheet_on_box() + "[[obstacle]]\nname = \"flap\"\nmesh = \"flap.obj\"\n");
    const ordered_json list = report_of(build_scene(load_scene(folder.path("scene.toml"))), RunResult{}).at("obstacles");
    REQUIRE(list.size() == 2);
    CHECK(list[0] == ordered_json{{"name", "box"},
                                  {"contact_force", {0.0, 0.0, 0.0}},
                                  {"triangles", 12},
                                  {"merged_vertices", 0},
                                  {"degenerate_triangles", 0},
                                  {"duplicate_triangles", 0},
                                  {"unreferenced_vertices", 0},
                                  {"internal_triangles", 0}});
    CHECK(list[1] == ordered_json{{"name", "flap"},
                                  {"contact_force", {0.0, 0.0, 0.0}},
                                  {"triangles", 1},
                                  {"merged_vertices", 1},
                                  {"degenerate_triangles", 1},
                                  {"duplicate_triangles", 1},
                                  {"unreferenced_vertices", 2},
                                  {"internal_triangles", 0}});
    CHECK(report_of(built(falling_sheet()), RunResult{}).at("obstacles").empty());
}

TEST_CASE("the report says what the start moved") {
    CHECK(report_of(built(sheet_on_box()), RunResult{}).at("start_repair").empty());
    std::string inside = sheet_on_box();
    inside.replace(inside.find("0.015"), 5, "-0.01");
    const ordered_json list = report_of(built(inside), RunResult{}).at("start_repair");
    REQUIRE(list.size() == 1);
    CHECK(list[0].at("cloth") == "sheet");
    CHECK(list[0].at("obstacle") == "box");
    CHECK(list[0].at("vertices_moved") == 36);
    CHECK(list[0].at("largest_move").get<double>() > 0.01);
    CHECK(list[0].at("largest_move").get<double>() < 0.025);
}

TEST_CASE("the report says which obstacles gave way, when and how far, and a run in which they do is resumed in every bit",
          "[slow]") {
    const std::string text = R"(
duration = 0.9
[step]
time_step = 0.016666666666666666
[fabric.felt]
thickness = 0.005
springs = { structural = 500.0, shear = 100.0, bend = 1.0 }
spring_damping = 0.5
[[cloth]]
name = "sheet"
fabric = "felt"
grid = { size = [0.6, 0.6], vertices = [15, 15] }
pose = { rotation = [0.7071067811865476, 0.0, 0.0, 0.7071067811865476] }
pin = { box = [[-0.1, 0.95, -1.0], [1.1, 1.1, 1.1]] }
[[obstacle]]
name = "left"
shape = { sphere = { radius = 0.2 } }
on_pinch = "yield"
pose = { translation = [-0.225, -0.1, 0.0] }
[[obstacle]]
name = "right"
shape = { sphere = { radius = 0.2 } }
on_pinch = "yield"
motion = [ { time = 0.0, translation = [0.225, -0.1, 0.0] }, { time = 0.4, translation = [0.15, -0.1, 0.0] },
           { time = 0.8, translation = [0.3, -0.1, 0.0] } ]
)";
    const Scene scene = parse_scene(text, "test.toml", {});
    BuiltScene one = build_scene(scene);
    const RunResult result = run_scene(one);
    REQUIRE(result.status == RunStatus::finished);
    CHECK(result.measures.intersections == 0);
    const ordered_json pinched = report_of(one, result).at("pinched");
    REQUIRE(pinched.size() == 1);
    CHECK(pinched[0].at("obstacles") == ordered_json({"left", "right"}));
    CHECK(pinched[0].at("from").get<double>() > 0.1);
    CHECK(pinched[0].at("to").get<double>() < 0.7);
    CHECK(pinched[0].at("yielded").get<double>() > 0.01);
    CHECK(report_of(one, result).at("settings").at("obstacle")[0].at("on_pinch") == "yield");
    const WatchedRun plain = watch(scene, {}), left = watch(scene, {.checkpoint_every = 0.25});
    CHECK(plain.hashes == left.hashes);
    REQUIRE(left.states.size() >= 2);
    for (std::size_t k = 0; k < left.states.size(); ++k)
        CHECK(resumes_as(plain, left, k, watch(scene, {.from = &left.states[k]})));
}

TEST_CASE("what was not computed is left out, and infinity is null") {
    const BuiltScene scene = built(falling_sheet());
    const ordered_json json = report_of(scene, RunResult{});
    CHECK(json.at("smallest_distance").is_null());
    CHECK(json.at("worst_frame").is_null());
    CHECK_FALSE(json.contains("matches"));
    CHECK(json.at("energy").at("closure") == 0.0);
    CHECK(json.at("linear_solver") == "none");
}

TEST_CASE("the report has every entry of the ledger, null where it was not kept") {
    RunResult result;
    StepEnergy& energy = result.totals.energy;
    energy = {.kinetic = 2.0,
              .work = 4.0,
              .dissipated_material = 0.5,
              .dissipated_friction = 0.25,
              .residual_work = 0.125,
              .imbalance = 1.0};
    const ordered_json kept = report_of(built(falling_sheet()), result).at("energy");
    CHECK(kept.at("dissipated_material") == 0.5);
    CHECK(kept.at("dissipated_friction") == 0.25);
    CHECK(kept.at("dissipated_contact") == 0.0);
    CHECK(kept.at("dissipated_integrator") == 0.0);
    CHECK(kept.at("residual_work") == 0.125);
    CHECK(kept.at("closure") == 0.25);
    for (const auto entry : ledger_entries) energy.*entry = std::numeric_limits<double>::quiet_NaN();
    const ordered_json unmeasured = report_of(built(falling_sheet()), result).at("energy");
    CHECK(unmeasured.at("kinetic") == 2.0);
    CHECK(ordered_json::parse(unmeasured.dump()).at("closure").is_null());
    CHECK(ordered_json::parse(unmeasured.dump()).at("dissipated_integrator").is_null());
}

TEST_CASE("a failed run carries its reason") {
    RunResult result;
    result.status = RunStatus::failed;
    result.reason = "vertex 3 was blocked";
    const ordered_json json = report_of(built(falling_sheet()), result);
    CHECK(json.at("status") == "failed");
    CHECK(json.at("reason") == "vertex 3 was blocked");
}

TEST_CASE("a run warns of torn cloth without an expectation; crossings and steps that were not solved are its status") {
    BuiltScene scene = built(sheet_on_box());
    RunResult result = run_scene(scene);
    CHECK(end_warnings(scene, result).empty());
    CHECK(result.totals.unsolved_steps == 0);
    result.measures.intersections = 3;
    result.measures.largest_strain = 9.0;
    result.totals.unsolved_steps = 2;
    const std::vector<Finding> said = end_warnings(scene, result);
    REQUIRE(said.size() == 1);
    CHECK(said[0].kind == "torn");
    CHECK(finding_text(said[0]) == "the largest strain is 900 %: cloth would have torn");
    const ordered_json report = report_of(scene, result);
    CHECK(report.at("warnings") == ordered_json(finding_texts(said)));
    CHECK(report.at("findings") == ordered_json(said));
    CHECK(report.at("status") == "crossed");
    CHECK(report.at("reason") == verdict_of_run(result).reason);
    BuiltScene hurried = built(sheet_on_box(), {{"step.newton_iterations", "2"}, {"step.newton_tolerance", "1e-12"}});
    const RunResult unsolved = run_scene(hurried);
    CHECK(unsolved.totals.unsolved_steps > 0);
}

TEST_CASE("expectations are listed with measure, value, limit and outcome") {
    ExpectationResult good, unmeasured;
    good.expectation = {.measure = "largest_strain",
                        .lowest = -std::numeric_limits<double>::infinity(),
                        .highest = 0.3,
                        .lowest_included = true,
                        .highest_included = false,
                        .file = {},
                        .place = {}};
    good.value = 0.25;
    good.passed = true;
    good.text = "largest_strain 0.25, expected < 0.3: passed";
    unmeasured.expectation.measure = "matches";
    const ordered_json list = report_of(built(falling_sheet()), RunResult{}, {}, {good, unmeasured}).at("expectations");
    REQUIRE(list.size() == 2);
    CHECK(
        list[0] ==
        ordered_json{{"measure", "largest_strain"}, {"value", 0.25}, {"limit", "< 0.3"}, {"passed", true}, {"text", good.text}});
    CHECK(list[1].at("value").is_null());
    CHECK(list[1].at("passed") == false);
}

TEST_CASE("what a scene does not need is listed as skipped, what it needs is not") {
    const std::string contact = "contact detection, contact constraints, clamps and predicted positions";
    BuiltScene plain = built(sheet_on_box());
    const ordered_json report = report_of(plain, run_scene(plain));
    CHECK_FALSE(skips(report, contact));
    CHECK_FALSE(skips(report, "matrix and linear solve"));
    CHECK_FALSE(skips(report, "shear springs of sheet"));
    CHECK(skips(report, "motion of obstacles"));
    BuiltScene bare = built(falling_sheet(), {{"fabric.sheet.springs.shear", "0"}, {"fabric.sheet.springs.bend", "0"}});
    const ordered_json bare_report = report_of(bare, run_scene(bare));
    CHECK(skips(bare_report, contact));
    CHECK(skips(bare_report, "matrix and linear solve"));
    CHECK(skips(bare_report, "shear springs of sheet"));
    CHECK(skips(bare_report, "bending springs of sheet"));
}

TEST_CASE("steps in which all cloth slept are counted, and none where nothing is skipped") {
    const Override shifted{"obstacle.box.pose.translation", "[0.1, -0.25, 0.03]"};
    BuiltScene scene = built(sheet_on_box(), {{"duration", "2"}, shifted});
    const RunResult result = run_scene(scene);
    CHECK(result.totals.sleeping_steps > 30);
    CHECK(report_of(scene, result).at("sleeping_steps") == result.totals.sleeping_steps);
    BuiltScene whole = built(sheet_on_box(), {{"duration", "2"}, shifted, {"step.skip", "false"}});
    CHECK(run_scene(whole).totals.sleeping_steps == 0);
}

TEST_CASE("the certificate of every step is in the report where it was asked for") {
    BuiltScene plain = built(sheet_on_box());
    CHECK(report_of(plain, run_scene(plain)).at("step_certificate").is_null());
    BuiltScene certified = built(sheet_on_box());
    const RunResult result = run_scene(certified, {}, {.certify_steps = true});
    const ordered_json certificate = report_of(certified, result).at("step_certificate");
    CHECK(certificate.at("states") == 13);
    CHECK(certificate.at("intersections") == 0);
    CHECK(certificate.at("deepest_penetration") == 0.0);
    CHECK(certificate.at("smallest_distance") == result.measures.steps->smallest_distance);
    CHECK(certificate.at("worst_step") == result.measures.steps->worst_step);
    CHECK(certificate.at("worst_time_s") == result.measures.steps->worst_time);
}

TEST_CASE("frames read back from a report are those that were listed") {
    const TestFolder folder;
    FrameRecord near, far;
    near.index = 0;
    near.cloths = {"frames/a_00000.obj", "frames/b_00000.obj"};
    near.obstacles = {"obstacles/ball_00000.obj"};
    near.check.intersections = 2;
    near.check.deepest_penetration = 1.0 / 3.0;
    near.check.smallest_distance = 0.0;
    far.index = 1;
    far.time = 1.0 / 30.0;
    const std::vector<FrameRecord> frames = {near, far};
    folder.write("report.json", run_report_text(built(falling_sheet()), RunResult{}, frames, {}));
    const std::vector<FrameRecord> read = read_frame_records(folder.path());
    REQUIRE(read.size() == 2);
    CHECK(read[0].cloths == near.cloths);
    CHECK(read[0].obstacles == near.obstacles);
    CHECK(read[0].check.intersections == 2);
    CHECK(read[0].check.deepest_penetration == near.check.deepest_penetration);
    CHECK(read[1].time == far.time);
    CHECK(read[1].check.smallest_distance == std::numeric_limits<double>::infinity());
}

TEST_CASE("a report that is missing, cut off or of another shape is refused by name") {
    const TestFolder folder;
    CHECK_THROWS_WITH(read_frame_records(folder.path()), Catch::Contains("report.json"));
    for (const char* text : {"", "{", "[]", "{}", "{\"frames\": 3}", "{\"frames\": [{\"index\": \"x\"}]}"}) {
        INFO(text);
        folder.write("report.json", text);
        CHECK_THROWS_AS(read_frame_records(folder.path()), SceneError);
        CHECK_THROWS_AS(read_report_text(folder.path()), SceneError);
    }
}

TEST_CASE("a report read back as text says what it said, in every bit of its numbers") {
    const TestFolder folder;
    const std::string text = run_report_text(built(falling_sheet()), RunResult{}, {}, {});
    folder.write("report.json", text);
    CHECK(nlohmann::json::parse(read_report_text(folder.path())) == nlohmann::json::parse(text));
}

TEST_CASE("a run that finishes with a tight garment says so, and cloth that is pinned, a grid or on a shape is none") {
    const TestFolder folder;
    const TriangleMesh sheet = make_grid(0.3, 0.3, 6, 6), box = make_box(Vec3(1.0, 0.5, 1.0));
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("box.obj"), box.vertices, box.triangles);
    const std::string mesh = "mesh = \"sheet.obj\"", grid = "grid = { size = [0.3, 0.3], vertices = [6, 6] }";
    const std::string body = "mesh = \"box.obj\"", shape = "shape = { box = { size = [1.0, 0.5, 1.0] } }";
    const auto warnings = [&](const std::string& cloth, const std::string& obstacle, bool touched = true) {
        const std::string text =
            "duration = 0.1\n[fabric.f]\nsprings = { structural = 1.0, bend = 0.01 }\n[[cloth]]\nname = "
            "\"a\"\nfabric = "
            "\"f\"\n" +
            cloth + "\npose.translation = [0, 0.008, 0]\n[[obstacle]]\nname = \"b\"\npose.translation = [0, -0.25, 0]\n" +
            obstacle + "\n";
        BuiltScene scene = build_scene(load_scene(folder.write("t.toml", text)));
        RunResult result = run_scene(scene);
        CHECK(end_warnings(scene, result).empty());
        REQUIRE(result.totals.contacts_most > 0);
        if (!touched) result.totals.contacts_most = 0;
        std::vector<Vec3> wide;
        for (const Vec3& x : scene.simulation.positions(scene.cloths[0])) wide.push_back(1.3 * x);
        scene.simulation.set_positions(scene.cloths[0], wide);
        return end_warnings(scene, result);
    };
    REQUIRE(warnings(mesh, body).size() == 1);
    CHECK(warnings(mesh, body)[0].kind == "tight");
    CHECK(warnings(mesh, body)[0].place.ends_with("t.toml:4:1"));
    CHECK(finding_text(warnings(mesh, body)[0]) ==
          "'a' is stretched by 30 % at its tightest: it may be too small for the body; pose.scale makes it larger");
    CHECK(warnings(mesh, body, false).empty());
    CHECK(warnings(mesh + "\npin = [0]", body).empty());
    CHECK(warnings(grid, body).empty());
    CHECK(warnings(mesh, shape).empty());
}

}  // namespace percale::scenes::test::run_report_test
