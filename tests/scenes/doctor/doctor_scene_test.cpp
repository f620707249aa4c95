#include "doctor/doctor_scene.h"

#include <algorithm>
#include <filesystem>

#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "run/run_scene.h"
#include "run/scene_plan.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::doctor_scene_test {
namespace {

using Overrides = std::vector<Override>;

/// A sheet on a box that lies still: nothing is found in it.
std::string quiet_scene() { return sheet_on_box(); }

std::vector<Finding> examined(const std::string& text, const Overrides& overrides = {}) {
    const TestFolder folder;
    return examine_scene_file(folder.write("scene.toml", text), overrides);
}

const Finding* find(const std::vector<Finding>& found, const std::string& kind) {
    const auto one = std::find_if(found.begin(), found.end(), [&](const Finding& finding) { return finding.kind == kind; });
    return one == found.end() ? nullptr : &*one;
}

/// The severity of a kind, or "none".
std::string severity(const std::vector<Finding>& found, const std::string& kind) {
    const Finding* finding = find(found, kind);
    return finding == nullptr ? "none" : severity_word(finding->severity);
}

std::string kinds(const std::vector<Finding>& found) {
    std::string text;
    for (const Finding& finding : found) text += finding.kind + ": " + finding.what + "\n";
    return text;
}

const std::string lift = "[[obstacle.motion]]\ntime = 0.0\n[[obstacle.motion]]\ntime = 0.1\ntranslation = [0.0, -5.0, 0.0]\n";

}  // namespace

TEST_CASE("nothing is found in a sound scene") {
    CHECK(kinds(examined(quiet_scene())).empty());
    CHECK(kinds(examined(falling_sheet(), {{"cloth.sheet.pin", "[0]"}})).empty());
}

TEST_CASE("what a scene is refused for is an error at its place, with a fix") {
    const auto found = examined(quiet_scene(), {});
    const std::string typo = quiet_scene() + "frames = \"obi\"\n";
    const auto refused = examined(typo);
    REQUIRE(refused.size() == 2);
    CHECK(severity(refused, "not_built") == "note");
    CHECK(refused[0].kind == "refused");
    CHECK(refused[0].severity == Severity::error);
    CHECK(refused[0].place.find("scene.toml:") != std::string::npos);
    CHECK(refused[0].place.back() != 'l');
    CHECK(refused[0].what.find("obj") != std::string::npos);
    CHECK(refused[0].fix.find("percale explain") != std::string::npos);
    CHECK(severity(examined("title = \n"), "refused") == "error");
    CHECK(severity(examined(quiet_scene(), {{"step.scheme", "rk4"}}), "refused") == "error");
}

TEST_CASE("every fault of a scene file is reported, not only the first") {
    const auto keys = examined(quiet_scene() + "frames = \"obi\"\n[expect]\nlargest_strain = true\n[setp]\n");
    REQUIRE(keys.size() == 4);
    CHECK(keys[0].what.find("obj") != std::string::npos);
    CHECK(keys[1].what.find("expect.largest_strain must be") != std::string::npos);
    CHECK(keys[2].what.find("did you mean 'step'") != std::string::npos);
    const std::string cloth = "[[cloth]]\nname = \"sheet\"\nfabric = \"sheat\"\ngrid = { size = [1, 1], vertices = [3, 3] }\n";
    const auto names = examined(falling_sheet() + cloth);
    REQUIRE(names.size() == 3);
    CHECK(names[0].what.find("a second cloth 'sheet'") != std::string::npos);
    CHECK(names[1].what.find("no fabric 'sheat'; did you mean 'sheet'") != std::string::npos);
    const auto tables = examined("[fabric.one]\n[fabric.two]\n" + cloth);
    REQUIRE(tables.size() == 3);
    CHECK(tables[1].what.find("[fabric.two] lacks 'springs'") != std::string::npos);
}

