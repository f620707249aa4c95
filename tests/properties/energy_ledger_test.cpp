#include <cmath>

#include "engine/schemes/schemes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/plane_detector.h"

// Flows of energy over whole runs.
namespace percale::test::energy_ledger_test {
namespace {

/// The ledger of a run: its sum and the worst closure of a step.
struct Ledger {
    StepEnergy sum;
    double worst = 0.0;
    int halved = 0;
};

/// Makes the steps; `before_step` receives the time at the end of each one.
template <class BeforeStep>
Ledger run(Simulation& simulation, int steps, double dt, BeforeStep before_step) {
    Ledger ledger{.sum = simulation.energy()};
    for (int n = 1; n <= steps; ++n) {
        before_step(n * dt);
        const StepReport report = simulation.step();
        CAPTURE(n, report.explanation());
        REQUIRE(report.ok());
        ledger.worst = std::max(ledger.worst, report.energy.closure());
        ledger.halved += report.halvings > 0;
        add_step_energy(report.energy, ledger.sum);
    }
    return ledger;
}

void no_script(double) {}

StepSettings measured(Scheme scheme, double dt) { return {.time_step = dt, .scheme = scheme, .measure = StepMeasures::ledger}; }

/// A sheet on planes: one floor, tilted about z by the angle.
struct PlaneScene {
    Simulation simulation;
    ObstacleId floor;
    ClothId cloth;

    PlaneScene(const StepSettings& settings, double friction, double angle, double height)
        : simulation(settings, std::make_unique<PlaneDetector>()) {
        const Rotation tilt{std::cos(-0.5 * angle), 0.0, 0.0, std::sin(-0.5 * angle)};
        const Vec3 up = transform(Pose{.translation = Vec3::Zero(), .rotation = tilt}, Vec3(0, height, 0));
        floor = simulation.add_obstacle(make_plane(1.0), {.rotation = tilt}, {.friction = friction, .name = "floor"});
        cloth = simulation.add_cloth(make_grid(0.4, 0.4, 6, 6), sheet_fabric(), {.translation = up, .rotation = tilt});
    }
};

}  // namespace

TEST_CASE("The energy ledger of a swinging sheet closes in every scheme", "[law]") {
    for (const Scheme scheme : all_schemes) {
        const SchemeFacts& facts = facts_of(scheme);
        const double dt = facts.implicit ? 1.0 / 60.0 : 1e-4;
        const int steps = facts.implicit ? 120 : facts.stable_up_to > 0.0 ? 2000 : 200;
        Simulation simulation(measured(scheme, dt));
        const ClothId cloth = simulation.add_cloth(make_grid(0.6, 0.6, 9, 9), sheet_fabric());
        for (const int corner : {0, 8}) simulation.pin(cloth, corner);
        const Ledger ledger = run(simulation, steps, dt, [&](double t) {
            simulation.move_pin(cloth, 0, Vec3(-0.3 + 0.05 * std::sin(8.0 * t), 0.0, -0.3));
        });
        const std::string name = "ledger of a swinging sheet with a moved pin, " + std::string(facts_of(scheme).word);
        check_law(name + ": worst step, of its largest term", ledger.worst, 1e-11);
        check_law(name + ": whole run", ledger.sum.closure(), 1e-11);
        CHECK(ledger.sum.dissipated_material > 0.0);
        CHECK(std::abs(ledger.sum.work) > 1e-4);
    }
}

TEST_CASE("Backward Euler's loss vanishes with the step, and the material's dissipation stays", "[law]") {
    double integrator[3] = {}, material[3] = {};
    for (int level = 0; level < 3; ++level) {
        const double dt = 1e-4 / (1 << level);
        StepSettings settings = measured(Scheme::backward_euler, dt);
        settings.newton_tolerance = 1e-9;
        settings.newton_iterations = 200;
        Simulation simulation(settings);
        const ClothId cloth = simulation.add_cloth(make_grid(0.6, 0.6, 5, 5), sheet_fabric());
        std::vector<Vec3> places = make_grid(0.63, 0.63, 5, 5).vertices;  // taut: nothing buckles
        simulation.set_positions(cloth, places);
        for (const int corner : {0, 4, 20, 24}) simulation.pin(cloth, corner);
        const Ledger ledger = run(simulation, 200 << level, dt, no_script);
        integrator[level] = ledger.sum.dissipated_integrator;
        material[level] = ledger.sum.dissipated_material;
    }
    check_law_between("backward Euler's own loss, ratio of one step to half of it", integrator[1] / integrator[2], 1.7, 2.2);
    check_law_between("loss by damping, ratio of one step to half of it", material[1] / material[2], 0.9, 1.1);
}

TEST_CASE("RK4's own loss on a taut sheet falls with the fourth power of the step", "[law]") {
    double loss[2] = {};
    for (int level = 0; level < 2; ++level) {
        const double dt = 5e-5 / (1 << level);
        Simulation simulation(measured(Scheme::rk4, dt));
        const ClothId cloth = simulation.add_cloth(make_grid(0.6, 0.6, 5, 5), sheet_fabric());
        simulation.set_positions(cloth, make_grid(0.66, 0.66, 5, 5).vertices);
        for (const int corner : {0, 4, 20, 24}) simulation.pin(cloth, corner);
        loss[level] = run(simulation, 400 << level, dt, no_script).sum.dissipated_integrator;
    }
    check_law_between("rk4's own loss, ratio of one step to half of it", loss[0] / loss[1], 12.0, 40.0);
}

TEST_CASE("The energy ledger closes in contact, with friction, on moving obstacles and through halved steps", "[law]") {
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        const std::string form = response == ContactResponse::penalty ? "penalty" : "projection";
        StepSettings settings = measured(Scheme::backward_euler, 1.0 / 60.0);
        settings.contact_response = response;

        PlaneScene impact(settings, 0.0, 0.0, 0.1);
        const Ledger hit = run(impact.simulation, 60, settings.time_step, no_script);
        check_law("ledger of an impact on a plane, " + form + ": worst step", hit.worst, 1e-11);
        CHECK(hit.sum.dissipated_friction == 0.0);

        PlaneScene slope(settings, 0.2, 0.5, 0.006);
        const Ledger slid = run(slope.simulation, 60, settings.time_step, no_script);
        check_law("ledger of a sheet that slides down a slope, " + form + ": worst step", slid.worst, 1e-11);
        CHECK(slid.sum.dissipated_friction > 0.0);

        PlaneScene conveyor(settings, 0.4, 0.0, 0.006);
        const Ledger carried = run(conveyor.simulation, 60, settings.time_step, [&](double t) {
            conveyor.simulation.move_obstacle(conveyor.floor, {.translation = Vec3(0.5 * t, 0.05 * std::sin(3.0 * t), 0.0)});
        });
        check_law("ledger of a sheet on a moving plane, " + form + ": worst step", carried.worst, 1e-11);
        CHECK(carried.sum.work > 0.0);
        CHECK(carried.sum.dissipated_friction > 0.0);

        settings.newton_tolerance = 1e-9;
        settings.newton_iterations = 4;
        PlaneScene hard(settings, 0.3, 0.2, 0.02);
        const Ledger divided = run(hard.simulation, 30, settings.time_step, no_script);
        check_law("ledger through halved steps, " + form + ": worst step", divided.worst, 1e-11);
        CHECK(divided.halved > 0);
    }
}

