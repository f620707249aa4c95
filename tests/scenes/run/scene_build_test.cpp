#include "scenes/run/scene_build.h"

#include <atomic>
#include <cmath>

#include "percale/fabric_presets.h"
#include "scenes/common/scene_file_error.h"
#include "scenes/common/text.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/scene_plan.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_build_test {
namespace {

BuiltScene built(const std::string& text) { return build_scene(parse_scene(text, "t")); }

std::string fault(const std::string& text) {
    return error_of([&] { built(text); });
}

// Below the sheet of small_scene(), far enough away.
std::string body(const std::string& shape) {
    return "[[obstacle]]\nname = \"body\"\nshape = { " + shape + " }\npose = { translation = [0, -5, 0] }\n";
}

Vec3 extent(const TriangleMesh& mesh) {
    Vec3 lowest = mesh.vertices.front(), highest = lowest;
    for (const Vec3& x : mesh.vertices) {
        lowest = lowest.cwiseMin(x);
        highest = highest.cwiseMax(x);
    }
    return highest - lowest;
}

// A scene beside a mesh file `cloth.obj` with this text.
std::string mesh_scene(const test::TestFolder& folder, const std::string& obj, const std::string& more = "",
                       const std::string& fabric = "springs = { structural = 100.0, bend = 1.0 }") {
    folder.write("cloth.obj", obj);
    return folder.write("scene.toml",
                        "[fabric.f]\n" + fabric + "\n[[cloth]]\nname = \"flag\"\nfabric = \"f\"\nmesh = \"cloth.obj\"\n" + more);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n";

}  // namespace

TEST_CASE("a grid is built at its pose, and its rest mesh is where the simulation starts") {
    const BuiltScene scene =
        built(small_scene() +
              "pose = { translation = [1, 2, 3], rotation = [0.7071067811865476, 0.7071067811865476, 0, 0], scale = 2 }\n");
    const TriangleMesh& mesh = scene.cloth_meshes.at(0);
    CHECK(mesh.is_grid());
    CHECK((extent(mesh) - Vec3(0.8, 0.6, 0.0)).norm() < 1e-12);
    const auto positions = scene.simulation.positions(scene.cloths.at(0));
    REQUIRE(positions.size() == 20);
    for (std::size_t i = 0; i < 20; ++i) CHECK(positions[i] == mesh.vertices[i]);
    CHECK(scene.scene.cloths.at(0).name == "flag");
}

TEST_CASE("pinned vertices stay and the others fall") {
    BuiltScene scene = built(small_scene() + "pin = { box = [[0, 0, 0], [0, 1, 1]] }\n");
    const std::vector<Vec3> start = scene.cloth_meshes.at(0).vertices;
    REQUIRE(scene.simulation.step().ok());
    const auto positions = scene.simulation.positions(scene.cloths.at(0));
    for (std::size_t i = 0; i < start.size(); ++i) {
        CAPTURE(i);
        CHECK((positions[i] == start[i]) == (i % 5 == 0));
    }
}

TEST_CASE("several cloths and obstacles keep the order of the file") {
    const std::string second =
        "[[cloth]]\nname = \"big\"\nfabric = \"sheet\"\ngrid = { size = [1, 1], vertices = [3, 3] }\n"
        "pose = { translation = [0, 1, 0] }\n";
    const std::string other =
        "[[obstacle]]\nname = \"other\"\nshape = { box = { size = [1, 1, 1] } }\npose = { translation = [9, 0, 0] }\n";
    const BuiltScene scene = built(small_scene() + second + body("sphere = { radius = 0.5 }") + other);
    REQUIRE(scene.cloths.size() == 2);
    CHECK(scene.simulation.positions(scene.cloths[0]).size() == 20);
    CHECK(scene.simulation.positions(scene.cloths[1]).size() == 9);
    REQUIRE(scene.obstacles.size() == 2);
    CHECK(scene.simulation.obstacle_pose(scene.obstacles[1]).translation == Vec3(9, 0, 0));
    CHECK(scene.obstacle_meshes[1].triangles.size() == 12);
}

TEST_CASE("shapes have the asked sizes, in their own coordinates") {
    const auto mesh = [](const std::string& shape) { return built(small_scene() + body(shape)).obstacle_meshes.at(0); };
    const TriangleMesh sphere = mesh("sphere = { radius = 0.25 }");
    CHECK(sphere.triangles.size() == 5120);
    for (const Vec3& x : sphere.vertices) REQUIRE(x.norm() == Approx(0.25).epsilon(1e-12));
    CHECK((extent(mesh("box = { size = [1, 2, 3] }")) - Vec3(1, 2, 3)).norm() < 1e-12);
    CHECK((extent(mesh("cylinder = { radius = 0.5, height = 3 }")) - Vec3(1, 3, 1)).norm() < 1e-12);
    CHECK((extent(mesh("capsule = { radius = 0.5, height = 2 }")) - Vec3(1, 3, 1)).norm() < 1e-12);
    CHECK((extent(mesh("plane = {}")) - Vec3(20, 0, 20)).norm() < 1e-12);
    CHECK((extent(mesh("plane = { half_size = 2 }")) - Vec3(4, 0, 4)).norm() < 1e-12);
}

TEST_CASE("a mesh is found beside the scene file and scaled by its unit") {
    const test::TestFolder folder;
    const BuiltScene scene = build_scene(load_scene(mesh_scene(folder, square, "unit = \"cm\"\n")));
    CHECK((extent(scene.cloth_meshes.at(0)) - Vec3(0.01, 0, 0.01)).norm() < 1e-15);
    CHECK_FALSE(scene.cloth_meshes.at(0).is_grid());
}

TEST_CASE("a missing mesh is reported with the place of its cloth and its path") {
    const test::TestFolder folder;
    const std::string file = mesh_scene(folder, square);
    std::filesystem::remove(folder.path("cloth.obj"));
    const std::string message = error_of([&] { build_scene(load_scene(file)); });
    CHECK(message.starts_with(file + ":3:1: "));
    CHECK(message.find("'flag'") != std::string::npos);
    CHECK(message.find("cloth.obj") != std::string::npos);
}

TEST_CASE("a mesh that no cloth can be made of is reported with the place of its cloth") {
    const test::TestFolder folder;
    const auto message = [&](const std::string& obj) {
        const std::string file = mesh_scene(folder, obj);
        const std::string text = error_of([&] { build_scene(load_scene(file)); });
        CHECK(text.starts_with(file + ":3:1: "));
        return text;
    };
    CHECK(message("v 0 0 0\nv 1 0 0\nv nan 0 1\nf 1 2 3\n") != "nothing was thrown");
    CHECK(message("v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 0\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n").find("edge") != std::string::npos);
    CHECK(message("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n") != "nothing was thrown");
    CHECK(message("") != "nothing was thrown");
}

TEST_CASE("shear springs on a free mesh are refused at the cloth") {
    const test::TestFolder folder;
    const std::string file = mesh_scene(folder, square, "", "springs = { structural = 100.0, shear = 5.0 }");
    const std::string message = error_of([&] { build_scene(load_scene(file)); });
    CHECK(message.starts_with(file + ":3:1: "));
    CHECK(message.find("cloth 'flag': fabric.f.springs.shear = 5 N/m") != std::string::npos);
}

TEST_CASE("a pin out of range is refused at the pin") {
    CHECK(fault(small_scene() + "pin = [20]\n") ==
          "t:8:7: pin: vertices of cloth 'flag': vertex 20 is out of range; allowed: 0 ... 19");
    CHECK(fault(small_scene() + "pin = { box = [[2, 0, 0], [2, 0, 0]] }\n")
              .starts_with("t:8:15: pin: vertices of cloth 'flag': no vertex lies in the box"));
    const Override setting{"cloth.flag.pin", "[5000]"};
    const Scene set = parse_scene(small_scene(), "t", {&setting, 1});
    CHECK(error_of([&] { build_scene(set); }).starts_with("--set cloth.flag.pin: pin: vertices of cloth 'flag': vertex 5000 "));
}

TEST_CASE("events are checked before anything runs") {
    CHECK(fault(small_scene() + "[[event]]\ntime = 0.5\nunpin = { cloth = \"flag\", vertices = [20] }\n")
              .starts_with("t:8:1: event: "));
}

TEST_CASE("cloth and obstacle may be parts of one mesh file") {
    const percale::scenes::test::TestFolder folder;
    folder.write("all.obj",
                 "o sheet\nv 0 1 0\nv 1 1 0\nv 0 1 1\nf 1 3 2\no stand\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 -1 0\n"
                 "f 4 5 6\nf 4 7 5\nf 4 6 7\nf 5 7 6\n");
    const std::string text =
        "[fabric.f]\nsprings = { structural = 100 }\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\n"
        "mesh = \"all.obj\"\npart = \"sheet\"\n[[obstacle]]\nname = \"o\"\nmesh = \"all.obj\"\n"
        "part = \"stand\"\n";
    const BuiltScene scene = build_scene(load_scene(folder.write("scene.toml", text)));
    CHECK(scene.cloth_meshes[0].vertices == std::vector<Vec3>{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}});
    CHECK(scene.obstacle_meshes[0].triangles.size() == 4);
    CHECK(scene.obstacle_meshes[0].vertices.size() == 4);
    const std::string seam = text + "[[seam]]\nfile = \"mesh\"\ncloths = [\"c\", \"c\"]\n";
    CHECK(error_of([&] { build_scene(load_scene(folder.write("sewn.toml", seam))); }).find("takes part \"sheet\" of it alone") !=
          std::string::npos);
}

