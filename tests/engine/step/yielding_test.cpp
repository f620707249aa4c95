#include "engine/step/yielding.h"

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::yielding_test {

TEST_CASE("The mesh of what yields knows vertices at one place, and its mean edge") {
    // Two triangles of edges 3, 4 and 5 that do not share vertices 1 and 4, at one place.
    const TriangleMesh mesh{.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {3, 4, 0}, {3, 0, 0}},
                            .triangles = {{0, 1, 2}, {4, 3, 2}}};
    const auto yielding = yielding_mesh(mesh);
    CHECK(yielding->place == std::vector<int>{0, 1, 2, 3, 1});
    CHECK(yielding->triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(yielding->edge == Approx(4.0));
}

TEST_CASE("The deepest dent is measured in the world, and scripts know whether anything yields") {
    Script script;
    script.obstacles.resize(2);
    CHECK_FALSE(any_yields(script));
    CHECK(deepest_dent(script) == 0.0);
    script.obstacles[1].yielding = std::make_shared<YieldingMesh>();
    script.obstacles[1].end.scale = 2.0;
    script.obstacles[1].dent = {{0, 0, 0}, {0.3, 0.4, 0}};
    CHECK(any_yields(script));
    CHECK(deepest_dent(script) == Approx(1.0));
}

TEST_CASE("A detector of rigid obstacles refuses one that yields by name") {
    Simulation simulation({}, std::make_unique<PlaneDetector>());
    CHECK_THROWS_AS(simulation.add_obstacle(make_plane(1.0), {}, {.yields = true}), SceneError);
}

}  // namespace percale::test::yielding_test
