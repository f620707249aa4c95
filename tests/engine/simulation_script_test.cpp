#include "percale/simulation.h"

#include <array>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::simulation_script_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Level planes that name every vertex in a fault.
class LevelDetector : public PlaneDetector {
public:
    int add_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction) override {
        heights_.push_back(pose.translation.y());
        return PlaneDetector::add_obstacle(mesh, pose, friction);
    }
    void move_obstacle(int obstacle, const Pose& start, const Pose& end) override {
        heights_[obstacle] = start.translation.y();
        PlaneDetector::move_obstacle(obstacle, start, end);
    }
    StartFault check_start(std::span<const Vec3> positions) override {
        StartFault fault = PlaneDetector::check_start(positions);
        for (std::size_t i = 0; fault.obstacle >= 0 && i < positions.size(); ++i) {
            if (positions[i].y() < heights_[fault.obstacle]) fault.inside_vertices.push_back(static_cast<int>(i));
        }
        return fault;
    }

private:
    std::vector<double> heights_;
};

/// A sheet 2 cm above a plane at y = 0.
struct PlaneScene {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;

    explicit PlaneScene(const StepSettings& settings = {},
                        std::unique_ptr<ContactDetector> detector = std::make_unique<PlaneDetector>())
        : simulation(settings, std::move(detector)) {
        cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0, 0.02, 0)}, "towel");
        plane = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    }
};

}  // namespace

TEST_CASE("Pinned vertices keep their place exactly while the rest moves, and fall when released") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0.1, 0.7, 0.3)});
    simulation.pin(cloth, 0);
    simulation.pin(cloth, 3);
    const std::vector<Vec3> start = copy(simulation.positions(cloth));
    for (int n = 0; n < 30; ++n) {
        REQUIRE(simulation.step().ok());
        for (const int pinned : {0, 3}) {
            REQUIRE(simulation.positions(cloth)[pinned] == start[pinned]);
            REQUIRE(simulation.velocities(cloth)[pinned] == Vec3::Zero());
        }
    }
    CHECK(simulation.positions(cloth)[15].y() < start[15].y() - 0.1);
    simulation.unpin(cloth, 0);
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(cloth)[0] != start[0]);
    CHECK(simulation.positions(cloth)[3] == start[3]);
}

TEST_CASE("A moved pin reaches its target exactly in every scheme, and stays there") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
        Simulation simulation({.time_step = 1e-4, .scheme = scheme});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
        simulation.pin(cloth, 5);
        for (int n = 1; n <= 10; ++n) {
            const Vec3 target = make_grid(0.5, 0.5, 4, 4).vertices[5] + Vec3(0.001, 0.0007, -0.0003) * n / 3.0;
            simulation.move_pin(cloth, 5, target);
            REQUIRE(simulation.step().ok());
            CHECK(simulation.positions(cloth)[5] == target);
        }
        const Vec3 last = simulation.positions(cloth)[5];
        REQUIRE(simulation.step().ok());
        CHECK(simulation.positions(cloth)[5] == last);
        CHECK(simulation.velocities(cloth)[5] == Vec3::Zero());
    }
}

TEST_CASE("Pinning twice, or a moving vertex, holds it where it is") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    for (int n = 0; n < 5; ++n) simulation.step();
    simulation.pin(cloth, 7);
    simulation.move_pin(cloth, 7, Vec3(9, 9, 9));
    simulation.pin(cloth, 7);  // removes the target
    const Vec3 held = simulation.positions(cloth)[7];
    CHECK(simulation.velocities(cloth)[7] == Vec3::Zero());
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(cloth)[7] == held);
}

TEST_CASE("A plane that moves up and sideways carries the cloth along and ends at its target") {
    PlaneScene scene({.measure = StepMeasures::all});
    for (int n = 0; n < 60; ++n) REQUIRE(scene.simulation.step().ok());  // at rest on the plane
    double before = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) before += x.x() / 16;
    for (int n = 1; n <= 60; ++n) {
        const Vec3 place(0.002 * n, 0.003 * n, 0.0);
        scene.simulation.move_obstacle(scene.plane, {.translation = place});
        const StepReport report = scene.simulation.step();
        REQUIRE(report.ok());
        CHECK(report.energy.work > 0.0);
        CHECK(scene.simulation.obstacle_pose(scene.plane).translation == place);
        for (const Vec3& x : scene.simulation.positions(scene.cloth)) REQUIRE(x.y() > place.y());
    }
    double after = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) after += x.x() / 16;
    // Friction 0.3 can give 3 m/s^2; the plane needs 0.12 m/s.
    CHECK(after - before == Approx(0.12).epsilon(0.05));
}

