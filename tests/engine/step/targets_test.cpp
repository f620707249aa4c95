#include "engine/step/scripted_motion.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {
namespace {

World sheet_world() {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {});
    world.before = world.state;
    return world;
}

/// A detector that remembers where it was told obstacles are.
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

TEST_CASE("Pins move only if a target differs from where the pinned vertex is") {
    World world = sheet_world();
    set_targets(world);
    CHECK_FALSE(world.plan.pins_move);
    world.script.pin_targets.set(4, Vec3(0, 1, 0));  // not pinned
    set_targets(world);
    CHECK_FALSE(world.plan.pins_move);
    world.script.free[4] = 0.0;
    world.plan_outdated = true;
    set_targets(world);
    CHECK(world.plan.pins_move);
}

TEST_CASE("The detector is told both ends of a moving obstacle's way, and once where it stays") {
    World world = sheet_world();
    auto detector = std::make_unique<MotionRecord>();
    MotionRecord& record = *detector;
    world.detector = std::move(detector);
    for (int k = 0; k < 2; ++k) {
        record.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -k - 1, 0)}, 0.3);
        world.script.obstacles.push_back({"plane", {.translation = Vec3(0, -k - 1, 0)}, {.translation = Vec3(0, -k - 1, 0)}});
    }
    set_targets(world);
    CHECK(world.plan.contacts);
    CHECK_FALSE(world.plan.obstacles_move);
    CHECK(record.moves.empty());  // it knows where they are
    world.script.obstacles[1].end.translation = Vec3(0, -1.5, 0);
    set_targets(world);
    CHECK(world.plan.obstacles_move);
    REQUIRE(record.moves.size() == 1);
    CHECK(record.moves[0].obstacle == 1);
    CHECK(record.moves[0].start == Vec3(0, -2, 0));
    CHECK(record.moves[0].end == Vec3(0, -1.5, 0));
    finish_motion(world);
    for (int n = 0; n < 2; ++n) set_targets(world);  // told once that it stays
    CHECK_FALSE(world.plan.obstacles_move);
    REQUIRE(record.moves.size() == 2);
    CHECK(record.moves[1].start == Vec3(0, -1.5, 0));
    CHECK(record.moves[1].end == Vec3(0, -1.5, 0));
    world.settings.skip = false;
    world.plan_outdated = true;
    set_targets(world);
    CHECK(record.moves.size() == 4);  // nothing is skipped: both are told
}

TEST_CASE("An obstacle that only turns is on the move too") {
    World world = sheet_world();
    world.detector = std::make_unique<PlaneDetector>();
    world.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.script.obstacles.push_back({"plane", {}, {.translation = Vec3::Zero(), .rotation = {0.6, 0.0, 0.8, 0.0}}});
    set_targets(world);
    CHECK(world.plan.obstacles_move);
}

TEST_CASE("Pins go along the straight line and arrive exactly") {
    World world = sheet_world();
    const Vec3 target(0.1, 0.7, 0.3), start = world.state.positions.at(5);
    world.script.free[5] = 0.0;
    world.script.pin_targets.set(5, target);
    for (const double fraction : {0.25, 0.5}) {
        set_part_targets(world, fraction);
        CHECK((world.part_targets.at(5) - (start + fraction * (target - start))).norm() < 1e-15);
    }
    set_part_targets(world, 1.0);
    CHECK(world.part_targets.at(5) == target);
}

}  // namespace percale::test
