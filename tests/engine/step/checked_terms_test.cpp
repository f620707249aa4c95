#include "engine/step/checked_terms.h"

#include <algorithm>

#include "engine/plan/planning.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/membrane_cases.h"
#include "tests/support/plane_scenes.h"

namespace percale::test {
namespace {

World disturbed_world(const Fabric& fabric, StepSettings settings = {}) {
    TriangleMesh grid = make_grid(0.5, 0.5, 7, 6);
    for (Vec3& x : grid.vertices) x.y() += 0.02;
    settings.check_derivatives = true;
    World world = make_world(cloth_model(grid, fabric), grid.vertices, settings);
    copy_in(disturbed(grid.vertices, 1.02, 0.01, 3), world.state.positions);
    for (int i = 0; i < 42; ++i) {
        if (world.state.positions.y[i] < 0.004) world.state.positions.y[i] = 0.004;
    }
    update_points(world.state);
    return world;
}

std::vector<std::string> names(const World& world) {
    std::vector<std::string> result;
    for (const CheckedTerm& term : checked_terms(world)) result.push_back(term.name);
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
            update_plan(world);
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
        update_plan(world);
        for (int n = 0; n < 3; ++n) REQUIRE(step(world).ok());
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
        update_plan(world);
        for (int n = 0; n < 4; ++n) {
            const StepReport report = step(world);
            CAPTURE(n, report.wrong_derivative);
            REQUIRE(report.ok());
        }
        const std::vector<std::string> terms = names(world);
        CHECK(std::count(terms.begin(), terms.end(), "wind") == 1);
        CHECK(std::count(terms.begin(), terms.end(), "curved hinges") == (curved ? 1 : 0));
    }
}

TEST_CASE("Terms are those that act: contact where there is some, triangles where there are moduli") {
    World world = disturbed_world(woven_fabric());
    update_plan(world);
    REQUIRE(step(world).ok());
    CHECK(names(world) == std::vector<std::string>{"gravity", "springs", "membrane"});
    World plain = disturbed_world(sheet_fabric());
    add_plane(plain);
    update_plan(plain);
    StepReport report;
    for (int n = 0; n < 20 && report.contacts == 0; ++n) report = step(plain);
    CHECK(names(plain) == std::vector<std::string>{"gravity", "springs", "damped springs", "contact"});
}

TEST_CASE("A wrong matrix planted in a real term is seen and named by its two vertices") {
    World world = disturbed_world(sheet_fabric());
    update_plan(world);
    REQUIRE(step(world).ok());
    // All springs pull.
    copy_in(disturbed(world.model.rest, 1.2, 0.002, 5), world.state.positions);
    std::vector<CheckedTerm> terms = checked_terms(world);
    const CheckedState state{world.state.positions, 42, 1e-6, world.settings.time_step};
    CHECK_FALSE(find_wrong_derivative(terms, state).has_value());
    CheckedTerm& springs = terms.at(1);
    springs.multiply = [right = springs.multiply](const Vectors& d, Vectors& product) {
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

TEST_CASE("A step whose derivatives do not fit fails with the state kept, and says where") {
    World world = disturbed_world(woven_fabric());
    update_plan(world);
    const ClothState before = world.state;
    // The rest lengths that only the energy of triangles takes.
    for (double& square : world.model.adjacency.membrane.numbers[0]) square *= 1.01;
    const StepReport report = step(world);
    CHECK(report.status == StepStatus::wrong_derivative);
    CHECK_FALSE(report.ok());
    CHECK(mentions(report.explanation(),
                   {"wrong_derivative", "check_derivatives: membrane: force on vertex 0 of cloth", "energy"}));
    CHECK(same_bits(world.state.positions, before.positions));
}

}  // namespace percale::test
