#include "engine/step/teleport.h"

#include <array>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::teleport_test {

TEST_CASE("Friction releases bodies that do not come along") {
    World world = make_world(cloth_model(make_grid(1.0, 1.0, 3, 3), sheet_fabric()), make_grid(1.0, 1.0, 3, 3).vertices, {});
    world.scene.script.obstacles = {{"one", {}, {}}, {"two", {}, {}}};
    world.state.cloth.stick_anchors = {{0, 0, Vec3(1, 0, 0)}, {0, 1, Vec3(1, 0, 0)}};
    world.state.cloth.impacts = {{0, -1, 1.0}, {0, 1, 1.0}};
    world.scene.model.welds = {{Stitch{0, 1, 1, 0.0}, 1.0, Vec3(1, 0, 0)}};
    const Pose quarter{.rotation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0}};
    const std::array<int, 1> cloths{0}, obstacles{1};
    teleport(world, cloths, obstacles, quarter, true);
    REQUIRE(world.state.cloth.stick_anchors.size() == 1);
    CHECK(world.state.cloth.stick_anchors[0].obstacle == 1);
    CHECK((world.state.cloth.stick_anchors[0].stretch - Vec3(0, 0, -1)).norm() < 1e-15);
    CHECK((world.scene.model.welds[0].hold - Vec3(0, 0, -1)).norm() < 1e-15);
    REQUIRE(world.state.cloth.impacts.size() == 1);
    CHECK(world.state.cloth.impacts[0].obstacle == 1);
    CHECK(world.changed);
    teleport(world, {}, obstacles, quarter, true);  // only the obstacle
    CHECK(world.state.cloth.stick_anchors.empty());
}

}  // namespace percale::test::teleport_test
