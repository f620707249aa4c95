#include "percale/simulation.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <tuple>

#include "tests/support/catch.h"
#include "tests/support/slope_scene.h"

namespace percale::test::simulation_changes_test {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A detector without its optional functions.
class StubbornDetector : public PlaneDetector {
public:
    void set_friction(int obstacle, double friction) override { ContactDetector::set_friction(obstacle, friction); }
};

}  // namespace

TEST_CASE("Friction changed during a run acts from the next step on: sliding cloth sticks, and slides again") {
    SlopeScene scene(0.0);
    scene.run(10);
    const double speed = scene.mean(scene.simulation.velocities(scene.cloth)).norm();
    CHECK(speed == Approx(10.0 / 60.0 * 9.81 * 0.6).epsilon(0.01));  // g sin
    scene.simulation.set_friction(scene.plane, 5.0);
    scene.run(60);
    const Vec3 held = scene.mean(scene.simulation.positions(scene.cloth));
    scene.run(30);
    CHECK((scene.mean(scene.simulation.positions(scene.cloth)) - held).norm() < 1e-5);
    scene.simulation.set_friction(scene.plane, 0.25);
    scene.run(30);
    // g (sin - mu cos) = 0.4 g for half a second.
    CHECK(scene.mean(scene.simulation.velocities(scene.cloth)).norm() == Approx(0.5 * 9.81 * 0.4).epsilon(0.02));
}

TEST_CASE("Friction and restitution set before the first step are those with which an obstacle is added") {
    SlopeScene set(0.0, true, 0.0, 0.1), added(0.6, true, 0.8, 0.1);
    set.simulation.set_friction(set.plane, 0.6);
    set.simulation.set_restitution(set.plane, 0.8);
    for (int n = 0; n < 60; ++n) {
        REQUIRE(set.simulation.step().ok());
        REQUIRE(added.simulation.step().ok());
        REQUIRE(set.simulation.state_hash() == added.simulation.state_hash());
    }
}

TEST_CASE("Restitution changed during a run: cloth that fell without a rebound bounces") {
    for (const double restitution : {0.0, 0.5}) {
        SlopeScene scene(0.0, false, 0.9, 0.1);
        scene.run(2);
        scene.simulation.set_restitution(scene.plane, restitution);
        double fastest = 0.0, fall = 0.0;
        for (int n = 0; n < 20; ++n) {
            scene.run(1);
            fastest = std::max(fastest, scene.mean(scene.simulation.velocities(scene.cloth)).y());
            fall = std::max(fall, -scene.mean(scene.simulation.velocities(scene.cloth)).y());
        }
        CAPTURE(restitution, fastest, fall);
        CHECK(fastest >= restitution * fall - 0.25);
        CHECK(fastest <= restitution * (fall + 9.81 / 60.0) + 0.02);  // it continued to fall within the step of the impact
    }
}

TEST_CASE("Changing friction or restitution wakes cloth at rest, unless the value stays the same") {
    SlopeScene scene(5.0);
    while (!scene.simulation.step().slept) REQUIRE(scene.simulation.time() < 20.0);
    scene.simulation.set_friction(scene.plane, 5.0);
    scene.simulation.set_restitution(scene.plane, 0.0);
    CHECK(scene.simulation.step().slept);
    scene.simulation.set_friction(scene.plane, 0.0);
    CHECK_FALSE(scene.simulation.step().slept);
    scene.run(30);
    CHECK(scene.mean(scene.simulation.velocities(scene.cloth)).x() > 1.0);
}

TEST_CASE("Friction and restitution out of range, or of no obstacle, are refused and change nothing") {
    SlopeScene scene(0.3);
    scene.run(5);
    Simulation& s = scene.simulation;
    for (const double wrong : {-0.1, 10.1, not_a_number}) {
        check_refused(s, [&] { s.set_friction(scene.plane, wrong); }, {"floor", "friction", "0 ... 10"});
    }
    for (const double wrong : {-0.1, 1.1, not_a_number}) {
        check_refused(s, [&] { s.set_restitution(scene.plane, wrong); }, {"floor", "restitution", "0 ... 1"});
    }
    check_refused(s, [&] { s.set_friction({1}, 0.5); }, {"no obstacle 1"});
    check_refused(s, [&] { s.set_restitution({-1}, 0.5); }, {"no obstacle -1"});
}

TEST_CASE("A detector that cannot change friction reports so, naming the obstacle") {
    SlopeScene scene(0.3, true, 0.0, 0.0045, std::make_unique<StubbornDetector>());
    check_refused(scene.simulation, [&] { scene.simulation.set_friction(scene.plane, 0.5); },
                  {"floor", "cannot change the friction"});
    scene.simulation.set_friction(scene.plane, 0.3);  // its present value
    scene.run(1);
}

