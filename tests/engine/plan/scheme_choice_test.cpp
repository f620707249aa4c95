#include "engine/plan/scheme_choice.h"

#include <cmath>
#include <limits>

#include "engine/plan/planning.h"
#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::scheme_choice_test {
namespace {

World sheet(const StepSettings& settings, int side = 9, double stiffer = 1.0) {
    Fabric fabric = sheet_fabric();
    fabric.springs.structural *= stiffer;
    fabric.springs.shear *= stiffer;
    fabric.springs.bend *= stiffer;
    fabric.spring_damping = 0.0;
    const TriangleMesh grid = make_grid(1.0, 1.0, side, side);
    World world = make_world(cloth_model(grid, fabric), grid.vertices, settings);
    plan_step(world);
    return world;
}

/// "KIND: TEXT" of each warning.
std::string warnings_of(const World& world) {
    const StepPlan& plan = world.scene.plan;
    const double stable = stable_step(world.scene, world.state.cloth, plan.scheme);
    std::string text;
    for (const PlanWarning& warning : step_warnings(world.scene, world.state.cloth, plan, stable))
        text += warning.kind + ": " + warning.text();
    return text;
}

/// Largest speed after some steps from a small disturbance, without gravity.
double speed_after(Scheme scheme, double dt, int steps) {
    World world = sheet({.time_step = dt, .scheme = scheme, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
    Random random(3);
    for (int i = 0; i < world.scene.model.vertex_count(); ++i) world.state.cloth.velocities.set(i, 1e-6 * random.point(1.0));
    StepReport report;
    for (int n = 0; n < steps && (n == 0 || report.ok()); ++n) report = step(world);
    return report.ok() ? report.largest_speed : std::numeric_limits<double>::infinity();
}

}  // namespace

TEST_CASE("The stable step of a pair of masses is that of the oscillator, reduced by damping") {
    const double m1 = 0.2, m2 = 0.3, omega = std::sqrt(40.0 * (1.0 / m1 + 1.0 / m2));
    for (const double damping : {0.0, 0.5}) {
        const World world = make_world(linked_masses({m1, m2}, {{0, 1, 1.0, 40.0, damping}}), {Vec3(0, 0, 0), Vec3(1, 0, 0)}, {});
        const double zeta = 0.5 * damping * (1.0 / m1 + 1.0 / m2) / omega;
        const double a = 2.0 * (std::sqrt(1.0 + zeta * zeta) - zeta);
        CHECK(stable_step(world.scene, world.state.cloth, Scheme::symplectic_euler) == Approx(a / omega).epsilon(1e-9));
        CHECK(stable_step(world.scene, world.state.cloth, Scheme::forward_euler) == 0.0);
        CHECK(std::isinf(stable_step(world.scene, world.state.cloth, Scheme::tr_bdf2)));
    }
}

TEST_CASE("On a sheet steps are stable below the estimate and not far above it") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        const World still = sheet({});
        const double stable = stable_step(still.scene, still.state.cloth, scheme);
        CAPTURE(static_cast<int>(scheme), stable);
        CHECK(speed_after(scheme, 0.93 * stable, 300) < 1e-4);
        CHECK(speed_after(scheme, 1.1 * stable, 2000) > 1.0);
    }
}

TEST_CASE("Steps of cloth of given moduli with hinges are stable below the estimate and not far above it") {
    const auto speed = [](double share, int steps) {
        Fabric fabric{.area_density = 0.2, .spring_damping = 0.0};
        fabric.stretch_stiffness = {900.0, 700.0};
        fabric.shear_stiffness = 100.0;
        fabric.bend_stiffness = 1e-3;
        StepSettings settings{.scheme = Scheme::symplectic_euler, .measure = StepMeasures::all, .gravity = Vec3::Zero()};
        const TriangleMesh grid = make_grid(1.0, 1.0, 9, 9);
        ClothModel model;
        append_cloth(model, grid, fabric, "cloth");
        append_hinges_of_last_cloth(model, 1e-3);
        finish_model(model);
        World world = make_world(model, grid.vertices, settings);
        world.scene.settings.time_step = share * stable_step(world.scene, world.state.cloth, settings.scheme);
        Random random(3);
        for (int i = 0; i < 81; ++i) world.state.cloth.velocities.set(i, 1e-6 * random.point(1.0));
        StepReport report;
        for (int n = 0; n < steps && (n == 0 || report.ok()); ++n) report = step(world);
        return report.ok() ? report.largest_speed : std::numeric_limits<double>::infinity();
    };
    CHECK(speed(0.93, 300) < 1e-4);
    CHECK(speed(1.1, 2000) > 1.0);
}

TEST_CASE("Steps far too long end in a status, never silently") {
    World world = sheet({.time_step = 0.02, .scheme = Scheme::rk4});
    StepReport report;
    for (int n = 0; n < 1000 && (n == 0 || report.ok()); ++n) {
        for (int i = 0; n == 0 && i < 81; i += 7) world.state.cloth.velocities.set(i, Vec3(0.1, 0.05 * i, -0.1));
        report = step(world);
    }
    CHECK(report.status == StepStatus::not_finite);
}

