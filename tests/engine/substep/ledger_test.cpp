#include "engine/substep/ledger.h"

#include <cmath>

#include "engine/schemes/schemes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::ledger_test {
namespace {

StepSettings settings_of(Scheme scheme) {
    return {.time_step = facts_of(scheme).implicit ? 1.0 / 60.0 : 5e-5, .scheme = scheme, .measure = StepMeasures::ledger};
}

/// A sheet in free motion, with one corner that is prescribed.
struct CarriedSheet {
    Simulation simulation;
    ClothId cloth;
    double dt;
    int steps = 0;

    explicit CarriedSheet(const StepSettings& settings, double damping = 0.1) : simulation(settings), dt(settings.time_step) {
        Fabric fabric = sheet_fabric();
        fabric.spring_damping = damping;
        cloth = simulation.add_cloth(make_grid(0.6, 0.6, 7, 7), fabric);
        Random random(31);
        std::vector<Vec3> velocities = random_points(random, 49, 2.0);
        simulation.set_velocities(cloth, velocities);
        simulation.pin(cloth, 0);
    }
    StepReport step() {
        const double t = ++steps * dt;
        simulation.move_pin(cloth, 0, Vec3(-0.3 + t * t, 0.2 * std::sin(5.0 * t), -0.3 - t));
        return simulation.step();
    }
};

}  // namespace

TEST_CASE("The ledger of a sheet that is thrown and carried closes in every step") {
    for (const Scheme scheme : all_schemes) {
        for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
            StepSettings settings = settings_of(scheme);
            settings.damping_form = form;
            CarriedSheet sheet(settings);
            for (int n = 0; n < 60; ++n) {
                const StepReport report = sheet.step();
                REQUIRE(report.ok());
                CAPTURE(static_cast<int>(scheme), n, report.energy.imbalance, report.energy.dissipated_integrator);
                CHECK(report.energy.closure() < 1e-12);
                CHECK(report.energy.dissipated_material > 0.0);
                CHECK(std::abs(report.energy.work) > 0.0);
            }
        }
    }
}

TEST_CASE("Absent effects have no entry in the ledger") {
    CarriedSheet sheet(settings_of(Scheme::backward_euler), 0.0);
    const StepEnergy energy = sheet.step().energy;
    CHECK(energy.dissipated_material == 0.0);
    CHECK(energy.dissipated_friction == 0.0);
    CHECK(energy.dissipated_contact == 0.0);
    CHECK(energy.dissipated_integrator > 0.0);
    CHECK(energy.residual_work != 0.0);
}

TEST_CASE("The work of the residual decreases with the tolerance") {
    StepSettings settings = settings_of(Scheme::backward_euler);
    settings.newton_tolerance = 1e-11;
    CarriedSheet loose(settings_of(Scheme::backward_euler)), tight(settings);
    const double at_default = std::abs(loose.step().energy.residual_work);
    CHECK(std::abs(tight.step().energy.residual_work) < 1e-6 * at_default);
}

TEST_CASE("The ledger is kept only on request, and changes nothing") {
    StepSettings settings = settings_of(Scheme::backward_euler);
    CarriedSheet with(settings);
    settings.measure = StepMeasures::all;
    CarriedSheet without(settings);
    for (int n = 0; n < 5; ++n) {
        const StepEnergy kept = with.step().energy, left_out = without.step().energy;
        CHECK(left_out.total() == kept.total());
        CHECK(left_out.work == kept.work);
        for (const auto entry : ledger_entries) {
            CHECK(std::isnan(left_out.*entry));
            CHECK(std::isfinite(kept.*entry));
        }
    }
    CHECK(with.simulation.state_hash() == without.simulation.state_hash());
}

TEST_CASE("A halved step's ledger is that of its parts") {
    StepSettings settings = settings_of(Scheme::backward_euler);
    settings.time_step = 1.0 / 30.0;
    settings.newton_tolerance = 1e-9;
    settings.newton_iterations = 20;
    CarriedSheet sheet(settings);
    int halved = 0;
    for (int n = 0; n < 20; ++n) {
        const StepReport report = sheet.step();
        REQUIRE(report.ok());
        halved += report.halvings > 0;
        CHECK(report.energy.closure() < 1e-12);
    }
    CHECK(halved > 0);
}

TEST_CASE("A failed step has no flows") {
    StepSettings settings = settings_of(Scheme::backward_euler);
    Simulation simulation(settings, std::make_unique<PlaneDetector>());
    simulation.add_obstacle(make_plane(1.0));
    const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), sheet_fabric(), {.translation = Vec3(0, 0.02, 0)});
    simulation.pin(cloth, 4);
    simulation.move_pin(cloth, 4, Vec3(0, -0.1, 0));
    const StepReport report = simulation.step();
    REQUIRE(report.status == StepStatus::pin_blocked);
    CHECK(report.energy.work == 0.0);
    for (const auto entry : ledger_entries) CHECK(report.energy.*entry == 0.0);
}

}  // namespace percale::test::ledger_test