TEST_CASE("all meshes of a scene are looked at, not only the first that is refused") {
    const TestFolder folder;
    const TriangleMesh crowded = crowded_sheet();
    write_obj(folder.path("crowded.obj"), crowded.vertices, crowded.triangles);
    const std::string two = R"(
[fabric.sheet]
springs = { structural = 1.0 }
[[cloth]]
name = "one"
fabric = "sheet"
mesh = "crowded.obj"
[[cloth]]
name = "two"
fabric = "sheet"
mesh = "missing.obj"
[[obstacle]]
name = "crowd"
mesh = "crowded.obj"
)";
    const auto found = examine_scene_file(folder.write("scene.toml", two), {});
    INFO(kinds(found));
    CHECK(severity(found, "crowded_edges") == "error");
    CHECK(severity(found, "unreadable") == "error");
    CHECK(find(found, "crowded_edges")->place == folder.path("scene.toml") + ":4:1");
    CHECK(find(found, "unreadable")->place == folder.path("scene.toml") + ":8:1");
    CHECK(find(found, "unreadable")->what.find("missing.obj: no such file") != std::string::npos);
    CHECK(std::count_if(found.begin(), found.end(), [](const Finding& one) { return one.role == MeshRole::obstacle; }) == 2);
    CHECK(severity(found, "not_built") == "note");
    CHECK(find(examined(quiet_scene()), "not_built") == nullptr);
}

TEST_CASE("pieces of a cloth are reported only where no seam joins them") {
    const TestFolder folder;
    folder.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 3 0 0\nv 4 0 0\nv 3 0 1\nf 1 2 3\nf 4 5 6\n");
    const auto found_with = [&](const std::string& more) {
        const std::string text =
            "gravity = [0, 0, 0]\n[fabric.f]\nsprings = { structural = 10.0 }\n"
            "[[cloth]]\nname = \"c\"\nfabric = \"f\"\nmesh = \"two.obj\"\n";
        return examine_scene_file(folder.write("scene.toml", text + more), {});
    };
    CHECK(severity(found_with(""), "parts") == "note");
    CHECK(severity(found_with("[[seam]]\nvertices = [[0, 3]]\n"), "parts") == "none");
    CHECK(severity(found_with("[[seam]]\ncloths = [\"c\", \"c\"]\nvertices = [[0, 3]]\n"), "parts") == "none");
}

TEST_CASE("an explicit step beyond its stability limit is an error, and the step named instead is stable") {
    const Overrides pinned = {{"cloth.sheet.pin", "[0]"}};
    Overrides stiff = pinned;
    stiff.push_back({"fabric.sheet.springs.structural", "1e5"});
    const auto found = examined(falling_sheet(), stiff);
    REQUIRE(severity(found, "unstable_step") == "error");
    const std::string fix = find(found, "unstable_step")->fix, key = "step.time_step = ";
    const std::size_t start = fix.find(key) + key.size();
    stiff.push_back({"step.time_step", fix.substr(start, fix.find(' ', start) - start)});
    CHECK(kinds(examined(falling_sheet(), stiff)).empty());
    CHECK(kinds(examined(falling_sheet(), pinned)).empty());
}

TEST_CASE("schemes that grow, ring or stop too early are warned of with what mends it") {
    const Overrides pinned = {{"cloth.sheet.pin", "[0]"}};
    const auto with = [&](Overrides more) {
        more.insert(more.begin(), pinned.begin(), pinned.end());
        return examined(falling_sheet(), more);
    };
    const auto growing = with({{"step.scheme", "forward_euler"}});
    REQUIRE(severity(growing, "growing_scheme") == "warning");
    CHECK(find(growing, "growing_scheme")->fix == "use rk4 or an implicit scheme");
    CHECK(find(growing, "growing_scheme")->place.starts_with("--set step.scheme"));
    const Override stiff = {"fabric.sheet.springs.structural", "1e7"};
    const auto ringing = with({{"step.scheme", "trapezoid"}, stiff});
    REQUIRE(severity(ringing, "ringing_step") == "warning");
    CHECK(find(ringing, "ringing_step")->fix.find("backward_euler") != std::string::npos);
    CHECK(severity(with({{"step.scheme", "trapezoid"}}), "ringing_step") == "none");
    const Override fine = {"cloth.sheet.grid.vertices", "[70, 70]"}, one = {"step.newton_iterations", "1"},
                   implicit = {"step.scheme", "backward_euler"};
    const auto hurried = with({implicit, fine, one});
    REQUIRE(severity(hurried, "one_newton_iteration") == "warning");
    CHECK(find(hurried, "one_newton_iteration")->fix == "allow more");
    CHECK(severity(with({implicit, fine}), "one_newton_iteration") == "none");
}

