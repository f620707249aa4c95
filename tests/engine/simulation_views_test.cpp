#include "percale/simulation.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {
namespace {

/// A sheet 2 cm above a plane at y = 0.
struct PlaneScene {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;

    explicit PlaneScene(const StepSettings& settings = {}) : simulation(settings, std::make_unique<PlaneDetector>()) {
        cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0, 0.02, 0)}, "towel");
        plane = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    }
};

std::uint64_t hash_with(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.set_positions(cloth, positions);
    simulation.set_velocities(cloth, velocities);
    return simulation.state_hash();
}

}  // namespace

TEST_CASE("Views have one entry a vertex and show the cloth at its pose") {
    Simulation simulation(StepSettings{});
    const TriangleMesh grid = make_grid(1.0, 1.0, 5, 4);
    const Pose pose{.translation = Vec3(1, 2, 3), .rotation = {0.6, 0.0, 0.8, 0.0}, .scale = 2.0};
    const ClothId cloth = simulation.add_cloth(grid, sheet_fabric(), pose);
    CHECK(simulation.cloth_count() == 1);
    REQUIRE(simulation.positions(cloth).size() == 20);
    REQUIRE(simulation.velocities(cloth).size() == 20);
    REQUIRE(simulation.masses(cloth).size() == 20);
    CHECK(copy(simulation.positions(cloth)) == transform(pose, grid.vertices));
    double mass = 0.0;
    for (const double m : simulation.masses(cloth)) mass += m;
    CHECK(mass == Approx(0.2 * 4.0).epsilon(1e-13));  // the scale belongs to the rest shape
    CHECK(simulation.energy().elastic < 1e-20);
    CHECK(simulation.energy().kinetic == 0.0);
}

TEST_CASE("The report's figures are those of the state") {
    PlaneScene scene({.measure = StepMeasures::all});
    StepReport report;
    for (int n = 0; n < 20; ++n) report = scene.simulation.step();
    const StepEnergy energy = scene.simulation.energy();
    CHECK(report.energy.kinetic == energy.kinetic);
    CHECK(report.energy.gravity == energy.gravity);
    CHECK(report.energy.elastic == energy.elastic);
    CHECK(report.energy.contact == energy.contact);
    double lowest = 1.0, fastest = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) lowest = std::min(lowest, x.y());
    for (const Vec3& v : scene.simulation.velocities(scene.cloth)) fastest = std::max(fastest, v.norm());
    CHECK(report.smallest_distance == lowest);
    CHECK(report.largest_speed == Approx(fastest).epsilon(1e-14));
    CHECK(report.largest_speed == scene.simulation.largest_speed());
    CHECK(report.largest_strain == scene.simulation.largest_strain());
    CHECK(report.time == scene.simulation.time());
    CHECK(report.linear_iterations >= report.newton_iterations);
}

TEST_CASE("The state hash depends on every bit of positions and velocities") {
    Random random(8);
    const std::vector<Vec3> positions = random_points(random, 9, 0.5), velocities = random_points(random, 9, 0.5);
    const std::uint64_t hash = hash_with(positions, velocities);
    CHECK(hash == hash_with(positions, velocities));
    for (int i = 0; i < 9; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Vec3> other = positions;
            other[i][axis] = std::nextafter(other[i][axis], 1.0);
            CHECK(hash_with(other, velocities) != hash);
            other = velocities;
            other[i][axis] = -other[i][axis];
            CHECK(hash_with(positions, other) != hash);
        }
    }
    std::vector<Vec3> swapped = positions;
    std::swap(swapped[2], swapped[5]);
    CHECK(hash_with(swapped, velocities) != hash);
}

}  // namespace percale::test
