#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

namespace percale::test::contact_loads_law_test {

// The forces of cloth on its obstacles, against the exact balance of forces.

namespace {

constexpr double g = 9.81, area_density = 0.2;

Fabric fabric() {
    return {.area_density = area_density,
            .thickness = 0.005,
            .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
            .spring_damping = 2.0};
}

Simulation on_meshes(const StepSettings& settings) { return Simulation(settings, backends().back().make_detector()); }

void run(Simulation& simulation, int steps) {
    for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
}

const std::vector<StepSettings> ways_of_contact = {{}, {.contact_response = ContactResponse::projection}};

}  // namespace

TEST_CASE("Cloth at rest on a ball presses it with its weight, whatever the contact response", "[law]") {
    for (const StepSettings& settings : ways_of_contact) {
        Simulation simulation = on_meshes(settings);
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 13, 13), fabric(), {.translation = {0, 0.206, 0}});
        const ObstacleId ball = simulation.add_obstacle(make_sphere(0.2, 4), {}, {.friction = 0.5, .name = "ball"});
        CHECK(simulation.contact_loads(cloth).empty());
        run(simulation, 240);
        const Vec3 force = simulation.force_on(ball);
        const double weight = area_density * 0.09 * g;
        CAPTURE(static_cast<int>(settings.scheme), static_cast<int>(settings.contact_response), force.y());
        CHECK(force.y() == Approx(-weight).epsilon(0.01));
        CHECK(std::hypot(force.x(), force.z()) < 0.01 * weight);
        Vec3 sum = Vec3::Zero();
        for (const ContactLoad& load : simulation.contact_loads(cloth)) {
            sum -= load.force();
            // Outwards from the ball, and friction within Coulomb's cone.
            CHECK(load.normal.dot(simulation.positions(cloth)[load.vertex]) > 0.0);
            CHECK(load.friction.norm() <= 0.5 * load.normal.norm() * 1.05);
        }
        CHECK((sum - force).norm() < 1e-12 * weight);
    }
}

TEST_CASE("Cloth that sticks to a slope is held by normal force and friction in the ratio of the slope", "[law]") {
    const double angle = std::atan(0.3);
    const Rotation tilt{std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
    for (const StepSettings& settings : ways_of_contact) {
        Simulation simulation = on_meshes(settings);
        const Vec3 up = transform({.rotation = tilt}, Vec3(0, 0.005, 0));
        const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 9, 9), fabric(), {.translation = up, .rotation = tilt});
        const ObstacleId slope = simulation.add_obstacle(make_plane(1.0), {.rotation = tilt}, {.friction = 0.6});
        run(simulation, 180);
        const double weight = area_density * 0.04 * g;
        Vec3 normal = Vec3::Zero(), friction = Vec3::Zero();
        for (const ContactLoad& load : simulation.contact_loads(cloth)) {
            normal += load.normal;
            friction += load.friction;
        }
        CHECK(normal.norm() == Approx(weight * std::cos(angle)).epsilon(0.01));
        CHECK(friction.norm() == Approx(weight * std::sin(angle)).epsilon(0.01));
        CHECK((simulation.force_on(slope) - Vec3(0, -weight, 0)).norm() < 0.01 * weight);
    }
}

TEST_CASE("Cloth at rest presses a plane with its weight to a millionth, and turns it by weight times lever", "[law]") {
    for (StepSettings settings : ways_of_contact) {
        settings.newton_tolerance = 1e-10;
        settings.skip = false;  // nothing falls asleep
        Simulation simulation = on_meshes(settings);
        const Vec3 place(0.07, 0.0, -0.04);
        simulation.add_cloth(make_grid(0.2, 0.2, 9, 9), fabric(), {.translation = place + Vec3(0, 0.0045, 0)});
        const ObstacleId plane = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.5, .name = "plane"});
        run(simulation, 600);
        const double weight = area_density * 0.04 * g;
        const Vec3 force = simulation.force_on(plane), about(0.3, 0.1, 0.2);
        CAPTURE(static_cast<int>(settings.contact_response), (force - Vec3(0, -weight, 0)).norm() / weight);
        CHECK((force - Vec3(0, -weight, 0)).norm() < 1e-6 * weight);
        const Vec3 torque = simulation.torque_on(plane, about), exact = (place - about).cross(Vec3(0, -weight, 0));
        CAPTURE((torque - exact).norm() / exact.norm());
        CHECK((torque - exact).norm() < 1e-6 * exact.norm());
    }
}