TEST_CASE("cloth that starts inside an obstacle is reported, by how far it is moved or that it is refused") {
    std::string inside = quiet_scene();
    inside.replace(inside.find("0.015"), 5, "-0.02");
    CHECK(severity(examined(inside), "start_moved") == "warning");
    CHECK(severity(examined(inside, {{"cloth.sheet.pose.translation", "[0, -0.001, 0]"}}), "start_moved") == "note");
    CHECK(severity(examined(quiet_scene()), "start_moved") == "none");
    const auto refused = examined(inside, {{"step.start", "refuse"}});
    REQUIRE(severity(refused, "start") == "error");
    CHECK(find(refused, "start")->place.find("scene.toml:15:1") != std::string::npos);
    CHECK(find(refused, "start")->fix.find("pose.translation") != std::string::npos);
    CHECK(severity(examined(inside, {{"cloth.sheet.pin", "[0]"}}), "start") == "error");
}

TEST_CASE("cloths with self_contact that start through each other are reported, or an error at the cloth where that is refused") {
    const std::string two = R"(
[fabric.sheet]
self_contact = true
springs = { structural = 1.0 }
[[cloth]]
name = "one"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [4, 4] }
pin = [0]
[[cloth]]
name = "two"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [4, 4] }
pose = { translation = [0.02, 0.0, 0.03], rotation = [0.94, 0.342, 0.0, 0.0] }
pin = [0]
)";
    const auto found = examined(two, {{"step.start", "refuse"}});
    INFO(kinds(found));
    CHECK(severity(found, "start") == "error");
    CHECK(severity(examined(two), "start_moved") == "warning");
    CHECK(kinds(examined(two, {{"cloth.two.pose.translation", "[0.0, 1.0, 0.0]"}})).empty());
}

TEST_CASE("cloth that nothing holds falls for ever") {
    CHECK(severity(examined(falling_sheet()), "free_fall") == "warning");
    CHECK(severity(examined(falling_sheet(), {{"gravity", "[0, 0, 0]"}}), "free_fall") == "none");
    CHECK(severity(examined(falling_sheet(), {{"cloth.sheet.pin", "[3]"}}), "free_fall") == "none");
    CHECK(severity(examined(falling_sheet(), {{"cloth.sheet.pin", "\"boundary\""}}), "free_fall") == "none");
    CHECK(severity(examined(quiet_scene()), "free_fall") == "none");
    const std::string caught = "[[event]]\ntime = 0.05\npin = { cloth = \"sheet\", vertices = [0] }\n";
    CHECK(severity(examined(falling_sheet() + caught), "free_fall") == "none");
}

TEST_CASE("what keeps a scene from ending at rest is found up front") {
    const Override rest{"duration", "rest"};
    CHECK(kinds(examined(quiet_scene(), {rest})).empty());
    const Override implicit{"step.scheme", "backward_euler"};
    CHECK(severity(examined(falling_sheet(), {rest, implicit}), "free_fall") == "error");
    const auto blowing = [](const std::string& wind) { return quiet_scene() + "[[event]]\ntime = 0.1\nwind = " + wind + "\n"; };
    const auto found = examined(blowing("[2, 0, 0]"), {rest});
    CHECK(severity(found, "flutter") == "warning");
    CHECK(find(found, "flutter")->place.find("scene.toml:21:") != std::string::npos);
    CHECK(severity(examined(blowing("[2, 0, 0]")), "flutter") == "none");
    CHECK(severity(examined(blowing("[0, 0, 0]"), {rest}), "flutter") == "none");
    std::string turning = quiet_scene();
    turning.insert(turning.find("[output]"), "spin = { turns_per_s = 1.0 }\n");
    const auto spins = examined(turning, {rest});
    CHECK(severity(spins, "refused") == "error");
    CHECK(find(spins, "refused")->what.find("it never stands still") != std::string::npos);
}