TEST_CASE("vertices of a mesh file are welded where its scene says so, and not where others count them") {
    const percale::scenes::test::TestFolder folder;
    folder.write("cut.obj",
                 "v 0 1 0\nv 1 1 0\nv 0 1 1\nv 1.00001 1 0\nv 1 1 1\nv 0 1 1.00001\nvt 0 0\nf 1/1 3/1 2/1\nf 4/1 6/1 5/1\n");
    const std::string cloth =
        "[fabric.f]\nsprings = { structural = 100 }\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\nmesh = \"cut.obj\"\nweld = 1e-4\n";
    const auto build = [&](const std::string& more) { return build_scene(load_scene(folder.write("scene.toml", cloth + more))); };
    const std::string obstacle =
        "[[obstacle]]\nname = \"o\"\nmesh = \"cut.obj\"\npose = { translation = [0, -1, 0] }\nweld = 1e-4\n";
    const BuiltScene scene = build(obstacle);
    CHECK(scene.cloth_meshes[0].vertices.size() == 4);
    CHECK(scene.obstacle_meshes[0].vertices.size() == 4);
    const auto refused = [&](const std::string& more) { return error_of([&] { build(more); }); };
    CHECK(refused("rest = \"uv\"\n").find("weld joins vertices of its mesh, so rest is not") != std::string::npos);
    CHECK(refused("[[seam]]\nfile = \"mesh\"\ncloths = [\"c\", \"c\"]\n").find("of which weld makes fewer") != std::string::npos);
    CHECK(refused(obstacle + "frames = [0, 1]\n").find("weld joins vertices of a mesh that stays as it is") != std::string::npos);
    CHECK(
        refused("[[obstacle]]\nname = \"o\"\nshape = { plane = {} }\nweld = 1e-4\n").find("weld joins vertices of a mesh file") !=
        std::string::npos);
}

