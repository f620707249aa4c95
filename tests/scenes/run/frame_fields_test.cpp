#include "scenes/run/frame_fields.h"

#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::frame_fields_test {
namespace {

BuiltScene on_box(const std::string& fields) {
    const std::vector<Override> settings = {
        {"output.fields", fields}, {"output.frames", "\"ply\""}, {"duration", "1.0"}, {"fabric.sheet.spring_damping", "0.1"}};
    return build_scene(parse_scene(test::sheet_on_box(), "t", settings));
}

}  // namespace

TEST_CASE("frames carry the fields that a scene asks for, and the pressure on a box is the weight of the sheet on its area") {
    BuiltScene built = on_box("[\"pressure\", \"distance\"]");
    std::vector<Frame> frames;
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) { frames.push_back(frame); };
    REQUIRE(run_scene(built, hooks).status == RunStatus::finished);
    REQUIRE(frames.size() > 2);
    for (const Frame& frame : frames) {
        REQUIRE(frame.fields.size() == 1);
        REQUIRE(frame.fields[0].vertex.size() == 2);
    }
    CHECK(frames[0].fields[0].vertex[0].values[7] == 0.0);
    CHECK(frames[0].fields[0].vertex[1].values[7] == Approx(0.015));
    // 0.2 kg/m^2 press with 1.962 Pa.
    const auto fit = fit_now(built);
    REQUIRE(fit.size() == 1);
    REQUIRE(fit[0].size() == 2);
    CHECK(fit[0][0].first == "pressure");
    CHECK(fit[0][0].second.median == Approx(1.962).epsilon(0.01));
    CHECK(fit[0][1].second.largest < 0.006);
    double weight = 0.0;
    for (const double mass : built.simulation.masses(built.cloths[0])) weight += 9.81 * mass;
    CHECK(built.simulation.force_on(built.obstacles[0]).y() == Approx(-weight).epsilon(0.01));
}

TEST_CASE("a scene that asks for no fields has none") {
    BuiltScene built = on_box("[]");
    CHECK(fit_now(built).empty());
    CHECK(fields_of(built, built.cloth_meshes, built.obstacle_meshes).empty());
}

TEST_CASE("shapes are placed where the simulation has them") {
    BuiltScene built = on_box("[]");
    std::vector<TriangleMesh> cloths = built.cloth_meshes, obstacles = built.obstacle_meshes;
    const std::vector<Vec3> lifted(cloths[0].vertices.size(), Vec3(1, 2, 3));
    built.simulation.set_positions(built.cloths[0], lifted);
    place_shapes(built, cloths, obstacles);
    CHECK(cloths[0].vertices == lifted);
    CHECK(obstacles[0].vertices[0] == built.obstacle_meshes[0].vertices[0] - Vec3(0, 0.25, 0));
}

}  // namespace percale::scenes::test::frame_fields_test
