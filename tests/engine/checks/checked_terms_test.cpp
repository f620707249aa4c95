#include "engine/checks/checked_terms.h"

#include <algorithm>

#include "engine/plan/planning.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::checked_terms_test {
namespace {

World disturbed_world(const Fabric& fabric, StepSettings settings = {}) {
    TriangleMesh grid = make_grid(0.5, 0.5, 7, 6);
    for (Vec3& x : grid.vertices) x.y() += 0.02;
    settings.check_derivatives = true;
    World world = make_world(cloth_model(grid, fabric), grid.vertices, settings);
    copy_in(disturbed(grid.vertices, 1.02, 0.01, 3), world.state.cloth.positions);
    for (int i = 0; i < 42; ++i) {
        if (world.state.cloth.positions.y[i] < 0.004) world.state.cloth.positions.y[i] = 0.004;
    }
    update_points(world.state.cloth);
    return world;
}

std::vector<std::string> names(const World& world) {
    std::vector<std::string> result;
    const StepEnd end{world.scene, world.state.cloth, world.state, world.work, world.scene.settings.time_step};
    for (const CheckedTerm& term : checked_terms(end)) result.push_back(term.name);
    return result;
}

}  // namespace

TEST_CASE("All forces pass the check in every step of a disturbed sheet: springs, triangles, damping, contact, any scheme") {
    Fabric woven = woven_fabric();
    woven.damping_time = 1e-3;
    for (const Fabric& fabric : {sheet_fabric(), woven_fabric(), woven}) {
        for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
            World world = disturbed_world(fabric, {.damping_form = form});
            add_plane(world);
            plan_step(world);
            int contacts = 0;
            for (int n = 0; n < 8; ++n) {
                const StepReport report = step(world);
                CAPTURE(n, report.wrong_derivative);
                REQUIRE(report.ok());
                contacts += report.contacts;
            }
            CHECK(contacts > 0);
        }
        World world = disturbed_world(fabric, {.time_step = 1e-4, .scheme = Scheme::rk4});
        plan_step(world);
        for (int n = 0; n < 3; ++n) REQUIRE(step(world).ok());
    }
}

TEST_CASE("A dented ball under pressure and one with gas pass the check, and pressure is among the terms") {
    for (const bool gas : {false, true}) {
        Fabric fabric = moduli_fabric(90.0, 90.0, {}, 0.2);
        if (gas)
            fabric.gas_volume = 0.04;
        else
            fabric.pressure = 80.0;
        const TriangleMesh ball = make_sphere(0.2, 1);
        StepSettings settings;
        settings.check_derivatives = true;
        World world = make_world(cloth_model(ball, fabric), disturbed(ball.vertices, 1.02, 0.01, 6), settings);
        plan_step(world);
        for (int n = 0; n < 4; ++n) {
            const StepReport report = step(world);
            CAPTURE(gas, n, report.wrong_derivative);
            REQUIRE(report.ok());
        }
        const std::vector<std::string> all = names(world);
        CHECK(std::count(all.begin(), all.end(), "pressure") == 1);
    }
}

TEST_CASE("Hinges of flat and of curved cloth, and wind, pass the check") {
    for (const bool curved : {false, true}) {
        TriangleMesh mesh = make_grid(0.5, 0.5, 6, 6);
        mesh.grid_columns = mesh.grid_rows = 0;
        for (Vec3& x : mesh.vertices) x.y() = curved ? 0.8 * x.x() * x.x() : 0.0;
        Fabric fabric = moduli_fabric(90.0, 90.0, {}, 0.2);
        fabric.bend_stiffness = 1e-4;
        ClothModel model;
        append_cloth(model, mesh, fabric, "cloth");
        append_hinges_of_last_cloth(model, *fabric.bend_stiffness);
        finish_model(model);
        CHECK(model.hinges.curved.empty() != curved);
        StepSettings settings;
        settings.check_derivatives = true;
        settings.wind = Vec3(3.0, 1.0, -0.5);
        World world = make_world(std::move(model), disturbed(mesh.vertices, 1.02, 0.01, 6), settings);
        plan_step(world);
        for (int n = 0; n < 4; ++n) {
            const StepReport report = step(world);
            CAPTURE(n, report.wrong_derivative);
            REQUIRE(report.ok());
        }
        const std::vector<std::string> terms = names(world);
        CHECK(std::count(terms.begin(), terms.end(), "wind") == 1);
        CHECK(std::count(terms.begin(), terms.end(), "hinges") == 1);
    }
}

TEST_CASE("The terms are those that act: contact where there is some, triangles where there are moduli") {
    World world = disturbed_world(woven_fabric());
    plan_step(world);
    REQUIRE(step(world).ok());
    CHECK(names(world) == std::vector<std::string>{"gravity", "springs", "membrane"});
    World plain = disturbed_world(sheet_fabric());
    add_plane(plain);
    plan_step(plain);
    StepReport report;
    for (int n = 0; n < 20 && report.contacts == 0; ++n) report = step(plain);
    CHECK(names(plain) == std::vector<std::string>{"gravity", "springs", "damped springs", "contact"});
}

TEST_CASE("A wrong matrix planted in a real term is found and named by its two vertices") {
    World world = disturbed_world(sheet_fabric());
    plan_step(world);
    REQUIRE(step(world).ok());
    // All springs pull.
    copy_in(disturbed(world.scene.model.rest, 1.2, 0.002, 5), world.state.cloth.positions);
    const ClothState start = world.state.cloth;
    const StepEnd end{world.scene, start, world.state, world.work, world.scene.settings.time_step};
    std::vector<CheckedTerm> terms = checked_terms(end);
    const CheckedState state{world.state.cloth.positions, 42, 1e-6, world.scene.settings.time_step};
    CHECK_FALSE(find_wrong_derivative(terms, state).has_value());
    CheckedTerm& springs = terms.at(1);
    springs.multiply = [right = springs.multiply](const Vec3Arrays& d, Vec3Arrays& product) {
        right(d, product);
        product.add(17, 0.01 * d.at(18));
        product.add(18, 0.01 * d.at(17));
    };
    const auto wrong = find_wrong_derivative(terms, state);
    REQUIRE(wrong.has_value());
    CHECK(wrong->term == "springs");
    CHECK(wrong->vertex == 17);
    CHECK(wrong->by_vertex == 18);
}

TEST_CASE("A step whose derivatives do not fit fails with the state kept, and names the place") {
    World world = disturbed_world(woven_fabric());
    plan_step(world);
    const ClothState before = world.state.cloth;
    // The rest lengths that only the energy of triangles uses.
    for (double& square : world.scene.model.adjacency.membrane.numbers[0]) square *= 1.01;
    const StepReport report = step(world);
    CHECK(report.status == StepStatus::wrong_derivative);
    CHECK_FALSE(report.ok());
    CHECK(mentions(report.explanation(),
                   {"wrong_derivative", "check_derivatives: membrane: force on vertex 0 of cloth", "energy"}));
    CHECK(same_bits(world.state.cloth.positions, before.positions));
}

}  // namespace percale::test::checked_terms_test