TEST_CASE("expectations that say nothing are warned of at their place") {
    const auto expecting = [](const std::string& scene, const std::string& measure, const Overrides& overrides = {}) {
        return examined(scene + "[expect]\n" + measure + " = { below = 1.0 }\n", overrides);
    };
    const auto alone = expecting(falling_sheet(), "intersections");
    CHECK(severity(alone, "idle_expectation") == "warning");
    CHECK(find(alone, "idle_expectation")->place.find("scene.toml:19:") != std::string::npos);
    CHECK(severity(expecting(falling_sheet(), "smallest_distance"), "idle_expectation") == "warning");
    CHECK(severity(expecting(quiet_scene(), "intersections"), "idle_expectation") == "none");
    CHECK(severity(expecting(quiet_scene(), "deepest_penetration"), "idle_expectation") == "none");
    const Overrides plane = {{"obstacle.box.shape", "{ plane = { half_size = 3.0 } }"}};
    CHECK(severity(expecting(quiet_scene(), "deepest_penetration", plane), "idle_expectation") == "warning");
    CHECK(severity(expecting(quiet_scene(), "largest_strain", {{"step.measure", "none"}}), "idle_expectation") == "warning");
    CHECK(severity(expecting(quiet_scene(), "largest_strain"), "idle_expectation") == "none");
}

TEST_CASE("a reference that is missing or has other vertices is an error") {
    const TestFolder folder;
    const TriangleMesh sheet = free_sheet();
    write_obj(folder.path("other.obj"), sheet.vertices, sheet.triangles);
    const auto expecting = [&](const std::string& file) {
        const std::string text = quiet_scene() + "[expect]\nmatches = { file = \"" + file + "\", within = 1.0 }\n";
        return examine_scene_file(folder.write("scene.toml", text), {});
    };
    CHECK(severity(expecting("missing.obj"), "refused") == "error");
    CHECK(severity(expecting("other.obj"), "refused") == "error");
    const TriangleMesh own = make_grid(1, 1, 6, 6);
    write_obj(folder.path("own.obj"), own.vertices, own.triangles);
    CHECK(severity(expecting("own.obj"), "refused") == "none");
}

TEST_CASE("fabrics that no cloth is made of are noted") {
    CHECK(severity(examined(quiet_scene() + "[fabric.silk]\npreset = \"silk\"\n"), "unused_fabric") == "note");
    CHECK(severity(examined(quiet_scene()), "unused_fabric") == "none");
}

TEST_CASE("obstacles that move fast are reported with the parts of a step, slow ones are not") {
    std::string moving = quiet_scene();
    moving.insert(moving.find("[output]"), lift);
    const auto found = examined(moving);
    CHECK(severity(found, "fast_obstacle") == "note");
    CHECK(find(found, "fast_obstacle")->what.find("up to 40 parts") != std::string::npos);  // 0.79 m a step over 20 mm
    CHECK(severity(examined(moving, {{"fabric.sheet.thickness", "0.001"}}), "fast_obstacle") == "warning");
    CHECK(severity(examined(moving, {{"step.time_step", "1e-4"}}), "fast_obstacle") == "none");
    const Overrides spin = {{"obstacle.box.spin", "{ axis = [0, 1, 0], turns_per_s = 50.0 }"}};
    CHECK(find(examined(quiet_scene(), spin), "fast_obstacle")->what.find("up to 20 parts") != std::string::npos);
}

TEST_CASE("bodies that bend are looked at in every frame: a bad one is an error, a jump is reported with its parts") {
    const TestFolder folder;
    const TriangleMesh ball = make_sphere(0.2, 2);
    const auto write = [&](int frame, double height) {
        std::vector<Vec3> x = ball.vertices;
        for (Vec3& p : x) p.y() += height;
        write_obj(folder.path("ball" + std::to_string(frame) + ".obj"), x, ball.triangles);
    };
    for (int frame = 0; frame < 10; ++frame) write(frame, -0.5 - 0.001 * frame);
    const std::string scene = folder.write("scene.toml", falling_sheet() + R"([[obstacle]]
name = "ball"
mesh = "ball%d.obj"
frames = [0, 9]
)");
    CHECK(severity(examine_scene_file(scene, Overrides{{"duration", "0.5"}}), "fast_obstacle") == "none");
    write(7, -1.5);
    const std::vector<Finding> jumps = examine_scene_file(scene, Overrides{{"duration", "0.5"}});
    CHECK(severity(jumps, "fast_obstacle") == "note");
    CHECK(find(jumps, "fast_obstacle")->what.find("bends so fast") != std::string::npos);
    CHECK(severity(examine_scene_file(scene, Overrides{{"duration", "0.1"}}), "fast_obstacle") == "none");  // over before it
    folder.write("ball8.obj", "v 0 0 nan\n");
    const std::vector<Finding> bad = examine_scene_file(scene, Overrides{{"duration", "0.5"}});
    CHECK(severity(bad, "bad_frame") == "error");
    CHECK(find(bad, "bad_frame")->what.find("ball8.obj:1") != std::string::npos);
}

