#include "scenes/format/scene_parts.h"

#include <limits>

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;

namespace {

const double infinity = std::numeric_limits<double>::infinity();

ClothSpec cloth(const std::string& text) { return read_cloth(parse_toml("name = \"flag\"\nfabric = \"f\"\n" + text, "t")); }
ObstacleSpec obstacle(const std::string& text) { return read_obstacle(parse_toml("name = \"body\"\n" + text, "t")); }
EventSpec event(const std::string& text) { return read_event(parse_toml("time = 1.5\n" + text, "t")); }
Expectation expectation(const std::string& text) { return read_expectations(parse_toml(text, "t")).at(0); }

const std::string grid = "grid = { size = [1.0, 2], vertices = [3, 4] }\n";

}  // namespace

TEST_CASE("a cloth is read with its grid, pose and pins") {
    const ClothSpec spec = cloth(grid + "pose = { translation = [1, 2, 3], rotation = [0, 1, 0, 0], scale = 2 }\npin = [4, 2]\n");
    CHECK(spec.name == "flag");
    CHECK(spec.fabric == "f");
    REQUIRE(spec.grid.has_value());
    CHECK(spec.grid->size == std::array{1.0, 2.0});
    CHECK(spec.grid->vertices == std::array{3, 4});
    CHECK(spec.mesh.empty());
    CHECK(spec.pose.translation == Vec3(1, 2, 3));
    CHECK(spec.pose.rotation.x == 1.0);
    CHECK(spec.pose.rotation.w == 0.0);
    CHECK(spec.pose.scale == 2.0);
    CHECK(std::get<VertexIndices>(spec.pin).vertices == std::vector<int>{4, 2});
}

TEST_CASE("a cloth without pins has none") { CHECK(std::get<VertexIndices>(cloth(grid).pin).vertices.empty()); }

TEST_CASE("pins may be a box or the boundary") {
    const ClothSpec boxed = cloth(grid + "pin = { box = [[0, 0, 0], [0.1, 1, 1]] }\n");
    CHECK(std::get<VertexBox>(boxed.pin).lowest == Vec3(0, 0, 0));
    CHECK(std::get<VertexBox>(boxed.pin).highest == Vec3(0.1, 1, 1));
    CHECK(std::holds_alternative<VertexBoundary>(cloth(grid + "pin = \"boundary\"\n").pin));
}

TEST_CASE("the unit of a mesh file is a factor to metres") {
    CHECK(cloth("mesh = \"a.obj\"\n").unit == 1.0);
    CHECK(cloth("mesh = \"a.obj\"\nunit = \"m\"\n").unit == 1.0);
    CHECK(cloth("mesh = \"a.obj\"\nunit = \"cm\"\n").unit == 0.01);
    CHECK(obstacle("mesh = \"a.obj\"\nunit = \"mm\"\n").unit == 0.001);
    CHECK(error_of([] { cloth(grid + "unit = \"cm\"\n"); }).find("unit is that of a mesh file") != std::string::npos);
    CHECK(error_of([] { obstacle("shape = { plane = {} }\nunit = \"cm\"\n"); }).find("unit is that") != std::string::npos);
}

TEST_CASE("a cloth is a grid or a mesh, not both, not neither") {
    CHECK(error_of([] { cloth(""); }).find("cloth 'flag' must have exactly one of grid, mesh; it has none") != std::string::npos);
    CHECK(error_of([] { cloth(grid + "mesh = \"a.obj\"\n"); }).find("it has grid, mesh") != std::string::npos);
}

TEST_CASE("names that cannot be file names or parts of a key are refused") {
    const auto fault = [](const std::string& name) {
        return error_of([&] { read_cloth(parse_toml("name = \"" + name + "\"\nfabric = \"f\"\n" + grid, "t")); });
    };
    CHECK(fault("poncho_2-left") == "nothing was thrown");
    CHECK(fault("\u00dcberwurf") == "nothing was thrown");
    for (const char* bad : {"", "0", "2nd", "../up", "a/b", "a b", "a.b", ".a", "a\\\\b", "a\\nb"}) {
        CAPTURE(bad);
        CHECK(fault(bad).starts_with("t:1:8: cloth.name = "));
    }
}

TEST_CASE("every shape is read") {
    CHECK(std::get<SphereShape>(obstacle("shape = { sphere = { radius = 0.25 } }\n").shape).radius == 0.25);
    CHECK(std::get<BoxShape>(obstacle("shape = { box = { size = [1, 2, 3] } }\n").shape).size == Vec3(1, 2, 3));
    const auto capsule = std::get<CapsuleShape>(obstacle("shape = { capsule = { radius = 0.1, height = 0.5 } }\n").shape);
    CHECK(capsule.radius == 0.1);
    CHECK(capsule.height == 0.5);
    const auto cylinder = std::get<CylinderShape>(obstacle("shape = { cylinder = { radius = 0.2, height = 0.6 } }\n").shape);
    CHECK(cylinder.radius == 0.2);
    CHECK(cylinder.height == 0.6);
    CHECK(std::get<PlaneShape>(obstacle("shape = { plane = {} }\n").shape).half_size == PlaneShape{}.half_size);
    CHECK(std::get<PlaneShape>(obstacle("shape = { plane = { half_size = 2 } }\n").shape).half_size == 2.0);
    CHECK(std::holds_alternative<std::monostate>(obstacle("mesh = \"a.obj\"\n").shape));
}