TEST_CASE("A cloth that was reset makes the steps of one that was just added, in every bit") {
    for (const bool slope : {false, true}) {
        SlopeScene used(0.4, slope, 0.3, 0.1), fresh(0.4, slope, 0.3, 0.1);
        used.run(45);
        used.simulation.reset(used.cloth);
        CHECK(copy(used.simulation.positions(used.cloth)) == copy(fresh.simulation.positions(fresh.cloth)));
        CHECK(used.simulation.largest_speed() == 0.0);
        CHECK(used.simulation.contact_loads(used.cloth).empty());
        for (int n = 0; n < 45; ++n) {
            used.run(1);
            fresh.run(1);
            REQUIRE(used.simulation.state_hash() == fresh.simulation.state_hash());
        }
    }
}

TEST_CASE("Reset takes pins and holds along, and leaves other cloth alone") {
    Simulation simulation(StepSettings{});
    Fabric limited = free_fabric();
    limited.springs.structural = 20.0;
    limited.strain_limit = 0.01;
    TriangleMesh mesh = make_grid(0.3, 0.3, 5, 5);
    mesh.grid_columns = mesh.grid_rows = 0;
    const ClothId hung = simulation.add_cloth(mesh, limited, {.translation = Vec3(1, 0, 0)}, "hung");
    const ClothId other = simulation.add_cloth(mesh, limited, {.translation = Vec3(2, 0, 0)}, "other");
    const std::vector<Vec3> start = copy(simulation.positions(hung));
    for (const ClothId cloth : {hung, other}) simulation.pin(cloth, 0);
    const double stored = simulation.energy().elastic;
    for (int n = 1; n <= 30; ++n) {
        simulation.move_pin(hung, 0, start[0] + Vec3(0, 0.01 * n, 0));
        REQUIRE(simulation.step().ok());
    }
    const std::vector<Vec3> others = copy(simulation.positions(other));
    simulation.reset(hung);
    CHECK(copy(simulation.positions(hung)) == start);
    CHECK(copy(simulation.positions(other)) == others);
    simulation.reset(other);
    CHECK(simulation.energy().elastic == Approx(stored).margin(1e-12));  // no hold is left
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(hung)[0] == start[0]);
    CHECK_THROWS_AS(simulation.reset({2}), SceneError);
}

TEST_CASE("Interpolation needs positions to be kept, a fraction in range and room for each vertex") {
    SlopeScene scene(0.3);
    Simulation& s = scene.simulation;
    std::vector<Vec3> out(16), small(15);
    check_refused(s, [&] { s.interpolate(0.5, scene.cloth, out); }, {"towel", "keep_previous_positions"});
    s.keep_previous_positions();
    scene.run(1);
    for (const double wrong : {-0.01, 1.01, not_a_number}) {
        check_refused(s, [&] { s.interpolate(wrong, scene.cloth, out); }, {"towel", "fraction", "0 ... 1"});
    }
    check_refused(s, [&] { s.interpolate(0.5, scene.cloth, small); }, {"towel", "15", "16 vertices"});
    check_refused(s, [&] { s.interpolate(0.5, {1}, out); }, {"no cloth 1"});
    s.keep_previous_positions(false);
    check_refused(s, [&] { s.interpolate(0.5, scene.cloth, out); }, {"keep_previous_positions"});
}

TEST_CASE("The id of a cloth that was removed is refused by every call, and nothing changes") {
    SlopeScene scene(0.3);
    Simulation& s = scene.simulation;
    const ClothId gone = s.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), {.translation = Vec3(0, 2, 0)});
    s.keep_previous_positions();
    scene.run(3);
    s.remove_cloth(gone);
    std::vector<Vec3> nine(9, Vec3::Zero());
    const std::array<ClothId, 1> one = {gone};
    const std::vector<std::function<void()>> calls = {
        [&] { s.pin(gone, 0); },
        [&] { s.unpin(gone, 0); },
        [&] { s.move_pin(gone, 0, Vec3::Zero()); },
        [&] {
            s.add_seam(scene.cloth, gone, std::vector<std::array<int, 2>>{{0, 0}});
        },
        [&] { s.set_pair(gone, gone, {}); },
        [&] { s.set_layer(gone, 1); },
        [&] { s.meets(gone, scene.cloth); },
        [&] { s.set_positions(gone, nine); },
        [&] { s.set_velocities(gone, nine); },
        [&] { s.reset(gone); },
        [&] { s.set_fabric(gone, sheet_fabric()); },
        [&] { s.teleport(one, {}, {}); },
        [&] { s.positions(gone); },
        [&] { s.velocities(gone); },
        [&] { s.masses(gone); },
        [&] { s.normals(gone); },
        [&] { s.interpolate(0.5, gone, nine); },
        [&] { s.largest_strain(gone); },
        [&] { s.contact_loads(gone); },
        [&] { s.remove_cloth(gone); },
    };
    for (const auto& call : calls) check_refused(s, call, {"cloth 1 was removed"});
    check_refused(s, [&] { s.remove_cloth({7}); }, {"no cloth 7"});
}

