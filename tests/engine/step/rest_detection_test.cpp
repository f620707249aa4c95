#include "engine/step/rest_detection.h"

#include <cmath>
#include <functional>

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::rest_detection_test {
namespace {

constexpr double dt = 1.0 / 60.0;

/// A damped sheet held at its four corners over a plane, far enough not to touch it; asleep within seconds.
struct Sheet {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;
    PlaneDetector* detector;

    Vec3 at(int vertex) const { return simulation.positions(cloth)[vertex]; }
};

Sheet make_sheet(const StepSettings& settings = {.time_step = dt}) {
    auto detector = std::make_unique<PlaneDetector>();
    PlaneDetector* plane = detector.get();
    Sheet sheet{Simulation(settings, std::move(detector)), {}, {}, plane};
    Fabric fabric = sheet_fabric();
    fabric.spring_damping = 1.0;
    sheet.plane = sheet.simulation.add_obstacle(make_plane(1.0));
    sheet.cloth = sheet.simulation.add_cloth(make_grid(0.5, 0.5, 6, 6), fabric, {.translation = Vec3(0, 0.5, 0)});
    for (const int vertex : {0, 5, 30, 35}) sheet.simulation.pin(sheet.cloth, vertex);
    return sheet;
}

/// Makes steps until all cloth sleeps; the number of steps, or -1.
int steps_to_sleep(Simulation& simulation, int most = 600) {
    for (int n = 0; n < most; ++n) {
        if (simulation.step().slept) return n;
    }
    return -1;
}

}  // namespace

TEST_CASE("A sheet that has come to rest sleeps: time passes, nothing moves, nothing is solved") {
    Sheet sheet = make_sheet({.time_step = dt, .measure = StepMeasures::all});
    REQUIRE(steps_to_sleep(sheet.simulation) > 30);
    const std::uint64_t state = sheet.simulation.state_hash();
    const double time = sheet.simulation.time();
    const int candidate_updates = sheet.detector->candidate_updates;
    const StepEnergy energy = sheet.simulation.energy();
    for (int n = 1; n <= 20; ++n) {
        const StepReport report = sheet.simulation.step();
        CHECK(report.status == StepStatus::ok);
        CHECK((report.slept && report.sleeping_cloths == 1));
        CHECK(report.newton_iterations == 0);
        CHECK(report.time == Approx(time + n * dt).epsilon(1e-12));
        CHECK(report.dt == dt);
        CHECK((report.largest_speed == 0.0 && report.energy.kinetic == 0.0 && report.energy.work == 0.0));
        CHECK(report.energy.elastic == energy.elastic);
        CHECK(std::isnan(report.energy.dissipated()));
    }
    CHECK(sheet.simulation.state_hash() == state);
    CHECK(sheet.detector->candidate_updates == candidate_updates);
    for (const Vec3& v : sheet.simulation.velocities(sheet.cloth)) CHECK(v == Vec3::Zero());
}

TEST_CASE("A sheet asleep is where it would be without sleep") {
    Sheet sleeping = make_sheet(), awake = make_sheet({.time_step = dt, .skip = false});
    REQUIRE(steps_to_sleep(sleeping.simulation) > 0);
    while (sleeping.simulation.time() < 9.99) sleeping.simulation.step();
    while (awake.simulation.time() < 9.99) CHECK(awake.simulation.step().sleeping_cloths == 0);
    double largest = 0.0;
    for (int i = 0; i < 36; ++i) largest = std::max(largest, (sleeping.at(i) - awake.at(i)).norm());
    CHECK(largest < 2e-5);
}

TEST_CASE("Every change of the scene wakes the cloth") {
    using Change = std::function<void(Sheet&)>;
    const std::pair<const char*, Change> list[] = {
        {"pin", [](Sheet& s) { s.simulation.pin(s.cloth, 14); }},
        {"unpin", [](Sheet& s) { s.simulation.unpin(s.cloth, 0); }},
        {"move_pin", [](Sheet& s) { s.simulation.move_pin(s.cloth, 0, s.at(0) + Vec3(0, 0.01, 0)); }},
        {"move_obstacle", [](Sheet& s) { s.simulation.move_obstacle(s.plane, {.translation = Vec3(0, 0.01, 0)}); }},
        {"add_obstacle", [](Sheet& s) { s.simulation.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -1, 0)}); }},
        {"add_cloth", [](Sheet& s) { s.simulation.add_cloth(make_grid(1, 1, 3, 3), {}, {.translation = Vec3(0, 2, 0)}); }},
        {"set_gravity", [](Sheet& s) { s.simulation.set_gravity(Vec3(0, -1.6, 0)); }},
        {"set_time_step", [](Sheet& s) { s.simulation.set_time_step(0.01); }},
        {"set_velocities", [](Sheet& s) { s.simulation.set_velocities(s.cloth, std::vector<Vec3>(36, Vec3(0, 0.1, 0))); }},
        {"set_positions",
         [](Sheet& s) {
             const auto x = s.simulation.positions(s.cloth);
             s.simulation.set_positions(s.cloth, std::vector<Vec3>(x.begin(), x.end()));
         }},
    };
    for (const auto& [name, change] : list) {
        CAPTURE(name);
        Sheet sheet = make_sheet();
        REQUIRE(steps_to_sleep(sheet.simulation) > 0);
        change(sheet);
        const StepReport report = sheet.simulation.step();
        CHECK_FALSE(report.slept);
        CHECK(report.newton_iterations > 0);
        CHECK(report.ok());
    }
}