TEST_CASE("obstacles need a detector, a scene without obstacles needs none") {
    const std::string none = "[step]\ndetector = \"none\"\n";
    CHECK(fault(none + small_scene() + body("plane = {}")) ==
          "t:10:1: obstacle 'body' needs a detector, but step.detector is none; valid: fcl, bullet, brute_force");
    CHECK(fault(none + small_scene()) == "nothing was thrown");
}

TEST_CASE("a cloth that starts through, inside or touching an obstacle is refused at the obstacle") {
    const auto start_on = [](const std::string& shape, double height) {
        const std::string far = body("plane = {}");
        return fault("[step]\nstart = \"refuse\"\n" + small_scene() + far + "[[obstacle]]\nname = \"block\"\nshape = { " + shape +
                     " }\npose = { translation = [0, " + number_text(height) + ", 0] }\n");
    };
    const std::string through = start_on("sphere = { radius = 0.1 }", 0.0);
    CHECK(through.starts_with("t:14:1: the cloth starts through block: "));
    CHECK(through.find(" of flag and triangle ") != std::string::npos);
    CHECK(start_on("sphere = { radius = 2 }", 0.0).starts_with("t:14:1: the cloth starts inside block: 20 vertices"));
    CHECK(start_on("capsule = { radius = 0.25, height = 0.5 }", -0.5) ==
          "t:14:1: the cloth starts touching block; move the cloth or the obstacle apart, or allow start = repair");
    CHECK(start_on("capsule = { radius = 0.25, height = 0.5 }", -0.51) == "nothing was thrown");
}

