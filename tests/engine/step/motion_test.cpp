#include "engine/step/motion.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::motion_test {
namespace {

World sheet_world() {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {});
}

/// A detector that records the poses passed to it.
class MotionRecord : public PlaneDetector {
public:
    void move_obstacle(int obstacle, const Pose& start, const Pose& end) override {
        PlaneDetector::move_obstacle(obstacle, start, end);
        moves.push_back({obstacle, start.translation, end.translation});
    }
    struct Move {
        int obstacle;
        Vec3 start, end;
    };
    std::vector<Move> moves;
};

}  // namespace

TEST_CASE("The detector receives both ends of a moving obstacle's path, and only once where it stays") {
    World world = sheet_world();
    auto detector = std::make_unique<MotionRecord>();
    MotionRecord& record = *detector;
    world.scene.detector = std::move(detector);
    for (int k = 0; k < 2; ++k) {
        record.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -k - 1, 0)}, 0.3);
        world.scene.script.obstacles.push_back(
            {"plane", {.translation = Vec3(0, -k - 1, 0)}, {.translation = Vec3(0, -k - 1, 0)}});
    }
    plan_step(world);
    CHECK(world.scene.plan.contacts);
    CHECK_FALSE(world.scene.plan.obstacles_move);
    CHECK(record.moves.empty());  // the detector knows the poses
    world.scene.script.obstacles[1].end.translation = Vec3(0, -1.5, 0);
    plan_step(world);
    CHECK(world.scene.plan.obstacles_move);
    REQUIRE(record.moves.size() == 1);
    CHECK(record.moves[0].obstacle == 1);
    CHECK(record.moves[0].start == Vec3(0, -2, 0));
    CHECK(record.moves[0].end == Vec3(0, -1.5, 0));
    finish_motion(world.scene);
    for (int n = 0; n < 2; ++n) plan_step(world);  // passed once
    CHECK_FALSE(world.scene.plan.obstacles_move);
    REQUIRE(record.moves.size() == 2);
    CHECK(record.moves[1].start == Vec3(0, -1.5, 0));
    CHECK(record.moves[1].end == Vec3(0, -1.5, 0));
    world.scene.settings.skip = false;
    plan_step(world);
    CHECK(record.moves.size() == 4);  // nothing is skipped: both are passed
}

TEST_CASE("An obstacle that only turns counts as moving, too") {
    World world = sheet_world();
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {.translation = Vec3::Zero(), .rotation = {0.6, 0.0, 0.8, 0.0}}});
    plan_step(world);
    CHECK(world.scene.plan.obstacles_move);
}

TEST_CASE("Parts are limited to turns of 15 degrees, and to 20 thicknesses beside cloth that an obstacle may meet") {
    World world = sheet_world();  // 1 m wide, 5 mm thick
    world.scene.detector = std::make_unique<PlaneDetector>();
    ObstacleState ball;
    ball.reach = 0.1;
    ball.start.translation = ball.end.translation = Vec3(0.0, 0.2, 0.0);
    const auto parts_to = [&](const Pose& end) {
        ball.end = end;
        world.scene.script.obstacles = {ball};
        return motion_parts(world.scene, world.state.cloth);
    };
    CHECK(parts_to(ball.start).count == 1);
    CHECK(parts_to({.translation = Vec3(0.09, 0.2, 0.0)}).count == 1);
    const MotionParts passing = parts_to({.translation = Vec3(0.0, -0.8, 0.0)});
    CHECK(passing.count == 10);
    CHECK(passing.obstacle == 0);
    CHECK(passing.travel == Approx(1.0));
    CHECK(parts_to({.translation = Vec3(0.0, 5.2, 0.0)}).count == 1);  // it leaves a place where it meets nothing
    CHECK(parts_to({.translation = Vec3(0.0, -0.2, 0.0), .rotation = {0.0, 1.0, 0.0, 0.0}}).count == 12);
    CHECK(parts_to({.translation = Vec3(0.0, -1e6, 0.0)}).count > 64);
    // Cloth that moves along is passed slowly; cloth that falls past a body that hardly moves needs no parts.
    for (int i = 0; i < 9; ++i) world.state.cloth.velocities.set(i, Vec3(0.0, -60.0, 0.0));
    CHECK(parts_to({.translation = Vec3(0.0, -0.8, 0.0)}).count == 1);
    CHECK(parts_to({.translation = Vec3(0.0, 0.199, 0.0)}).count == 1);
}

}  // namespace percale::test::motion_test
