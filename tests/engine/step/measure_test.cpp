#include "engine/step/measure.h"

#include <cmath>
#include <limits>

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::measure_test {
namespace {

World moving_pair() {
    World world = make_world(linked_masses({2.0, 3.0}, {{0, 1, 1.0, 50.0, 0.0}}), {Vec3(0, 1, 0), Vec3(1.5, 2, 0)},
                             {.measure = StepMeasures::all});
    world.state.cloth.velocities.set(0, Vec3(1, 2, 2));
    world.state.cloth.velocities.set(1, Vec3(0, 0, -4));
    return world;
}

}  // namespace

TEST_CASE("Energies are those of the state") {
    const World world = moving_pair();
    const StepEnergy energy = energy_of(world.scene, world.state);
    const double stretch = std::sqrt(1.5 * 1.5 + 1.0) - 1.0;
    CHECK(energy.kinetic == Approx(0.5 * 2.0 * 9.0 + 0.5 * 3.0 * 16.0).epsilon(1e-15));
    CHECK(energy.gravity == Approx(9.81 * (2.0 * 1.0 + 3.0 * 2.0)).epsilon(1e-15));
    CHECK(energy.elastic == Approx(0.5 * 50.0 * stretch * stretch).epsilon(1e-14));
    CHECK(energy.contact == 0.0);
    CHECK(energy.work == 0.0);
    CHECK(energy.total() == energy.kinetic + energy.gravity + energy.elastic);
}

TEST_CASE("Strain and speed are the largest ones, without contact nothing is near") {
    World world = moving_pair();
    plan_step(world);
    StepReport report;
    report.energy.work = 7.0;
    StepMeasure(world.scene, world.state, 0.0).accepted(world.state, world.work, report);
    CHECK(report.largest_speed == 4.0);
    CHECK(report.largest_strain == Approx(std::sqrt(3.25) - 1.0).epsilon(1e-14));
    CHECK(report.smallest_distance == std::numeric_limits<double>::infinity());
    CHECK(report.contacts == 0);
    CHECK(report.energy.work == 7.0);  // counted by the solve, kept by the measurement
    CHECK(world.work.times.measure >= 0.0);
}

TEST_CASE("Unmeasured figures are NaN in the report and still available on demand") {
    CHECK(StepSettings{}.measure == StepMeasures::automatic);
    for (const StepMeasures measures : {StepMeasures::none, StepMeasures::automatic}) {
        for (const bool skip : {true, false}) {
            World world = moving_pair();
            world.scene.settings.measure = measures;
            world.scene.settings.skip = skip;
            const StepReport report = step(world);
            CHECK(std::isnan(report.energy.total()) == skip);
            CHECK(std::isnan(report.energy.work) == skip);
            CHECK(std::isnan(report.largest_strain) == skip);
            CHECK(std::isnan(report.largest_speed) == skip);
            CHECK(std::isfinite(energy_of(world.scene, world.state).total()));
        }
    }
}

TEST_CASE("Contacts are counted and hashed, and the hash follows their distances") {
    TriangleMesh grid = make_grid(0.2, 0.2, 3, 3);
    for (Vec3& x : grid.vertices) x.y() = 0.004;
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.measure = StepMeasures::all});
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {}});
    const StepReport first = step(world);
    CHECK(first.contacts == 9);
    CHECK(first.energy.contact > 0.0);
    CHECK(first.contact_stiffness > 0.0);
    double lowest = 1.0;
    for (int i = 0; i < 9; ++i) lowest = std::min(lowest, world.state.cloth.positions.y[i]);
    CHECK(first.smallest_distance == lowest);
    const auto hash = [&] {
        StepReport report;
        StepMeasure(world.scene, world.state, 0.0).accepted(world.state, world.work, report);
        return report.contact_hash;
    };
    CHECK(hash() == first.contact_hash);
    std::vector<double>& distances = world.work.newton.current.constraints.distance;
    distances[3] = std::nextafter(distances[3], 1.0);
    CHECK(hash() != first.contact_hash);
}

}  // namespace percale::test::measure_test