TEST_CASE("runs that take hours, much memory or much disk are warned of") {
    const Overrides slow = {{"duration", "1e6"}, {"cloth.sheet.pin", "[0]"}};
    CHECK(severity(examined(falling_sheet(), slow), "long_run") == "none");  // 1e8 explicit steps of a tiny sheet
    const Overrides dear = {{"duration", "1e6"}, {"step.scheme", "backward_euler"}, {"cloth.sheet.grid.vertices", "[30, 30]"}};
    CHECK(severity(examined(falling_sheet(), dear), "long_run") == "warning");
    const Overrides many = {{"duration", "1e5"}, {"output.fps", "1e5"}};
    CHECK(severity(examined(falling_sheet(), many), "much_output") == "warning");
    CHECK(severity(examined(falling_sheet(), {{"output.fps", "1e5"}}), "much_output") == "none");
    const BuiltScene built = build_scene(parse_scene(falling_sheet(), "sheet.toml"));
    ScenePlan plan = plan_of(built);
    CHECK(severity(examine_cost(built, plan), "much_memory") == "none");
    plan.memory_bytes = 12e9;
    CHECK(find(examine_cost(built, plan), "much_memory")->what.find("12 GB of memory") != std::string::npos);
}

TEST_CASE("every shipped scene passes, and nothing in it will go wrong by its plan", "[slow]") {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(PERCALE_DATA_DIR) + "/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        const auto found = examine_scene_file(entry.path().string(), {});
        INFO(entry.path().string() << "\n" << kinds(found));
        CHECK(std::none_of(found.begin(), found.end(), [](const Finding& one) { return one.severity == Severity::error; }));
        ++scenes;
    }
    CHECK(scenes > 20);
}

TEST_CASE("pins in the world are a note where a body goes far away, pins on it and pins beside a still body are not") {
    const std::string pins = "cloth.sheet.pin", lifted = quiet_scene() + lift;
    CHECK(severity(examined(lifted, {{pins, "[0]"}}), "pins_stay") == "note");
    CHECK_THAT(find(examined(lifted, {{pins, "[0]"}}), "pins_stay")->what, Catch::Contains(" m away"));
    CHECK(severity(examined(quiet_scene(), {{pins, "[0]"}}), "pins_stay") == "none");
    CHECK(severity(examined(lifted), "pins_stay") == "none");
    const std::string unpinned = lifted + "[[event]]\ntime = 0.05\nunpin = { cloth = \"sheet\", vertices = [0] }\n";
    CHECK(severity(examined(unpinned, {{pins, "[0]"}}), "pins_stay") == "none");
}

TEST_CASE("meshes that look swapped are reported once") {
    const TestFolder folder;
    const TriangleMesh sheet = free_sheet(), ball = shifted(make_sphere(0.2, 2), {0, 0.5, 0});
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("ball.obj"), ball.vertices, ball.triangles);
    const std::string text =
        "[fabric.f]\nsprings.structural = 100.0\n[[cloth]]\nname = \"a\"\nfabric = \"f\"\nmesh = \"ball.obj\"\n"
        "[[obstacle]]\nname = \"b\"\nmesh = \"sheet.obj\"\n";
    const auto found = examine_scene_file(folder.write("scene.toml", text), {});
    CHECK(std::ranges::count(found, "swapped", &Finding::kind) == 1);
}

}  // namespace percale::scenes::test::doctor_scene_test