TEST_CASE("A plate balanced off the top of a ball turns the ball by weight times lever, to a millionth", "[law]") {
    for (StepSettings settings : ways_of_contact) {
        settings.newton_tolerance = 1e-10;
        settings.skip = false;
        Simulation simulation = on_meshes(settings);
        Fabric plate = fabric();
        plate.springs.bend = 0.0;
        plate.bend_stiffness = 1.0;  // 0.15 m of it bend by a micrometre
        const Vec3 centre(0.2, -0.1, 0.4);
        const ClothId cloth =
            simulation.add_cloth(make_grid(0.15, 0.15, 7, 7), plate, {.translation = centre + Vec3(0.03, 0.206, 0)});
        const ObstacleId ball =
            simulation.add_obstacle(make_sphere(0.2, 4), {.translation = centre}, {.friction = 5.0, .name = "ball"});
        run(simulation, 1200);
        Vec3 lever = Vec3::Zero();
        double mass = 0.0;
        for (int i = 0; i < 49; ++i) {
            lever += simulation.masses(cloth)[i] * (simulation.positions(cloth)[i] - centre);
            mass += simulation.masses(cloth)[i];
        }
        lever /= mass;
        const Vec3 weight(0, -mass * g, 0), exact = lever.cross(weight);
        const Vec3 torque = simulation.torque_on(ball, centre);
        CAPTURE(static_cast<int>(settings.contact_response), lever.x(), simulation.largest_speed(),
                (simulation.force_on(ball) - weight).norm() / weight.norm(), (torque - exact).norm() / exact.norm());
        CHECK(lever.x() > 0.01);
        CHECK((torque - exact).norm() < 1e-6 * exact.norm());
        const Vec3 p(1, 2, 3), difference = simulation.torque_on(ball, p) - torque;
        CHECK((difference - (centre - p).cross(simulation.force_on(ball))).norm() < 1e-12);
        // By the points at which loads act.
        Vec3 sum = Vec3::Zero();
        for (const ContactLoad& load : simulation.contact_loads(cloth)) {
            sum -= (load.cloth_point - centre).cross(load.force());
            CHECK((load.obstacle_point - centre).norm() <= 0.2 + 1e-12);
            CHECK((load.obstacle_point - centre).norm() > 0.198);  // on the mesh
        }
        CHECK((sum - torque).norm() < 1e-14);
    }
}

TEST_CASE("Pressed vertices are reported with the numbers of their mesh, in order", "[law]") {
    // A free mesh has another internal order. Half of it lies on a box, the other half hangs over.
    Simulation simulation = on_meshes({});
    TriangleMesh sheet = make_grid(0.2, 0.14, 9, 7);
    sheet.grid_columns = sheet.grid_rows = 0;
    Fabric plain = fabric();
    plain.springs.shear = 0.0;
    const ClothId cloth = simulation.add_cloth(sheet, plain, {.translation = {0, 0.0545, 0}});
    simulation.add_obstacle(make_box({0.2, 0.1, 0.2}), {.translation = {-0.1, 0, 0}}, {.friction = 0.5, .name = "box"});
    run(simulation, 10);
    const std::vector<ContactLoad> loads = simulation.contact_loads(cloth);
    CHECK(loads.size() >= 20);
    int before = -1;
    for (const ContactLoad& load : loads) {
        CHECK(load.vertex > before);
        CHECK(simulation.positions(cloth)[load.vertex].x() < 0.03);
        CHECK(load.normal.y() > 0.0);
        before = load.vertex;
    }
}

TEST_CASE("Contact forces are known again in a resumed run, and unknown after cloth was placed elsewhere") {
    const auto make = [] {
        Simulation simulation = on_meshes({});
        simulation.add_cloth(make_grid(0.3, 0.3, 9, 9), fabric(), {.translation = {0, 0.206, 0}});
        simulation.add_obstacle(make_sphere(0.2, 3), {}, {.friction = 0.5, .name = "ball"});
        return simulation;
    };
    Simulation simulation = make();
    run(simulation, 20);
    const Vec3 force = simulation.force_on({0});
    REQUIRE(force.norm() > 0.0);
    Simulation resumed = make();
    resumed.restore(simulation.save());
    CHECK(resumed.force_on({0}) == force);
    CHECK(resumed.torque_on({0}, {1, 2, 3}) == simulation.torque_on({0}, {1, 2, 3}));
    const std::vector<ContactLoad> loads = simulation.contact_loads({0}), again = resumed.contact_loads({0});
    REQUIRE(again.size() == loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k) {
        CHECK(again[k].cloth_point == loads[k].cloth_point);
        CHECK(again[k].obstacle_point == loads[k].obstacle_point);
    }
    run(simulation, 1);
    run(resumed, 1);
    CHECK(resumed.force_on({0}) == simulation.force_on({0}));
    const std::span<const Vec3> positions = simulation.positions({0});
    simulation.set_positions({0}, std::vector<Vec3>(positions.begin(), positions.end()));
    CHECK(simulation.force_on({0}) == Vec3::Zero());
    CHECK_THROWS_AS(simulation.force_on({1}), SceneError);
}

}  // namespace percale::test::contact_loads_law_test
