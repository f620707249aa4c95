#include "engine/step/kinetic_damping.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/random.h"

namespace percale::test::kinetic_damping_test {
namespace {

constexpr double dt = 1.0 / 60.0;

struct Banner {
    Simulation simulation;
    ClothId cloth;
};

/// A sheet held by one edge, level at the start: it swings about its place of rest, which is straight down.
Banner make_banner(StepSettings settings, double spring_damping = 0.05) {
    settings.time_step = dt;
    Banner banner{Simulation(settings), {}};
    Fabric fabric = sheet_fabric();
    fabric.spring_damping = spring_damping;
    banner.cloth = banner.simulation.add_cloth(make_grid(0.5, 0.5, 6, 6), fabric, {.translation = Vec3(0, 1, 0)});
    for (int i = 0; i < 6; ++i) banner.simulation.pin(banner.cloth, i);
    return banner;
}

int steps_to_sleep(Simulation& simulation, int most) {
    for (int n = 0; n < most; ++n) {
        if (simulation.step().slept) return n;
    }
    return most;
}

}  // namespace

TEST_CASE("A swinging sheet comes to rest many times sooner by kinetic damping, and hangs straight down") {
    Banner damped = make_banner({.kinetic_damping = true}), swinging = make_banner({});
    const int steps = steps_to_sleep(damped.simulation, 1200);
    CAPTURE(steps);
    CHECK(3 * steps < steps_to_sleep(swinging.simulation, 1200));
    const auto x = damped.simulation.positions(damped.cloth);
    for (int i = 6; i < 36; ++i) CHECK((x[i] - x[i % 6]).z() == Approx(0.0).margin(2e-3));
    for (int i = 30; i < 36; ++i) CHECK(x[i].y() < 0.5 + 1e-3);
}

TEST_CASE("The step that stops cloth leaves no speed, and its loss is accounted for") {
    Banner banner = make_banner({.measure = StepMeasures::ledger, .kinetic_damping = true});
    double before = banner.simulation.energy().total();
    int stops = 0;
    for (int n = 0; n < 120; ++n) {
        const StepReport report = banner.simulation.step();
        const StepEnergy& energy = report.energy;
        const double balance = energy.total() - before + energy.dissipated() - energy.residual_work - energy.work;
        CHECK(balance == Approx(energy.imbalance).margin(1e-12));
        before = energy.total();
        CHECK(report.stopped == (report.largest_speed == 0.0));
        if (!report.stopped) continue;
        ++stops;
        CHECK(energy.kinetic == 0.0);
        CHECK(energy.dissipated_integrator > 0.0);
        for (const Vec3& v : banner.simulation.velocities(banner.cloth)) CHECK(v == Vec3::Zero());
    }
    CHECK(stops > 2);
}

TEST_CASE("Cloth that creeps is left alone: overdamped, its potential falls in every step") {
    const auto hash_after = [](bool damping) {
        Simulation simulation({.time_step = dt, .kinetic_damping = damping, .gravity = Vec3::Zero()});
        Fabric fabric = sheet_fabric();
        fabric.spring_damping = 1e4;
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 6, 6), fabric);
        std::vector<Vec3> stretched;
        for (const Vec3& x : simulation.positions(cloth)) stretched.push_back(1.1 * x);
        simulation.set_positions(cloth, stretched);
        for (int n = 0; n < 60; ++n) CHECK(simulation.step().ok());
        CHECK(simulation.largest_strain() > 1e-3);  // it is still moving
        return simulation.state_hash();
    };
    CHECK(hash_after(true) == hash_after(false));
}

TEST_CASE("Cloth is stopped in just those steps in which its potential rises, contact's included, and no pin moves") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.time_step = dt, .kinetic_damping = true});
    world.scene.plan.measures = true;
    Random random(3);
    double before = 0.0;
    for (int n = 0; n < 200; ++n) {
        world.scene.plan.pins_move = n % 7 == 3;
        StepReport report;
        for (double* part : {&report.energy.gravity, &report.energy.elastic, &report.energy.contact})
            *part = random.number(-1, 1);
        const double potential = report.energy.gravity + report.energy.elastic + report.energy.contact;
        damp_kinetic_energy(world.scene, world.state, world.rest, report);
        CHECK(report.stopped == (n > 0 && potential > before && n % 7 != 3));
        before = potential;
    }
}

TEST_CASE("Cloth is not stopped while a pin lifts it") {
    Banner banner = make_banner({.kinetic_damping = true});
    REQUIRE(steps_to_sleep(banner.simulation, 1200) < 1200);
    for (int n = 0; n < 30; ++n) {
        for (int i = 0; i < 6; ++i)
            banner.simulation.move_pin(banner.cloth, i, banner.simulation.positions(banner.cloth)[i] + Vec3(0, 0.005, 0));
        banner.simulation.step();
        CHECK(banner.simulation.largest_speed() > 0.1);
    }
}

TEST_CASE("Cloth is not stopped while wind lifts it") {
    Banner banner = make_banner({.kinetic_damping = true});
    REQUIRE(steps_to_sleep(banner.simulation, 1200) < 1200);
    banner.simulation.set_wind({0, 0, 20});
    bool stopped = false;
    for (int n = 0; n < 60; ++n) stopped = banner.simulation.step().stopped || stopped;
    CHECK_FALSE(stopped);
}

TEST_CASE("Resumed between two steps, kinetic damping stops cloth in the same ones") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::bdf2, Scheme::symplectic_euler}) {
        Banner whole = make_banner({.scheme = scheme, .kinetic_damping = true});
        for (int n = 0; n < 20; ++n) whole.simulation.step();
        Banner resumed = make_banner({.scheme = scheme, .kinetic_damping = true});
        resumed.simulation.restore(whole.simulation.save());
        for (int n = 0; n < 60; ++n) {
            whole.simulation.step();
            resumed.simulation.step();
            CHECK(resumed.simulation.state_hash() == whole.simulation.state_hash());
        }
    }
}

}  // namespace percale::test::kinetic_damping_test
