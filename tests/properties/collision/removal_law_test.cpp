#include <array>
#include <functional>
#include <vector>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

namespace percale::test::removal_law_test {

// Bodies that are removed, and fabrics that change, between steps of whole scenes with mesh obstacles and layers of cloth.

namespace {

Fabric fabric(bool meets = false) {
    return {.area_density = 0.2,
            .thickness = 0.005,
            .self_contact = meets,
            .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
            .spring_damping = 0.1};
}

void run(Simulation& simulation, int steps) {
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step();
        CAPTURE(n, report.explanation());
        REQUIRE(report.ok());
    }
}

double lowest(const Simulation& simulation, ClothId cloth) {
    double y = 1e300;
    for (const Vec3& x : simulation.positions(cloth)) y = std::min(y, x.y());
    return y;
}

std::vector<Vec3> copy(std::span<const Vec3> view) { return {view.begin(), view.end()}; }

}  // namespace

namespace {

/// A sheet that falls on a ball, and below it a box, or none.
Simulation sheet_on_ball(const StepSettings& settings, const Backend& backend, bool box) {
    Simulation simulation(settings, backend.make_detector());
    simulation.add_cloth(make_grid(0.3, 0.3, 11, 11), fabric(), {.translation = {0.02, 0.21, 0}});
    if (box) simulation.add_obstacle(make_box({1, 1, 1}), {.translation = {0, -2, 0}}, {.name = "far"});
    simulation.add_obstacle(make_sphere(0.2, 3), {}, {.friction = 0.4, .name = "ball"});
    return simulation;
}

void check_removed_box(const StepSettings& settings, const Backend& backend) {
    CAPTURE(backend.name, static_cast<int>(settings.scheme), static_cast<int>(settings.contact_response));
    Simulation had = sheet_on_ball(settings, backend, true), never = sheet_on_ball(settings, backend, false);
    for (int n = 0; n < 45; ++n) {
        if (n == 20) had.remove_obstacle({0});
        const StepReport one = had.step(), other = never.step();
        REQUIRE(one.ok());
        REQUIRE(one.contacts == other.contacts);
        REQUIRE(copy(had.positions({0})) == copy(never.positions({0})));
        REQUIRE(copy(had.velocities({0})) == copy(never.velocities({0})));
    }
    CHECK(had.state_hash() == never.state_hash());  // it includes the numbers of obstacles
    CHECK(had.force_on({1}) == never.force_on({0}));
    CHECK(had.force_on({1}).norm() > 0.1);
}

}  // namespace

TEST_CASE("Removing a mesh that nothing touched leaves the steps of a scene without it, in every bit", "[law]") {
    for (const Backend& backend : backends()) {
        check_removed_box({}, backend);
        check_removed_box({.contact_response = ContactResponse::projection}, backend);
        check_removed_box({.scheme = Scheme::tr_bdf2}, backend);
    }
}

TEST_CASE("Cloth drops to the next body below where a mesh, rigid or compliant, is removed under it", "[law]") {
    for (const bool yields : {false, true}) {
        Simulation simulation({}, backends().back().make_detector());
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 11, 11), fabric(), {.translation = {0, 0.22, 0}});
        const ObstacleId ball = simulation.add_obstacle(make_sphere(0.2, 3), {}, {.friction = 0.4, .yields = yields});
        const ObstacleId floor = simulation.add_obstacle(make_plane(2.0), {.translation = {0, -0.3, 0}}, {.friction = 0.4});
        run(simulation, 60);
        CHECK(lowest(simulation, cloth) > -0.2);
        simulation.remove_obstacle(ball);
        run(simulation, 120);
        CHECK(lowest(simulation, cloth) > -0.3);
        CHECK(lowest(simulation, cloth) < -0.29);
        CHECK(simulation.force_on(floor).y() == Approx(-0.2 * 0.09 * 9.81).epsilon(0.05));
        simulation.remove_cloth(cloth);
        run(simulation, 2);
        const ClothId next = simulation.add_cloth(make_grid(0.3, 0.3, 5, 5), fabric(), {.translation = {0, -0.28, 0}});
        run(simulation, 60);
        CHECK(lowest(simulation, next) > -0.3);
        CHECK(simulation.force_on(floor).y() < 0.0);
    }
}