TEST_CASE("Calls that change nothing leave the cloth asleep") {
    Sheet sheet = make_sheet();
    REQUIRE(steps_to_sleep(sheet.simulation) > 0);
    sheet.simulation.set_gravity(Vec3(0, -9.81, 0));
    sheet.simulation.set_time_step(dt);
    sheet.simulation.move_pin(sheet.cloth, 0, sheet.at(0));
    sheet.simulation.move_obstacle(sheet.plane, {});
    CHECK(sheet.simulation.step().slept);
}

TEST_CASE("A sheet lying on a plane sleeps with its contacts reported, and wakes when the plane is taken away") {
    Simulation simulation({.time_step = dt, .measure = StepMeasures::all}, std::make_unique<PlaneDetector>());
    const ObstacleId plane = simulation.add_obstacle(make_plane(1.0));
    simulation.add_cloth(make_grid(0.5, 0.5, 5, 5), sheet_fabric(), {.translation = Vec3(0, 0.006, 0)});
    REQUIRE(steps_to_sleep(simulation) > 0);
    const StepReport asleep = simulation.step();
    CHECK(asleep.contacts == 25);
    CHECK(asleep.smallest_distance > 0.0);
    CHECK(asleep.energy.contact > 0.0);
    simulation.move_obstacle(plane, {.translation = Vec3(0, -0.5, 0)});
    CHECK_FALSE(simulation.step().slept);
    CHECK(simulation.step().largest_speed > 0.1);
}

TEST_CASE("Cloth that falls, swings or is pulled does not sleep, even where it is slow") {
    Simulation thrown({.time_step = dt});
    const ClothId sheet = thrown.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    thrown.set_velocities(sheet, std::vector<Vec3>(9, Vec3(0, 9.81, 0)));
    CHECK(steps_to_sleep(thrown, 120) == -1);  // turns after 1 s

    // Weightless and drifting by 1e-4 m a second, a tenth of the creep of a sticking contact.
    Simulation drifting({.time_step = dt, .gravity = Vec3::Zero()});
    const ClothId cloth = drifting.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    drifting.set_velocities(cloth, std::vector<Vec3>(9, Vec3(1e-4, 0, 0)));
    CHECK(steps_to_sleep(drifting, 300) == -1);

    // A pin that continues to creep.
    Sheet pulled = make_sheet();
    for (int n = 0; n < 300; ++n) {
        pulled.simulation.move_pin(pulled.cloth, 0, pulled.at(0) + Vec3(-1e-9, 0, 0));
        CHECK(pulled.simulation.step().sleeping_cloths == 0);
    }
}

TEST_CASE("A still cloth whose forces are out of balance is not at rest") {
    TriangleMesh grid = make_grid(0.5, 0.5, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.time_step = dt});
    world.scene.plan.rest = true;
    StepReport report;
    Vec3Arrays& velocities = world.state.cloth.velocities;
    const Vec3Arrays before = velocities;
    const auto follow = [&] { update_rest(world.scene, before, world.state.cloth, world.rest, report); };
    for (int i = 0; i < 9; ++i) velocities.set(i, Vec3(0, 0.019 * 9.81 * dt, 0));
    velocities.set(4, Vec3(0, 0.021 * 9.81 * dt, 0));
    for (int n = 0; n < 60; ++n) follow();
    CHECK_FALSE(world.rest.asleep);
    velocities.set(4, Vec3::Zero());
    report = {};
    follow();
    CHECK(world.rest.asleep);
    CHECK(report.sleeping_cloths == 1);
}

TEST_CASE("Cloth below a given rest speed is at rest") {
    for (const double speed : {1e-4, 4e-4}) {
        Simulation drifting({.time_step = dt, .rest_speed = 2e-4, .gravity = Vec3::Zero()});
        const ClothId cloth = drifting.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
        drifting.set_velocities(cloth, std::vector<Vec3>(9, Vec3(speed, 0, 0)));
        CHECK((steps_to_sleep(drifting, 120) > 0) == (speed < 2e-4));
    }
}

TEST_CASE("Sleep begins half a second after the last move, for any number of steps") {
    for (const double step : {0.1, 0.01}) {
        TriangleMesh grid = make_grid(0.5, 0.5, 3, 3);
        World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.time_step = step});
        const Vec3Arrays before = world.state.cloth.velocities;
        int steps = 0;
        while (!world.rest.asleep && steps < 1000) {
            StepReport report;
            if (steps == 3) world.state.cloth.positions.set(2, world.state.cloth.positions.at(2) + Vec3(0, 1.1e-5, 0));
            update_rest(world.scene, before, world.state.cloth, world.rest, report);
            ++steps;
        }
        CHECK((steps - 4) * step == Approx(0.5).margin(1.01 * step));
    }
}

TEST_CASE("As long as one of two cloths is awake both are solved") {
    Simulation simulation({.time_step = dt, .measure = StepMeasures::all});
    const ClothId held = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric(), {}, "held");
    for (int i = 0; i < 9; ++i) simulation.pin(held, i);
    simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 0)}, "falling");
    StepReport report;
    for (int n = 0; n < 60; ++n) report = simulation.step();
    CHECK(report.sleeping_cloths == 1);
    CHECK_FALSE(report.slept);
    CHECK(report.largest_speed > 9.0);
}

}  // namespace percale::test::rest_detection_test
