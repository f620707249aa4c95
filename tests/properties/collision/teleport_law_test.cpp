#include <algorithm>
#include <array>
#include <cmath>

#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::teleport_law_test {
namespace {

/// A towel that slides down a slope, held at a corner, beside a floor far below; a point of its edge is sewn to its other side.
struct Slope {
    Simulation simulation;
    ClothId cloth;
    ObstacleId slope, floor;
    std::array<ClothId, 1> cloths;
    std::array<ObstacleId, 1> obstacles;

    Slope() : simulation({}, make_fcl_detector()) {
        const Pose tilt{.rotation = {std::cos(0.2), 0.0, 0.0, std::sin(0.2)}};
        Pose above = tilt;
        above.translation = transform(tilt, Vec3(0, 0.006, 0));
        Pose slab = tilt;
        slab.translation = transform(tilt, Vec3(0, -0.5, 0));
        cloth = simulation.add_cloth(make_grid(0.5, 0.5, 5, 5), sheet_fabric(), above, "towel");
        slope = simulation.add_obstacle(make_box(Vec3(4, 1, 4)), slab, {.friction = 0.3, .name = "slope"});
        floor = simulation.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -5, 0)}, {.name = "floor"});
        cloths = {cloth};
        obstacles = {slope};
        simulation.pin(cloth, 2);
        simulation.add_seam(cloth, cloth, std::array{Stitch{20, 23, 24, 0.5}}, {.over = 0.5});
        for (int n = 0; n < 12; ++n) REQUIRE(simulation.step().ok());
    }
};

/// A rotation about the axis of gravity and a translation.
const Pose motion{.translation = Vec3(100.0, 2.0, -40.0), .rotation = {std::cos(0.7), 0.0, std::sin(0.7), 0.0}};

}  // namespace

TEST_CASE("After a teleport cloth continues as if it had always been there") {
    Slope stays, jumps;
    jumps.simulation.teleport(jumps.cloths, jumps.obstacles, motion);
    const auto difference = [&] {
        const std::vector<Vec3> expected = transform(motion, stays.simulation.positions(stays.cloth));
        double largest = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            largest = std::max(largest, (expected[i] - jumps.simulation.positions(jumps.cloth)[i]).norm());
        }
        return largest;
    };
    CHECK(difference() < 1e-12);
    CHECK((jumps.simulation.obstacle_pose(jumps.slope).translation -
           transform(motion, stays.simulation.obstacle_pose(stays.slope).translation))
              .norm() < 1e-12);
    CHECK(jumps.simulation.obstacle_pose(jumps.floor).translation == Vec3(0, -5, 0));
    for (int n = 0; n < 20; ++n) {
        REQUIRE(stays.simulation.step().ok());
        REQUIRE(jumps.simulation.step().ok());
    }
    CHECK(difference() < 1e-4);  // the solver's accuracy; without its stick anchors, or with its old velocities, 1e-2
    CHECK(stays.simulation.largest_speed() > 0.02);
}

TEST_CASE("A teleport clears velocities on request, and turns them otherwise") {
    Slope scene;
    const std::vector<Vec3> before = copy(scene.simulation.velocities(scene.cloth));
    scene.simulation.teleport(scene.cloths, scene.obstacles, motion);
    const Pose turn{.rotation = motion.rotation};
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK((scene.simulation.velocities(scene.cloth)[i] - transform(turn, before[i])).norm() < 1e-14);
    }
    scene.simulation.teleport(scene.cloths, {}, {}, TeleportVelocities::clear);
    CHECK(scene.simulation.largest_speed() == 0.0);
}

}  // namespace percale::test::teleport_law_test