TEST_CASE("After the middle one of three layers on a ball is removed, the upper comes to lie on the lower", "[law]") {
    Simulation simulation({}, backends().back().make_detector());
    const TriangleMesh sheet = make_grid(0.2, 0.2, 9, 9);
    std::vector<ClothId> layers;
    for (int k = 0; k < 3; ++k)
        layers.push_back(simulation.add_cloth(sheet, fabric(true), {.translation = {0.004 * k, 0.006 + 0.006 * k, 0}}));
    const ObstacleId floor = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.5});
    simulation.set_pair(layers[0], layers[1], {.thickness = 0.006});
    simulation.set_pair(layers[0], layers[2], {.thickness = 0.003});
    simulation.set_layer(layers[2], 2);
    run(simulation, 90);
    const double before = lowest(simulation, layers[2]);
    simulation.remove_cloth(layers[1]);
    CHECK(simulation.meets(layers[0], layers[2]));
    CHECK_THROWS_AS(simulation.meets(layers[0], layers[1]), SceneError);
    run(simulation, 60);
    double apart = 0.0, press = 0.0;  // mean: layers tremble
    constexpr int steps = 240;
    for (int n = 0; n < steps; ++n) {
        run(simulation, 1);
        const std::span<const Vec3> lower = simulation.positions(layers[0]), upper = simulation.positions(layers[2]);
        for (std::size_t i = 0; i < lower.size(); ++i) apart += (upper[i].y() - lower[i].y()) / (81.0 * steps);
        press -= simulation.force_on(floor).y() / steps;
    }
    CAPTURE(before, apart, press);
    CHECK(lowest(simulation, layers[2]) < before - 0.002);
    CHECK(apart > 0.75 * 0.003);  // the thickness of their own pair
    CHECK(apart < 1.1 * 0.003);
    CHECK(press == Approx(2.0 * 0.2 * 0.04 * 9.81).epsilon(0.02));
}

TEST_CASE("Self-contact may be switched on and off for a cloth: layers separate, or fall through each other", "[law]") {
    Simulation simulation({}, backends().back().make_detector());
    const TriangleMesh sheet = make_grid(0.2, 0.2, 9, 9);
    const ClothId lower = simulation.add_cloth(sheet, fabric(true), {.translation = {0, 0.006, 0}});
    const ClothId upper = simulation.add_cloth(sheet, fabric(false), {.translation = {0.004, 0.013, 0.003}});
    simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.5});
    simulation.set_fabric(upper, fabric(true));
    run(simulation, 60);
    CHECK(lowest(simulation, upper) > lowest(simulation, lower) + 0.003);
    simulation.set_fabric(upper, fabric(false));
    CHECK_FALSE(simulation.meets(lower, upper));
    run(simulation, 60);
    CHECK(lowest(simulation, upper) < lowest(simulation, lower) + 0.001);
}

TEST_CASE("A cloth of another fabric on a ball steps as one that was built with it and lies there", "[law]") {
    // Contacts have a history; from the same state both come to the same rest.
    Fabric heavy = fabric();
    heavy.area_density = 0.6;
    const auto make = [&](const Fabric& of) {
        Simulation simulation({}, backends().back().make_detector());
        simulation.add_cloth(make_grid(0.3, 0.3, 11, 11), of, {.translation = {0.02, 0.21, 0}});
        simulation.add_obstacle(make_sphere(0.2, 3), {}, {.friction = 0.4, .name = "ball"});
        return simulation;
    };
    Simulation changed = make(fabric()), built = make(heavy);
    run(changed, 30);
    const std::vector<Vec3> x = copy(changed.positions({0})), v = copy(changed.velocities({0}));
    built.set_positions({0}, x);
    built.set_velocities({0}, v);
    changed.set_fabric({0}, heavy);
    CHECK(changed.state_hash() != built.state_hash());  // stick anchors
    run(changed, 1);
    run(built, 1);
    double largest = 0.0;
    for (int i = 0; i < 121; ++i) largest = std::max(largest, (changed.positions({0})[i] - built.positions({0})[i]).norm());
    CHECK(largest < 1e-3);
    run(changed, 150);
    run(built, 150);
    CHECK(changed.force_on({0}).y() == Approx(-0.6 * 0.09 * 9.81).epsilon(0.05));
    CHECK(built.force_on({0}).y() == Approx(-0.6 * 0.09 * 9.81).epsilon(0.05));
}

TEST_CASE("A reset cloth in contact falls as it did at first, in every bit", "[law]") {
    for (const Backend& backend : backends()) {
        const auto make = [&] {
            // The automatic solver would keep the choice that contact has caused.
            Simulation simulation({.linear_solver = LinearSolver::cg}, backend.make_detector());
            simulation.add_cloth(make_grid(0.3, 0.3, 11, 11), fabric(), {.translation = {0.02, 0.24, 0}});
            simulation.add_obstacle(make_sphere(0.2, 3), {}, {.friction = 0.4, .restitution = 0.3, .name = "ball"});
            return simulation;
        };
        Simulation used = make(), fresh = make();
        run(used, 40);
        used.reset({0});
        for (int n = 0; n < 40; ++n) {
            run(used, 1);
            run(fresh, 1);
            REQUIRE(used.state_hash() == fresh.state_hash());
        }
        CHECK(used.force_on({0}) == fresh.force_on({0}));
    }
}

}  // namespace percale::test::removal_law_test
