#include "scenes/run/start_fault.h"

#include "scenes/format/scene_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::scenes::test::start_fault_test {

TEST_CASE("the triangles concerned are those that cross and those with a corner inside, with corners of their own") {
    const std::vector<TriangleMesh> cloths{make_grid(1, 1, 9, 9), percale::test::moved(make_grid(1, 1, 3, 3), {0, 5, 0})};
    const TriangleMesh picture = offending_triangles(cloths, make_sphere(0.3, 2));
    CHECK(picture.vertices.size() == 3 * picture.triangles.size());
    CHECK(picture.triangles.size() > 20);
    for (const Vec3& x : picture.vertices) CHECK(x.y() < 0.4);
    CHECK(offending_triangles(cloths, make_sphere(0.01, 1)).triangles.size() < 40);
    CHECK(offending_triangles({}, make_sphere(0.3, 2)).triangles.empty());
}

TEST_CASE("a move is reported in one line") {
    const StartMove move{
        .cloth = 0, .obstacle = 0, .cloth_name = "sheet", .obstacle_name = "ball", .vertices_moved = 12, .largest_move = 0.0213};
    CHECK(start_move_text(move) == "12 vertices of sheet moved out of ball before the start, the farthest by 0.0213 m");
}

TEST_CASE("a refused start holds its place and the triangles concerned") {
    std::string text = percale::scenes::test::sheet_on_box();
    text.replace(text.find("0.015"), 5, "-0.01");
    const Override refuse{"step.start", "refuse"};
    try {
        build_scene(parse_scene(text, "t", {&refuse, 1}));
        FAIL("nothing was thrown");
    } catch (const StartRefused& refused) {
        CHECK(std::string(refused.what()).find("t:15:1: the cloth starts inside box: 36 vertices") == 0);
        CHECK(refused.place().line == 15);
        CHECK(refused.triangles().triangles.size() == 50);
    }
    const BuiltScene built = build_scene(parse_scene(text, "t"));
    REQUIRE(built.simulation.start_repair().size() == 1);
    CHECK(built.simulation.start_repair()[0].vertices_moved == 36);
    CHECK(built.simulation.start_repair()[0].largest_move == Approx(0.015).margin(0.01));
}

}  // namespace percale::scenes::test::start_fault_test
