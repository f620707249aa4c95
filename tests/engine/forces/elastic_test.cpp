#include "engine/forces/elastic.h"

#include "engine/forces/hinge_bending.h"
#include "engine/schemes/schemes.h"
#include "tests/support/bent_cloth.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::elastic_test {
namespace {

Fabric sewn_fabric() {
    Fabric fabric{.area_density = 0.2, .thickness = 0.005, .spring_damping = 0.02};
    fabric.stretch_stiffness = {400.0, 300.0};
    fabric.shear_stiffness = 100.0;
    fabric.bend_stiffness = 1e-4;
    return fabric;
}

/// Two panels that hang in the wind while a seam draws them together.
struct SewnPanels {
    Simulation simulation;
    ClothId front;

    SewnPanels(Scheme scheme, double dt);
};

SewnPanels::SewnPanels(Scheme scheme, double dt)
    : simulation({.time_step = dt, .scheme = scheme, .measure = StepMeasures::ledger}) {
    front = simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), sewn_fabric(), {.translation = {0, 0.03, 0}}, "front");
    const ClothId back = simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), sewn_fabric(), {.translation = {0, -0.03, 0}}, "back");
    const std::array<int, 2> pairs[] = {{5, 5}, {11, 11}, {17, 17}};
    simulation.add_seam(front, back, pairs, {.over = 40.5 * dt, .stiffness = 500.0, .name = "side"});
    for (const int corner : {0, 30}) simulation.pin(front, corner);
    simulation.pin(back, 0);
    simulation.set_wind({2.0, 0.5, 1.0});
}

}  // namespace

TEST_CASE("The energy ledger closes with membranes, hinges, seams, wind and released pins, in every scheme", "[law]") {
    for (const Scheme scheme : all_schemes) {
        const double dt = facts_of(scheme).implicit ? 1.0 / 120.0 : 1e-4;
        SewnPanels panels(scheme, dt);
        Simulation& simulation = panels.simulation;
        double before = simulation.energy().total(), work = 0.0;
        for (int n = 0; n < 60; ++n) {
            if (n == 30) simulation.unpin(panels.front, 30);
            const StepReport report = simulation.step();
            CAPTURE(static_cast<int>(scheme), n, report.explanation());
            REQUIRE(report.ok());
            CHECK(report.energy.closure() < 1e-11);
            const StepEnergy& energy = report.energy;
            CHECK(energy.total() - before + energy.dissipated() - energy.residual_work - energy.work ==
                  Approx(0.0).margin(1e-13));
            before = energy.total();
            work += energy.work;
        }
        CHECK(work != 0.0);
    }
}

TEST_CASE("The loss of a flat hinge whose force is taken at the end is the energy of the move itself") {
    const ClothModel model = bending_model(make_grid(0.3, 0.3, 6, 6));
    Random random(3);
    const std::vector<Vec3> start = random_points(random, 36, 0.3), end = random_points(random, 36, 0.3);
    std::vector<Vec3> move;
    for (int i = 0; i < 36; ++i) move.push_back(end[i] - start[i]);
    ElasticSpace space;
    const Vec3Arrays from = to_vec3_arrays(start), to = to_vec3_arrays(end);
    CHECK(shape_loss(compute, model, {from, to, to, {}}, space) ==
          Approx(hinge_energy(model.hinges, to_vec3_arrays(move))).epsilon(1e-9));
    CHECK(shape_loss(compute, model, {from, to, from, {}}, space) ==
          Approx(-hinge_energy(model.hinges, to_vec3_arrays(move))).epsilon(1e-9));
}

TEST_CASE("Cloth of raw springs has no loss of shapes") {
    const ClothModel model = cloth_model(make_grid(0.3, 0.3, 4, 4), sheet_fabric());
    const Vec3Arrays start = to_vec3_arrays(make_grid(0.4, 0.4, 4, 4).vertices),
                     end = to_vec3_arrays(make_grid(0.2, 0.2, 4, 4).vertices);
    ElasticSpace space;
    CHECK(shape_loss(compute, model, {start, end, end, {}}, space) == 0.0);
}

}  // namespace percale::test::elastic_test