TEST_CASE("The choice is explicit for coarse soft cloth, implicit for stiff or fine cloth and with contact") {
    const auto chosen = [](World world) {
        return choose_scheme(world.scene, world.state.cloth, scene_facts(world.scene, world.state.cloth));
    };
    const SchemeChoice soft = chosen(sheet({.scheme = Scheme::automatic}, 5, 0.05));
    CHECK(soft.scheme == Scheme::symplectic_euler);
    CHECK(soft.parts >= 1);
    CHECK(mentions(soft.reason, {"symplectic_euler", "backward_euler", "evaluations"}));
    CHECK(chosen(sheet({.scheme = Scheme::automatic}, 33, 10.0)).scheme == Scheme::backward_euler);
    CHECK(chosen(sheet({.adaptive = true, .scheme = Scheme::automatic}, 17, 100.0)).scheme == Scheme::tr_bdf2);
    CHECK(chosen(sheet({.adaptive = true, .scheme = Scheme::automatic}, 5, 0.05)).scheme == Scheme::rk4);
    World over = sheet({.scheme = Scheme::automatic}, 5, 0.05);
    over.scene.script.obstacles.push_back({"ball", {}, {}});
    CHECK(choose_scheme(over.scene, over.state.cloth, scene_facts(over.scene, over.state.cloth)).scheme ==
          Scheme::backward_euler);
    over.scene.settings.adaptive = true;
    CHECK(choose_scheme(over.scene, over.state.cloth, scene_facts(over.scene, over.state.cloth)).scheme == Scheme::tr_bdf2);
    over.scene.settings.contact_response = ContactResponse::projection;
    CHECK(choose_scheme(over.scene, over.state.cloth, scene_facts(over.scene, over.state.cloth)).scheme ==
          Scheme::backward_euler);
}

TEST_CASE("The chosen scheme takes as many parts as it needs to be stable") {
    World world = sheet({.time_step = 1.0 / 60.0, .scheme = Scheme::automatic, .measure = StepMeasures::all}, 7, 0.1);
    world.scene.script.free[0] = 0.0;
    StepReport report;
    for (int n = 0; n < 60; ++n) REQUIRE((report = step(world)).ok());
    CHECK(world.scene.plan.scheme == Scheme::symplectic_euler);
    CHECK(world.scene.plan.parts > 1);
    CHECK(report.smallest_dt == Approx(1.0 / 60.0 / world.scene.plan.parts));
    CHECK(report.largest_strain < 1.0);
}

TEST_CASE("Warnings name what will fail, and there are none where nothing will") {
    const auto warnings = [](const StepSettings& settings, int side = 9) { return warnings_of(sheet(settings, side)); };
    CHECK(warnings({}).empty());
    CHECK(warnings({.time_step = 1e-4, .scheme = Scheme::rk4}).empty());
    CHECK(mentions(warnings({.time_step = 0.02, .scheme = Scheme::rk4}), {"unstable_step: time_step 0.02 s", "rk4", "stable"}));
    CHECK(mentions(warnings({.time_step = 1e-5, .scheme = Scheme::forward_euler}),
                   {"growing_scheme: forward_euler", "grow; use rk4"}));
    CHECK(mentions(warnings({.scheme = Scheme::trapezoid}), {"ringing_step: ", "trapezoid", "tr_bdf2"}));
    CHECK(mentions(warnings({.scheme = Scheme::implicit_midpoint}), {"ringing_step: ", "implicit_midpoint", "gain energy; use"}));
    CHECK(warnings({.time_step = 1e-3, .scheme = Scheme::trapezoid}).empty());
    CHECK(warnings({.newton_iterations = 1}).empty());
    CHECK(mentions(warnings({.newton_iterations = 1}, 65), {"one_newton_iteration: newton_iterations = 1", "4225"}));
}

TEST_CASE("Slivers of cloth of moduli cause a warning where the solver is iterative") {
    const auto warned = [](double height, const Fabric& fabric, LinearSolver solver) {
        TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, height}, {0.5, 0, -0.5}},
                          .triangles = {{0, 2, 1}, {0, 1, 3}}};
        return warnings_of(make_world(cloth_model(mesh, fabric), mesh.vertices, {.linear_solver = solver}));
    };
    const Fabric moduli = fabric_preset("silk");
    Fabric isotropic = moduli;
    isotropic.stretch_stiffness = std::array{100.0, 100.0};
    isotropic.shear_stiffness.reset();
    CHECK(mentions(warned(0.005, isotropic, LinearSolver::multigrid),
                   {"slivers_of_moduli: cloth 'cloth'", "200 times as long as high", "direct"}));
    CHECK(warned(0.005, isotropic, LinearSolver::direct).empty());
    CHECK(warned(0.005, isotropic, LinearSolver::automatic).empty());  // so few vertices are solved directly
    CHECK(warned(0.02, isotropic, LinearSolver::multigrid).empty());
    CHECK(warned(0.005, free_fabric(), LinearSolver::multigrid).empty());
}

}  // namespace percale::test::scheme_choice_test