TEST_CASE("a start is repaired unless the scene refuses that") {
    const auto ball = [](double height) {
        return body("plane = {}") +
               "[[obstacle]]\nname = \"block\"\nshape = { sphere = { radius = 0.1 } }\npose = { translation = [0, " +
               number_text(height) + ", 0] }\n";
    };
    const BuiltScene repaired = build_scene(parse_scene(small_scene() + ball(0.0), "t"));
    REQUIRE(repaired.simulation.start_repair().size() == 1);
    CHECK(repaired.simulation.start_repair()[0].obstacle_name == "block");
    CHECK(repaired.simulation.start_repair()[0].cloth_name == "flag");
    CHECK(build_scene(parse_scene(small_scene() + ball(0.5), "t")).simulation.start_repair().empty());
    const std::atomic<bool> cancel = true;
    CHECK_THROWS_WITH(build_scene(parse_scene(small_scene() + ball(0.0), "t"), &cancel), Catch::Contains("cancelled"));
    CHECK_NOTHROW(build_scene(parse_scene(small_scene() + ball(0.5), "t"), &cancel));
}

TEST_CASE("a pin inside an obstacle is an error at the obstacle that names the pin") {
    const std::string text = small_scene() + "pin = [7]\n" + body("plane = {}") +
                             "[[obstacle]]\nname = \"block\"\nshape = { sphere = { radius = 2 } }\n";
    CHECK(fault(text).starts_with("t:13:1: pinned vertex 7 of flag starts inside block; move the pin or the obstacle"));
}

namespace {

/// Two flags that meet cloth, the second posed as said.
std::string two_flags(const std::string& translation, const std::string& rotation) {
    std::string text = "[fabric.f]\nself_contact = true\nsprings = { structural = 100.0 }\n";
    for (const bool second : {false, true}) {
        text += std::string("[[cloth]]\nname = \"") + (second ? "banner" : "flag") + "\"\nfabric = \"f\"\n" +
                "grid = { size = [1.0, 1.0], vertices = [4, 5] }\n";
        if (second) text += "pose = { translation = " + translation + ", rotation = " + rotation + " }\n";
    }
    return text;
}

}  // namespace

TEST_CASE("a cloth that starts through or touching cloth is refused at the cloth, with both triangles") {
    const std::string flat = "[1, 0, 0, 0]", upright = "[0.7071067811865476, 0.7071067811865476, 0, 0]";
    CHECK(fault(two_flags("[0.05, 0.1, 0.02]", flat)) == "nothing was thrown");
    // Half of one is on each side of the other.
    CHECK(fault(two_flags("[0.05, 0.03, 0.02]", upright)).find("no way out was found; move them apart") != std::string::npos);
    const std::string refuse = "[step]\nstart = \"refuse\"\n";
    const std::string through = fault(refuse + two_flags("[0.05, 0.03, 0.02]", upright));
    CHECK(through.starts_with("t:6:1: flag starts through banner: "));
    CHECK(through.find(" intersecting triangle pairs, one of them triangle ") != std::string::npos);
    CHECK(through.find(" of flag and triangle ") != std::string::npos);
    CHECK(through.find(" of banner; move them apart") != std::string::npos);
    CHECK(fault(refuse + two_flags("[1, 0, 0]", flat)).starts_with("t:6:1: flag starts touching banner: triangle "));
    const std::string detector = "[step]\ndetector = \"none\"\n", scheme = "[step]\nscheme = \"rk4\"\ntime_step = 1e-4\n";
    CHECK(
        fault(detector + two_flags("[0.05, 0.1, 0.02]", flat)).starts_with("t:6:1: cloth 'flag': self_contact needs a detector"));
    CHECK(fault(scheme + two_flags("[0.05, 0.1, 0.02]", flat))
              .starts_with("t:2:10: step.scheme: an explicit scheme takes no self_contact"));
}

TEST_CASE("a cloth that starts through itself is refused at the cloth") {
    const test::TestFolder folder;
    // Two squares that cross, joined at one corner.
    const std::string crossing =
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0.2 -0.3 0.4\nv 0.9 0.5 0.4\nv 0.9 -0.5 0.3\nv -1 0 0\n"
        "f 1 2 3\nf 4 5 6\nf 1 7 4\n";
    const std::string file = mesh_scene(folder, crossing, "", "self_contact = true\nsprings = { structural = 100.0 }");
    const Override refuse{"step.start", "refuse"};
    const std::string message = error_of([&] { build_scene(load_scene(file, {&refuse, 1})); });
    CHECK(message.find(" starts through itself: 1 intersecting triangle pairs, one of them triangle 0 and triangle 1; ") !=
          std::string::npos);
}

