#include "engine/start/start_repair.h"

#include <atomic>
#include <memory>

#include "engine/forces/springs.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::start_repair_test {
namespace {

/// Lifts vertices below the plane y = 0 to `height`, the others not.
class LiftingDetector : public PlaneDetector {
public:
    explicit LiftingDetector(double height) : height_(height) {}
    std::optional<Untangled> untangle(std::span<const Vec3> positions, std::span<const double>) override {
        if (height_ <= 0.0) return std::nullopt;
        Untangled out{{positions.begin(), positions.end()}, std::vector<int>(positions.size(), -1)};
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (positions[i].y() >= 0.0) continue;
            out.positions[i].y() = height_;
            out.obstacle[i] = 0;
        }
        return out;
    }

private:
    double height_;
};

struct Start {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;

    /// A sheet 1 cm above y = 0 but for two vertices, which are below it; the plane is at y = `floor`.
    explicit Start(double lift, double depth = 0.01, double floor = 0.0)
        : simulation({.time_step = 1.0 / 60.0}, std::make_unique<LiftingDetector>(lift)) {
        cloth = simulation.add_cloth(make_grid(0.3, 0.3, 5, 5), sheet_fabric(), {.translation = Vec3(0, 0.01, 0)}, "towel");
        plane = simulation.add_obstacle(make_plane(1), {.translation = Vec3(0, floor, 0)}, {.name = "floor"});
        std::vector<Vec3> x(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        x[6].y() = x[7].y() = -depth;
        simulation.set_positions(cloth, x);
    }
};

std::string refusal(Start& start) {
    try {
        start.simulation.prepare();
    } catch (const StartError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("Vertices that the detector frees are accepted and reported") {
    Start start(0.012);
    start.simulation.prepare();
    REQUIRE(start.simulation.start_repair().size() == 1);
    const StartMove& move = start.simulation.start_repair()[0];
    CHECK(move.cloth == 0);
    CHECK(move.obstacle == 0);
    CHECK(move.cloth_name == "towel");
    CHECK(move.obstacle_name == "floor");
    CHECK(move.vertices_moved == 2);
    CHECK(move.largest_move == Approx(0.022));
    CHECK(start.simulation.positions(start.cloth)[6].y() == 0.012);
    CHECK(start.simulation.time() == 0.0);
    CHECK(start.simulation.step().ok());
}

TEST_CASE("The resulting stretch is relaxed without gravity, motion or velocity") {
    Start start(0.1);  // 9 cm over 7.5 cm: stretched by more than half
    start.simulation.set_velocities(start.cloth, std::vector<Vec3>(25, Vec3(1, 0, 0)));
    start.simulation.move_obstacle(start.plane, {.translation = Vec3(0, -0.001, 0)});
    start.simulation.prepare();
    const auto x = start.simulation.positions(start.cloth);
    double longest = 0.0;
    for (const int other : {1, 5, 11}) longest = std::max(longest, (x[6] - x[other]).norm() / 0.075 - 1.0);
    CHECK(longest < 0.11);
    CHECK(start.simulation.start_repair()[0].vertices_moved > 2);
    CHECK(start.simulation.velocities(start.cloth)[6] == Vec3(1, 0, 0));
    CHECK(start.simulation.obstacle_pose(start.plane).translation == Vec3::Zero());
    CHECK(start.simulation.time() == 0.0);
    REQUIRE(start.simulation.step().ok());
    CHECK(start.simulation.obstacle_pose(start.plane).translation == Vec3(0, -0.001, 0));
    CHECK(start.simulation.time() == 1.0 / 60.0);
}

TEST_CASE("Resolving penetration that the caller cancels leaves the start as it was, for a later call") {
    Start start(0.012);
    const std::uint64_t before = start.simulation.state_hash();
    std::atomic<bool> cancel = true;
    start.simulation.set_cancel(&cancel);
    CHECK(refusal(start).find("its caller has cancelled the repair (set_cancel)") != std::string::npos);
    CHECK(start.simulation.state_hash() == before);
    cancel = false;
    CHECK(refusal(start).empty());
    CHECK(start.simulation.start_repair().size() == 1);
}

TEST_CASE("Where the detector finds no way, or a way stretches cloth that pins hold, the start is refused and stays") {
    Start none(0.0);
    const std::uint64_t before = none.simulation.state_hash();
    CHECK(refusal(none).find("the cloth starts inside floor: 2 vertices, one of them vertex 7 of towel, and no way out") == 0);
    CHECK(none.simulation.state_hash() == before);
    // All but two vertices are held at 1 cm, below a floor at 15 cm: those two can only be above it stretched to twice their
    // length.
    Start held(0.2, 0.01, 0.15);
    for (int v = 0; v < 25; ++v) {
        if (v != 6 && v != 7) held.simulation.pin(held.cloth, v);
    }
    const std::uint64_t held_before = held.simulation.state_hash();
    const double time = held.simulation.time();
    CHECK(refusal(held).find("stretches a spring by ") != std::string::npos);
    CHECK(held.simulation.state_hash() == held_before);
    CHECK(held.simulation.time() == time);
    CHECK(held.simulation.start_repair().empty());
}

TEST_CASE("A clear start has no penetration to resolve") {
    Start start(0.012, -0.02);
    const std::uint64_t before = start.simulation.state_hash();
    start.simulation.prepare();
    CHECK(start.simulation.start_repair().empty());
    CHECK(start.simulation.state_hash() == before);
}

}  // namespace percale::test::start_repair_test