TEST_CASE("A pin dragged through the plane fails with names and leaves every bit") {
    PlaneScene scene;
    scene.simulation.pin(scene.cloth, 6);
    for (int n = 0; n < 5; ++n) REQUIRE(scene.simulation.step().ok());
    const std::vector<Vec3> positions = copy(scene.simulation.positions(scene.cloth));
    const std::vector<Vec3> velocities = copy(scene.simulation.velocities(scene.cloth));
    const std::uint64_t hash = scene.simulation.state_hash();
    const double time = scene.simulation.time();
    scene.simulation.move_pin(scene.cloth, 6, positions[6] - Vec3(0, 0.1, 0));
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.blocked_cloth == scene.cloth.index);
    CHECK(report.blocked_vertex == 6);
    CHECK(report.blocked_name == "towel");
    CHECK(mentions(report.explanation(), {"pin_blocked", "vertex 6", "cloth 0 (towel)", "obstacle 0 (floor)"}));
    CHECK(copy(scene.simulation.positions(scene.cloth)) == positions);
    CHECK(copy(scene.simulation.velocities(scene.cloth)) == velocities);
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.time() == time);
    scene.simulation.move_pin(scene.cloth, 6, positions[6] + Vec3(0, 0.001, 0));
    CHECK(scene.simulation.step().ok());
}

TEST_CASE("An obstacle that drives through held cloth fails and stays where it was") {
    PlaneScene scene;
    for (int i = 0; i < 16; ++i) scene.simulation.pin(scene.cloth, i);
    const std::uint64_t hash = scene.simulation.state_hash();
    scene.simulation.move_obstacle(scene.plane, {.translation = Vec3(0, 0.1, 0)});
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.obstacle_pose(scene.plane).translation == Vec3::Zero());
    scene.simulation.move_obstacle(scene.plane, {});
    CHECK(scene.simulation.step().ok());
}

TEST_CASE("The work of pins that carry a whole sheet is its gain of energy, in explicit schemes too") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        Simulation simulation({.time_step = 1e-3, .scheme = scheme, .measure = StepMeasures::all});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
        for (int i = 0; i < 9; ++i) simulation.pin(cloth, i);
        for (int n = 0; n < 3; ++n) {
            const double before = simulation.energy().total();
            for (int i = 0; i < 9; ++i)
                simulation.move_pin(cloth, i, simulation.positions(cloth)[i] + Vec3(0, 0.01 * (n + 1), 0));
            const StepReport report = simulation.step();
            CHECK(report.energy.work > 0.1);
            CHECK(report.energy.work == Approx(report.energy.total() - before).epsilon(1e-9));
        }
    }
}

TEST_CASE("Gravity and the time step may change during a run") {
    Simulation simulation(StepSettings{.newton_tolerance = 1e-10});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.set_gravity(Vec3(1.0, 0.0, 0.0));
    simulation.set_time_step(0.25);
    REQUIRE(simulation.step().ok());
    CHECK(simulation.time() == 0.25);
    CHECK((simulation.velocities(cloth)[4] - Vec3(0.25, 0, 0)).norm() < 1e-12);
}

TEST_CASE("Calls with wrong values are refused and change nothing") {
    PlaneScene scene;
    Simulation& s = scene.simulation;
    s.pin(scene.cloth, 4);
    const std::uint64_t hash = s.state_hash();
    const std::vector<Vec3> few(15, Vec3::Zero());
    std::vector<Vec3> bad(16, Vec3(1, 1, 1));
    bad[11].y() = nan_value;
    CHECK(mentions(scene_error([&] { s.unpin(scene.cloth, 3); }), {"towel", "unpin", "vertex 3", "not pinned"}));
    CHECK(mentions(scene_error([&] { s.move_pin(scene.cloth, 3, Vec3::Zero()); }),
                   {"towel", "move_pin", "vertex 3", "not pinned"}));
    CHECK(mentions(scene_error([&] { s.move_pin(scene.cloth, 4, bad[11]); }), {"towel", "vertex 4", "not finite"}));
    CHECK(mentions(scene_error([&] { s.move_obstacle(scene.plane, {.scale = 2.0}); }), {"floor", "scale"}));
    CHECK(mentions(scene_error([&] { s.move_obstacle(scene.plane, {.rotation = {0, 0, 0, 0}}); }), {"floor", "rotation"}));
    CHECK(mentions(scene_error([&] { s.set_gravity(bad[11]); }), {"set_gravity", "gravity"}));
    CHECK(mentions(scene_error([&] { s.set_time_step(-1.0); }), {"set_time_step", "time_step", "-1"}));
    CHECK(mentions(scene_error([&] { s.set_positions(scene.cloth, few); }), {"towel", "set_positions", "15", "16"}));
    CHECK(mentions(scene_error([&] { s.set_velocities(scene.cloth, few); }), {"towel", "set_velocities", "15", "16"}));
    CHECK(mentions(scene_error([&] { s.set_positions(scene.cloth, bad); }), {"towel", "position 11", "not finite"}));
    const std::vector<Vec3> far(16, Vec3(1, 1e200, 1));
    CHECK(mentions(scene_error([&] { s.set_positions(scene.cloth, far); }), {"towel", "position 0", "1e9"}));
    CHECK(mentions(scene_error([&] { s.set_velocities(scene.cloth, far); }), {"towel", "velocity 0", "1e9"}));
    CHECK(mentions(scene_error([&] { s.set_velocities(scene.cloth, bad); }), {"towel", "velocity 11", "not finite"}));
    const std::array cloths{scene.cloth}, wrong{ClothId{3}};
    CHECK(mentions(scene_error([&] { s.teleport(cloths, {}, {.scale = 2.0}); }), {"teleport", "scale = 2"}));
    CHECK(mentions(scene_error([&] { s.teleport(cloths, {}, {.rotation = {2, 0, 0, 0}}); }), {"teleport", "rotation"}));
    CHECK(mentions(scene_error([&] { s.teleport(wrong, {}, {.translation = Vec3(1, 0, 0)}); }), {"no cloth 3", "0 ... 0"}));
    CHECK(s.state_hash() == hash);
    CHECK(s.step().dt == 1.0 / 60.0);
}