TEST_CASE("an explicit scheme with obstacles is refused where the scheme is said") {
    const std::string text = "[step]\nscheme = \"rk4\"\ntime_step = 1e-4\n" + small_scene() + body("plane = {}");
    CHECK(fault(text).starts_with("t:2:10: step.scheme: an explicit scheme takes no obstacles"));
    const Override setting{"step.scheme", "rk4"};
    const Scene set = parse_scene(small_scene() + body("plane = {}"), "t", {&setting, 1});
    CHECK(error_of([&] { build_scene(set); }).starts_with("--set step.scheme: step.scheme: an explicit"));
}

TEST_CASE("a name is said once, in quotes") {
    const test::TestFolder folder;
    const std::string flat = "[[obstacle]]\nname = \"body\"\nmesh = \"flat.obj\"\npose = { translation = [0, -5, 0] }\n";
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const std::string file = mesh_scene(folder, square, flat);
    const std::string message = error_of([&] { build_scene(load_scene(file)); });
    CHECK(message.starts_with(file + ":7:1: 'body': the obstacle has no triangle"));
    CHECK(message.find("body", message.find("body") + 1) == std::string::npos);
    const std::string folded = mesh_scene(folder, "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0 1\nf 1 2 3\nf 2 1 4\n");
    CHECK(error_of([&] { build_scene(load_scene(folded)); }).starts_with(folded + ":3:1: 'flag': vertices 2 and 3 "));
}

TEST_CASE("every detector carries the same scene through the same states") {
    const std::string near =
        "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\npose = { translation = [0, -0.107, 0] }\n";
    const auto hash_with = [&](const std::string& detector) {
        const Override setting{"step.detector", detector};
        BuiltScene scene = build_scene(parse_scene(small_scene() + near, "t", {&setting, 1}));
        for (int i = 0; i < 3; ++i) {
            const StepReport report = scene.simulation.step();
            REQUIRE(report.ok());
            CHECK(report.contacts > 0);
        }
        return scene.simulation.state_hash();
    };
    const std::uint64_t expected = hash_with("brute_force");
    CHECK(hash_with("fcl") == expected);
    CHECK(hash_with("bullet") == expected);
}

TEST_CASE("a preset on a mesh is isotropic and says so, on a grid, or with moduli of its own, it is not touched") {
    const test::TestFolder folder;
    const BuiltScene on_mesh = build_scene(load_scene(mesh_scene(folder, square, "", "preset = \"denim_11oz\"")));
    REQUIRE(on_mesh.warnings.size() == 1);
    const Finding& warning = on_mesh.warnings.front();
    CHECK(warning.kind == "isotropic_fabric");
    CHECK(warning.place == place_text(on_mesh.scene.cloths[0].place));
    CHECK(
        warning.what.starts_with("cloth 'flag': its mesh does not say where warp is (key warp, or rest = \"uv\"); instead of "
                                 "stretch_stiffness = ["));
    const Fabric expected = isotropic(fabric_preset("denim_11oz"));
    CHECK(warning.what.find(number_text(expected.stretch_stiffness->front()) + " N/m in every direction") != std::string::npos);
    CHECK(plan_findings(on_mesh, plan_of(on_mesh)).front().what == warning.what);
    Simulation same({});
    same.add_cloth(on_mesh.cloth_meshes.front(), expected);
    BuiltScene other = build_scene(load_scene(folder.path("scene.toml")));
    REQUIRE(same.step().ok());
    REQUIRE(other.simulation.step().ok());
    CHECK(same.positions(ClothId{0})[2] == other.simulation.positions(other.cloths[0])[2]);

    CHECK(built("[fabric.f]\npreset = \"denim_11oz\"\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\ngrid = { size = [1, 1], vertices "
                "= [3, 3] "
                "}\n")
              .warnings.empty());
    const std::string own = mesh_scene(folder, square, "", "preset = \"denim_11oz\"\nstretch_stiffness = [50, 60]");
    CHECK(error_of([&] { build_scene(load_scene(own)); }).find("warp and weft differ") != std::string::npos);
}

TEST_CASE("an obstacle starts where its motion begins") {
    const std::string moving =
        "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n"
        "motion = [ { time = 0.5, translation = [0, -2, 0] }, { time = 1, translation = [0, -3, 0] } ]\n";
    const BuiltScene scene = built(small_scene() + moving);
    CHECK(scene.simulation.obstacle_pose(scene.obstacles[0]).translation == Vec3(0, -2, 0));
}

