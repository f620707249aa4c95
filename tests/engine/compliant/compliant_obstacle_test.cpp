#include "engine/compliant/compliant_obstacle.h"

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::compliant_obstacle_test {

TEST_CASE("The mesh of a compliant obstacle has the vertices at one place, and its mean edge") {
    // Two triangles of edges 3, 4 and 5 that do not share vertices 1 and 4, at one place.
    const TriangleMesh mesh{.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {3, 4, 0}, {3, 0, 0}},
                            .triangles = {{0, 1, 2}, {4, 3, 2}}};
    const auto compliant = compliant_mesh(mesh);
    CHECK(compliant->place == std::vector<int>{0, 1, 2, 3, 1});
    CHECK(compliant->triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(compliant->edge == Approx(4.0));
}

TEST_CASE("The largest deflection is measured in the world, and scripts report whether any obstacle is compliant") {
    Script script;
    script.obstacles.resize(2);
    CHECK_FALSE(any_compliant(script));
    CHECK(largest_deflection(script) == 0.0);
    script.obstacles[1].compliance.mesh = std::make_shared<CompliantMesh>();
    script.obstacles[1].end.scale = 2.0;
    script.obstacles[1].compliance.deflection = {{0, 0, 0}, {0.3, 0.4, 0}};
    CHECK(any_compliant(script));
    CHECK(largest_deflection(script) == Approx(1.0));
}

TEST_CASE("A detector of rigid obstacles refuses a compliant one by name") {
    Simulation simulation({}, std::make_unique<PlaneDetector>());
    CHECK_THROWS_AS(simulation.add_obstacle(make_plane(1.0), {}, {.yields = true}), SceneError);
}

}  // namespace percale::test::compliant_obstacle_test