TEST_CASE("Velocities set on pinned vertices are ignored") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.pin(cloth, 1);
    simulation.set_velocities(cloth, std::vector<Vec3>(9, Vec3(1, 2, 3)));
    CHECK(simulation.velocities(cloth)[1] == Vec3::Zero());
    CHECK(simulation.velocities(cloth)[2] == Vec3(1, 2, 3));
}

TEST_CASE("An obstacle or a pin that caused a refused start may be moved away") {
    for (const bool by_pin : {false, true}) {
        CAPTURE(by_pin);
        PlaneScene scene({.start = StartRule::refuse}, std::make_unique<LevelDetector>());
        Simulation& s = scene.simulation;
        s.pin(scene.cloth, 5);
        REQUIRE(s.step().ok());
        const Vec3 place = s.positions(scene.cloth)[5];
        const Pose above{.translation = Vec3(0, place.y() + 0.001, 0)};
        const ObstacleId shelf = s.add_obstacle(make_plane(1.0), above, {.name = "shelf"});
        for (int n = 0; n < 2; ++n) CHECK(mentions(scene_error([&] { s.step(); }), {"inside shelf"}));
        // Other obstacles wait for the next step.
        s.move_obstacle(scene.plane, {.translation = Vec3(0, -0.01, 0)});
        CHECK(s.obstacle_pose(scene.plane).translation == Vec3::Zero());
        s.move_obstacle(shelf, {.translation = Vec3(0, -1, 0)});
        if (by_pin) {
            s.move_obstacle(shelf, above);
            for (int i = 0; i < 16; ++i) s.pin(scene.cloth, i);
            CHECK_FALSE(scene_error([&] { s.step(); }).empty());
            const std::vector<Vec3> places = copy(s.positions(scene.cloth));
            for (int i = 0; i < 16; ++i) s.move_pin(scene.cloth, i, places[i] + Vec3(0, 0.1, 0));
            CHECK(s.positions(scene.cloth)[3] == places[3] + Vec3(0, 0.1, 0));
        } else {
            CHECK(s.obstacle_pose(shelf).translation.y() == -1.0);
        }
        CHECK(s.step().ok());
        // From here on it moves in the steps again.
        s.move_obstacle(shelf, {.translation = Vec3(0, -2, 0)});
        CHECK(s.obstacle_pose(shelf).translation.y() > -2.0);
    }
}

TEST_CASE("A restored state was not refused: obstacles move in steps again") {
    PlaneScene scene({.start = StartRule::refuse});
    Simulation& s = scene.simulation;
    const Pose far_below{.translation = Vec3(0, -1, 0)};
    const ObstacleId shelf = s.add_obstacle(make_plane(1.0), far_below, {.name = "shelf"});
    REQUIRE(s.step().ok());
    const std::vector<std::byte> saved = s.save();
    s.set_positions(scene.cloth, std::vector<Vec3>(16, Vec3(0, -3, 0)));
    CHECK_FALSE(scene_error([&] { s.step(); }).empty());
    s.restore(saved);
    s.move_obstacle(shelf, {.translation = Vec3(0, -2, 0)});
    CHECK(s.obstacle_pose(shelf).translation == far_below.translation);
    CHECK(s.step().ok());
    CHECK(s.obstacle_pose(shelf).translation.y() == -2.0);
}

TEST_CASE("A moved-from simulation reports so in every call, and may be assigned to") {
    PlaneScene scene;
    Simulation taken(std::move(scene.simulation));
    CHECK(mentions(scene_error([&] { scene.simulation.step(); }), {"moved from"}));
    CHECK(mentions(scene_error([&] { scene.simulation.set_gravity(Vec3::Zero()); }), {"moved from"}));
    CHECK(mentions(scene_error([&] { static_cast<void>(scene.simulation.positions(scene.cloth)); }), {"moved from"}));
    CHECK(taken.step().ok());
    scene.simulation = std::move(taken);
    CHECK(scene.simulation.step().ok());
}

}  // namespace percale::test::simulation_script_test