namespace {

/// Two cloths that meet cloth, and a third that does not.
std::string three_sheets() {
    const std::string fabric = "thickness = 0.004\nsprings = { structural = 100.0 }\n";
    std::string text = "duration = 0.1\n[fabric.f]\nself_contact = true\n" + fabric + "[fabric.g]\n" + fabric;
    for (const std::string name : {"a", "b", "c"})
        text += "[[cloth]]\nname = \"" + name + "\"\nfabric = \"" + (name == "c" ? "g" : "f") +
                "\"\ngrid = { size = [1.0, 1.0], vertices = [3, 3] }\npose = { translation = [0, 0." +
                std::to_string(name[0] - 'a') + ", 0] }\n";
    return text;
}

}  // namespace

TEST_CASE("pairs of cloths are set in the simulation, and those that say nothing are refused at their place") {
    const auto with = [](const std::string& keys) { return three_sheets() + "[[pair]]\n" + keys; };
    const BuiltScene apart = built(with("cloths = [\"b\", \"a\"]\ncontact = false\n"));
    CHECK_FALSE(apart.simulation.meets(apart.cloths[0], apart.cloths[1]));
    CHECK(apart.simulation.meets(apart.cloths[0], apart.cloths[0]));
    CHECK(built(with("cloths = [\"b\", \"a\"]\nthickness = 0.003\n")).simulation.meets({0}, {1}));
    const std::string first = "cloths = [\"a\", \"b\"]\ncontact = false\n";
    CHECK(fault(with(first + "[[pair]]\ncloths = [\"b\", \"a\"]\nthickness = 0.003\n")).find("are a pair above already") !=
          std::string::npos);
    CHECK(fault(with("cloths = [\"a\", \"b\"]\n")).find("alone says nothing") != std::string::npos);
    CHECK(fault(with(first + "thickness = 0.003\n")).find("without contact a thickness says nothing") != std::string::npos);
    const std::string none = fault(with("cloths = [\"a\", \"c\"]\ncontact = false\n"));
    CHECK(none.starts_with("t:"));
    CHECK(none.find("c meets no cloth, its fabric has self_contact = false") != std::string::npos);
}

TEST_CASE("a seam of a scene closes from its time on") {
    const std::string seam = "[[seam]]\ncloths = [\"a\", \"b\"]\nvertices = [[0, 0]]\nstart_time = 0.05\nduration = 0.05\n";
    BuiltScene scene = built(three_sheets() + seam + "[step]\ntime_step = 0.01\n");
    for (int n = 0; n < 4; ++n) REQUIRE(scene.simulation.step().ok());
    CHECK(scene.simulation.seam_gaps(scene.seams[0].id)[0] == Approx(0.1).epsilon(0.01));
    for (int n = 0; n < 6; ++n) REQUIRE(scene.simulation.step().ok());
    CHECK(scene.simulation.seam_gaps(scene.seams[0].id)[0] < 0.05);
}

TEST_CASE("a seam that should have closed and is open is reported with its width, one that closed or has time left is not") {
    const auto said = [](const std::string& stiffness, int steps) {
        const std::string seam = "[[seam]]\nname = \"side\"\ncloths = [\"a\", \"b\"]\nvertices = [[0, 0]]\nduration = 0.05\n";
        BuiltScene scene = built(three_sheets() + seam + "stiffness = " + stiffness + "\n[step]\ntime_step = 0.01\n");
        for (int n = 0; n < steps; ++n) REQUIRE(scene.simulation.step().ok());
        return seam_warnings(scene);
    };
    CHECK(said("1e4", 20).empty());
    CHECK(said("0.001", 3).empty());
    const std::vector<Finding> open = said("0.001", 20);
    REQUIRE(open.size() == 1);
    CHECK(open[0].kind == "unsewn");
    CHECK(open[0].what.find("not sewn: seam 'side' of 'a' is open by ") == 0);
    CHECK(open[0].what.find(" m at (") != std::string::npos);
}

TEST_CASE("panels that wait beside others being sewn add no iterations", "[slow]") {
    const auto iterations = [](const std::string& name) {
        BuiltScene scene = build_scene(load_scene(std::string(PERCALE_DATA_DIR) + "/scenes/" + name));
        int sum = 0;
        for (int n = 0; n < 8; ++n) {
            const StepReport report = scene.simulation.step();
            REQUIRE(report.ok());
            CHECK(report.contacts == 0);
            sum += report.newton_iterations;
        }
        return sum;
    };
    // The T-shirt's panels float until the trousers are on.
    CHECK(iterations("outfit.toml") <= 1.2 * iterations("trousers.toml"));
}

}  // namespace percale::scenes::test::scene_build_test