TEST_CASE("The energy ledger of TR-BDF2 closes in contact, with steps that adapt too", "[law]") {
    for (const bool adaptive : {false, true}) {
        StepSettings settings = measured(Scheme::tr_bdf2, 1.0 / 60.0);
        settings.adaptive = adaptive;
        PlaneScene scene(settings, 0.3, 0.2, 0.02);
        const Ledger ledger = run(scene.simulation, 45, settings.time_step, [&](double t) {
            scene.simulation.move_obstacle(scene.floor, {.translation = Vec3(0.2 * t, 0.03 * std::sin(5.0 * t), 0.0)});
        });
        check_law(std::string("ledger of a sheet on a moving plane, tr_bdf2") + (adaptive ? ", adaptive" : "") + ": worst step",
                  ledger.worst, 1e-11);
        CHECK(ledger.sum.dissipated_contact != 0.0);
        CHECK(std::abs(ledger.sum.work) > 0.0);
    }
}

TEST_CASE("Friction dissipates mu m g cos times the way of a sliding sheet", "[law]") {
    const double mu = 0.2, angle = 0.5;
    StepSettings settings = measured(Scheme::backward_euler, 1.0 / 240.0);
    PlaneScene slope(settings, mu, angle, 0.0045);
    run(slope.simulation, 60, settings.time_step, no_script);  // it has settled at its distance and slides
    const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
    const auto place = [&] {
        double sum = 0.0, mass = 0.0;
        for (int i = 0; i < 36; ++i) {
            sum += slope.simulation.masses(slope.cloth)[i] * slope.simulation.positions(slope.cloth)[i].dot(downhill);
            mass += slope.simulation.masses(slope.cloth)[i];
        }
        return std::pair(sum / mass, mass);
    };
    const auto [start, mass] = place();
    const Ledger ledger = run(slope.simulation, 120, settings.time_step, no_script);
    const double way = place().first - start, exact = mu * mass * 9.81 * std::cos(angle) * way;
    CHECK(way > 0.1);
    check_law("loss by friction on a slope, relative to mu m g cos(angle) times the way",
              std::abs(ledger.sum.dissipated_friction / exact - 1.0), 0.01);
}

TEST_CASE("Cloth that falls asleep keeps a closed ledger", "[law]") {
    StepSettings settings = measured(Scheme::backward_euler, 1.0 / 60.0);
    PlaneScene flat(settings, 0.3, 0.0, 0.0045);
    Ledger ledger{.sum = flat.simulation.energy()};
    bool slept = false;
    for (int n = 0; n < 300; ++n) {
        const StepReport report = flat.simulation.step();
        REQUIRE(report.ok());
        slept = slept || report.slept;
        ledger.worst = std::max(ledger.worst, report.energy.closure());
        add_step_energy(report.energy, ledger.sum);
        if (report.slept) CHECK(report.energy.dissipated() == 0.0);
    }
    CHECK(slept);
    check_law("ledger of a sheet that comes to rest and sleeps: worst step", ledger.worst, 1e-11);
    CHECK(std::abs(ledger.sum.imbalance) < 1e-12);
}

}  // namespace percale::test::energy_ledger_test
