#include <algorithm>
#include <cmath>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/laws.h"

// The energy ledger on meshes, whose contacts change from step to step.
namespace percale::test::contact_ledger_test {
namespace {

constexpr double h = 0.005;

Fabric fabric(bool self_contact) {
    return {.area_density = 0.2,
            .thickness = h,
            .self_contact = self_contact,
            .friction = 0.3,
            .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
            .spring_damping = 0.1};
}

StepSettings settings_of(ContactResponse response) {
    return {.time_step = 1.0 / 60.0, .contact_response = response, .measure = StepMeasures::ledger};
}

/// A run's ledger: its sum, the worst closure of a step, the largest energy that changed contacts gave in a step.
struct Ledger {
    StepEnergy sum;
    double worst = 0.0, given = 0.0;
    int contacts = 0, halved = 0;

    explicit Ledger(const Simulation& simulation) : sum(simulation.energy()) {}
    void step(Simulation& simulation) {
        const StepReport report = simulation.step();
        CAPTURE(report.explanation());
        REQUIRE(report.ok());
        worst = std::max(worst, report.energy.closure());
        given = std::max(given, -report.energy.dissipated_contact);
        contacts = std::max(contacts, report.contacts);
        halved += report.halvings > 0;
        add_step_energy(report.energy, sum);
    }
};

std::string form(ContactResponse response) { return response == ContactResponse::penalty ? "penalty" : "projection"; }

}  // namespace

TEST_CASE("The energy ledger of a sheet on a ball that rises and turns closes", "[law]") {
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        Simulation simulation(settings_of(response), backends().back().make_detector());
        simulation.add_cloth(make_grid(0.4, 0.4, 9, 9), fabric(false), {.translation = Vec3(0.01, 0.22, 0.02)});
        const ObstacleId ball = simulation.add_obstacle(make_sphere(0.2, 2), {}, {.friction = 0.3, .name = "ball"});
        Ledger ledger(simulation);
        for (int n = 1; n <= 45; ++n) {
            const double angle = 0.01 * n;
            simulation.move_obstacle(ball, {.translation = Vec3(0, n > 20 ? 0.01 * (n - 20) : 0.0, 0),
                                            .rotation = {std::cos(angle), 0.0, std::sin(angle), 0.0}});
            ledger.step(simulation);
        }
        CHECK(ledger.contacts > 5);
        CHECK(ledger.sum.work > 0.0);
        CHECK(ledger.sum.dissipated_friction > 0.0);
        check_law("ledger of a sheet on a moving ball, " + form(response) + ": worst step, of its largest term", ledger.worst,
                  1e-10);
        report_law("ledger of a sheet on a moving ball, " + form(response) + ": most that changed contacts gave in a step, J",
                   figure(ledger.given), "of " + figure(ledger.sum.dissipated()) + " dissipated");
    }
}

TEST_CASE("The energy ledger of a sheet that falls on a sheet closes", "[law]") {
    Simulation simulation(settings_of(ContactResponse::penalty), make_brute_force_detector());
    const ClothId lower = simulation.add_cloth(make_grid(0.4, 0.4, 9, 9), fabric(true), {}, "table");
    for (const int corner : {0, 8, 72, 80}) simulation.pin(lower, corner);
    const Pose pose{.translation = {0.003, 0.02, 0.004}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}};
    const ClothId upper = simulation.add_cloth(make_grid(0.2, 0.2, 5, 5), fabric(true), pose, "napkin");
    simulation.set_velocities(upper, std::vector<Vec3>(25, Vec3(0.3, 0.0, 0.0)));
    Ledger ledger(simulation);
    for (int n = 0; n < 40; ++n) ledger.step(simulation);
    CHECK(ledger.contacts > 0);
    CHECK(ledger.sum.dissipated_friction > 0.0);
    check_law("ledger of a sheet that falls on a sheet: worst step, of its largest term", ledger.worst, 1e-10);
}

TEST_CASE("The energy ledger closes through the halved steps of a sheet that a fast ball hits", "[law]") {
    StepSettings settings = settings_of(ContactResponse::penalty);
    settings.newton_tolerance = 1e-9;
    settings.newton_iterations = 8;
    Simulation simulation(settings, backends().back().make_detector());
    simulation.add_cloth(make_grid(0.4, 0.4, 9, 9), fabric(false), {.translation = Vec3(0.01, 0.25, 0.02)});
    const ObstacleId ball = simulation.add_obstacle(make_sphere(0.2, 2), {}, {.friction = 0.3, .name = "ball"});
    Ledger ledger(simulation);
    for (int n = 1; n <= 15; ++n) {
        simulation.move_obstacle(ball, {.translation = Vec3(0, 0.1 * n, 0)});
        ledger.step(simulation);
    }
    CHECK(ledger.contacts > 5);
    CHECK(ledger.halved > 0);
    check_law("ledger of a sheet hit at 6 m/s, " + std::to_string(ledger.halved) + " steps halved: worst step", ledger.worst,
              1e-10);
}

TEST_CASE("Adaptive steps on a ball that moves gain no energy but the ball's work, and do not become ever shorter", "[law]") {
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        const StepSettings settings{.adaptive = true, .contact_response = response, .measure = StepMeasures::all};
        Simulation simulation(settings, backends().back().make_detector());
        const Fabric sheet{.area_density = 0.2, .springs = {.structural = 500.0, .shear = 200.0, .bend = 5.0}};
        simulation.add_cloth(make_grid(0.4, 0.4, 9, 9), sheet, {.translation = {0.0, 0.14, 0.0}});
        const ObstacleId ball = simulation.add_obstacle(make_sphere(0.12, 2), {}, {.friction = 0.4, .name = "ball"});
        simulation.prepare();
        double energy = simulation.energy().total(), gained = 0.0;
        const double scale = 0.2 * 0.16 * 9.81 * 0.14;  // J, of the fall
        for (int n = 1; n <= 40; ++n) {
            simulation.move_obstacle(ball, {.translation = {0.004 * std::max(0, n - 15), 0.0, 0.0}});
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            CAPTURE(static_cast<int>(response), n, report.parts, report.smallest_dt, report.contact_stiffness);
            CHECK(report.smallest_dt > 1e-5);
            gained = std::max(gained, report.energy.total() - energy - report.energy.work);
            energy = report.energy.total();
        }
        CAPTURE(gained / scale);
        CHECK(gained < 0.03 * scale);  // 16 times `scale` if stiffness follows the length of the substep
    }
}

}  // namespace percale::test::contact_ledger_test