TEST_CASE("an obstacle is one shape or a mesh") {
    CHECK(error_of([] { obstacle(""); }).find("obstacle 'body' must have exactly one of mesh, shape") != std::string::npos);
    CHECK(error_of([] { obstacle("shape = {}\n"); }).find("shape must have exactly one of sphere, box") != std::string::npos);
    CHECK(error_of([] { obstacle("shape = { plane = {}, sphere = { radius = 1 } }\n"); }).find("it has sphere, plane") !=
          std::string::npos);
}

TEST_CASE("keyframes keep what they do not say apart from what they say") {
    const ObstacleSpec spec = obstacle(
        "mesh = \"a.obj\"\nmotion = [ { time = 0 }, { time = 1, translation = [1, 0, 0] }, { time = 2, rotation = [0, 0, 1, 0] } "
        "]\n");
    REQUIRE(spec.motion.size() == 3);
    CHECK_FALSE(spec.motion[0].translation.has_value());
    CHECK(spec.motion[1].translation == Vec3(1, 0, 0));
    CHECK_FALSE(spec.motion[1].rotation.has_value());
    CHECK(spec.motion[2].rotation->y == 1.0);
    CHECK(spec.motion[2].time == 2.0);
}

TEST_CASE("keyframes must ascend and there must be one") {
    CHECK(error_of([] {
              obstacle("mesh = \"a\"\nmotion = [ { time = 1 }, { time = 1 } ]\n");
          }).find("motion must ascend in time; 1 s follows 1 s") != std::string::npos);
    CHECK(error_of([] { obstacle("mesh = \"a\"\nmotion = []\n"); }).find("at least one keyframe") != std::string::npos);
}

TEST_CASE("a spin has a unit axis") {
    const Spin spin = *obstacle("mesh = \"a\"\nspin = { axis = [0, 0, -4], turns_per_s = 0.5, from = 1 }\n").spin;
    CHECK(spin.axis == Vec3(0, 0, -1));
    CHECK(spin.turns_per_s == 0.5);
    CHECK(spin.from == 1.0);
    CHECK(obstacle("mesh = \"a\"\nspin = { turns_per_s = 0.5 }\n").spin->axis == Vec3(0, 1, 0));
    CHECK(error_of([] { obstacle("mesh = \"a\"\nspin = { axis = [0, 0, 0], turns_per_s = 1 }\n"); }).find("must not be zero") !=
          std::string::npos);
}

TEST_CASE("every kind of event is read") {
    const EventSpec pin = event("pin = { cloth = \"flag\", vertices = [1] }\n");
    CHECK(pin.time == 1.5);
    CHECK(std::get<PinEvent>(pin.what).cloth == "flag");
    CHECK(std::get<VertexIndices>(std::get<PinEvent>(pin.what).vertices).vertices == std::vector<int>{1});
    const EventSpec unpin = event("unpin = { cloth = \"flag\", vertices = \"boundary\" }\n");
    CHECK(std::holds_alternative<VertexBoundary>(std::get<UnpinEvent>(unpin.what).vertices));
    const EventSpec move = event("move = { cloth = \"flag\", vertices = [1], to = [0, 1, 0], over = 0.5 }\n");
    CHECK(std::get<MoveEvent>(move.what).to == Vec3(0, 1, 0));
    CHECK(std::get<MoveEvent>(move.what).over == 0.5);
    CHECK(std::get<GravityEvent>(event("gravity = [0, 1, 0]\n").what).gravity == Vec3(0, 1, 0));
}

TEST_CASE("an event is one thing") {
    CHECK(error_of([] { event(""); }).find("event must have exactly one of pin, unpin, move, gravity, wind; it has none") !=
          std::string::npos);
    CHECK(error_of([] {
              event("gravity = [0, 0, 0]\npin = { cloth = \"flag\", vertices = [1] }\n");
          }).find("it has pin, gravity") != std::string::npos);
}

TEST_CASE("the forms of an expectation become limits") {
    const Expectation equal = expectation("intersections = 0\n");
    CHECK(equal.measure == "intersections");
    CHECK(equal.lowest == 0.0);
    CHECK(equal.highest == 0.0);
    CHECK((equal.lowest_included && equal.highest_included));
    const Expectation below = expectation("largest_strain = { below = 0.3 }\n");
    CHECK(below.lowest == -infinity);
    CHECK(below.highest == 0.3);
    CHECK_FALSE(below.highest_included);
    const Expectation above = expectation("smallest_distance = { above = 0.1 }\n");
    CHECK(above.lowest == 0.1);
    CHECK_FALSE(above.lowest_included);
    CHECK(above.highest == infinity);
    CHECK(above.highest_included);
    const Expectation between = expectation("lowest_vertex = { between = [0.1, 0.2] }\n");
    CHECK(between.lowest == 0.1);
    CHECK(between.highest == 0.2);
    CHECK((between.lowest_included && between.highest_included));
    const Expectation matches = expectation("matches = { file = \"a.obj\", within = 1e-3 }\n");
    CHECK(matches.file == "a.obj");
    CHECK(matches.highest == 1e-3);
    CHECK(matches.highest_included);
}

TEST_CASE("expectations keep the order of the file and know their places") {
    const auto list = read_expectations(parse_toml("speed_at_end = 0\nintersections = 0\n", "t"));
    REQUIRE(list.size() == 2);
    CHECK(list[0].measure == "speed_at_end");
    CHECK(list[1].measure == "intersections");
    CHECK(list[1].place.line == 2);
}
