#include "scenes/format/body_tables.h"

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::body_tables_test {
namespace {

ClothSpec cloth(const std::string& text) {
    return read_spec(parse_toml("name = \"flag\"\nfabric = \"f\"\n" + text, "t"), cloth_table());
}
ObstacleSpec obstacle(const std::string& text) {
    return read_spec(parse_toml("name = \"body\"\n" + text, "t"), obstacle_table());
}

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
    CHECK(std::get<VertexBox>(boxed.pin).to.empty());
    CHECK(std::get<VertexBox>(cloth(grid + "pin = { box = [[0, 0, 0], [1, 1, 1]], to = \"ball\" }\n").pin).to == "ball");
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
    CHECK(error_of([] { cloth(""); }).find("cloth 'flag' must have exactly one of grid, mesh, pattern; it has none") !=
          std::string::npos);
    CHECK(error_of([] { cloth(grid + "mesh = \"a.obj\"\n"); }).find("it has grid, mesh") != std::string::npos);
}

TEST_CASE("names that cannot be file names or parts of a key are refused") {
    const auto fault = [](const std::string& name) {
        return error_of([&] { read_spec(parse_toml("name = \"" + name + "\"\nfabric = \"f\"\n" + grid, "t"), cloth_table()); });
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

TEST_CASE("a selection of vertices is written as it is read") {
    const auto again = [](const VertexSelection& selection) {
        VertexSelection read;
        read_value(value_node(selection), read);
        return read;
    };
    CHECK(std::get<VertexIndices>(again(VertexIndices{{4, 2}})).vertices == std::vector<int>{4, 2});
    const auto box = std::get<VertexBox>(again(VertexBox{Vec3(0, 0.1, 0), Vec3(1, 2, 1)}));
    CHECK(box.lowest == Vec3(0, 0.1, 0));
    CHECK(box.highest == Vec3(1, 2, 1));
    CHECK(std::get<VertexBox>(again(VertexBox{Vec3::Zero(), Vec3::Ones(), "ball"})).to == "ball");
    CHECK(std::holds_alternative<VertexBoundary>(again(VertexBoundary{})));
}

}  // namespace percale::scenes::test::body_tables_test