TEST_CASE("After a removal every call still acts on the body whose id it is given") {
    SlopeScene scene(0.0, false);
    Simulation& s = scene.simulation;
    const ObstacleId shelf = s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -3, 0)}, {.name = "shelf"});
    const ObstacleId rock = s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -4, 0)}, {.name = "rock"});
    const ClothId second = s.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), {.translation = Vec3(0, 2, 0)}, "second");
    const ClothId third = s.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), {.translation = Vec3(0, 3, 0)}, "third");
    scene.run(2);
    s.remove_cloth(second);
    s.remove_obstacle(shelf);
    s.pin(third, 4);
    const Vec3 held = s.positions(third)[4];
    const std::array<ClothId, 1> cloths = {third};
    const std::array<ObstacleId, 1> obstacles = {rock};
    s.teleport(cloths, obstacles, {.translation = Vec3(5, 0, 0)});
    s.move_obstacle(rock, {.translation = Vec3(5, -4.001, 0)});
    scene.run(1);
    CHECK(s.positions(third)[4] == held + Vec3(5, 0, 0));
    CHECK(s.obstacle_pose(rock).translation == Vec3(5, -4.001, 0));
    CHECK(s.obstacle_pose(scene.plane).translation == Vec3::Zero());
    CHECK(std::abs(s.positions(scene.cloth)[0].x()) < 0.2);
    CHECK(mentions(scene_error([&] { s.pin(third, 9); }), {"third", "no vertex 9"}));
    CHECK(mentions(scene_error([&] { s.set_friction(rock, -1.0); }), {"rock"}));
    s.set_friction(scene.plane, 2.0);
    s.set_velocities(scene.cloth, std::vector<Vec3>(16, Vec3(0.5, 0, 0)));
    scene.run(30);  // the floor's new friction brakes it
    CHECK(scene.mean(s.velocities(scene.cloth)).norm() < 1e-3);
}

TEST_CASE("The id of an obstacle that was removed is refused by every call, and nothing changes") {
    SlopeScene scene(0.3);
    Simulation& s = scene.simulation;
    const ObstacleId gone = s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -3, 0)}, {.name = "cellar"});
    const ObstacleId last = s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -4, 0)}, {.name = "rock"});
    scene.run(3);
    s.remove_obstacle(gone);
    const std::array<ObstacleId, 1> one = {gone};
    const std::vector<std::function<void()>> calls = {
        [&] { s.move_obstacle(gone, {}); },    [&] { s.deform_obstacle(gone, {}); },
        [&] { s.set_friction(gone, 0.5); },    [&] { s.set_restitution(gone, 0.5); },
        [&] { s.teleport({}, one, {}); },      [&] { s.obstacle_pose(gone); },
        [&] { s.obstacle_shape(gone); },       [&] { s.force_on(gone); },
        [&] { s.torque_on(gone, {0, 0, 0}); }, [&] { s.remove_obstacle(gone); },
    };
    for (const auto& call : calls) check_refused(s, call, {"obstacle 1 was removed"});
    CHECK(s.obstacle_pose(last).translation == Vec3(0, -4, 0));
    CHECK(s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -5, 0)}).index == 3);
    scene.run(3);
}

TEST_CASE("States saved before a removal are refused, and states saved after it continue in every bit") {
    const auto make = [](bool twice) {
        SlopeScene scene(0.4);
        const ObstacleId far = scene.simulation.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -3, 0)});
        const ClothId other =
            scene.simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 3)});
        if (twice) scene.run(4);
        return std::tuple(std::move(scene), far, other);
    };
    auto [scene, far, other] = make(true);
    Simulation& s = scene.simulation;
    const auto whole = s.save();
    s.remove_obstacle(far);
    check_refused(s, [&] { s.restore(whole); }, {"other obstacles"});
    const auto one_obstacle = s.save();
    s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -3, 0)});  // the same again, with another id
    check_refused(s, [&] { s.restore(whole); }, {"removed before it was saved"});
    s.remove_obstacle({2});
    s.restore(one_obstacle);
    s.remove_cloth(other);
    check_refused(s, [&] { s.restore(one_obstacle); }, {"other cloth"});
    scene.run(2);
    const auto after = s.save();
    auto [again, again_far, again_other] = make(false);
    again.simulation.remove_cloth(again_other);
    again.simulation.remove_obstacle(again_far);
    again.simulation.restore(after);
    CHECK(again.simulation.save() == after);
    for (int n = 0; n < 20; ++n) {
        scene.run(1);
        again.run(1);
        REQUIRE(s.state_hash() == again.simulation.state_hash());
    }
}

TEST_CASE("A detector that cannot remove an obstacle reports so, naming it") {
    class Firm : public PlaneDetector {
    public:
        void remove_obstacle(int obstacle) override { ContactDetector::remove_obstacle(obstacle); }
    };
    SlopeScene scene(0.3, true, 0.0, 0.0045, std::make_unique<Firm>());
    check_refused(scene.simulation, [&] { scene.simulation.remove_obstacle(scene.plane); },
                  {"floor", "cannot remove an obstacle"});
    scene.run(2);
    CHECK(scene.simulation.force_on(scene.plane).norm() > 0.0);
}

}  // namespace percale::test::simulation_changes_test
