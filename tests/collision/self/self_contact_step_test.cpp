#include <algorithm>
#include <cmath>

#include "percale/certify.h"
#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::self_contact_step_test {
namespace {

constexpr double h = 0.005;

Fabric fabric_with(double friction) {
    return {.thickness = h,
            .self_contact = true,
            .friction = friction,
            .springs = {.structural = 200.0, .shear = 100.0, .bend = 2.0}};
}

Vec3 mean(std::span<const Vec3> values) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

/// A sheet of 0.6 m held everywhere and one of 0.2 m above it, turned so that no edges lie along each other.
struct SheetOnSheet {
    Simulation simulation;
    ClothId lower, upper;

    SheetOnSheet(double friction, double gap, const StepSettings& settings = {})
        : simulation(settings, make_brute_force_detector()) {
        lower = simulation.add_cloth(make_grid(0.6, 0.6, 19, 19), fabric_with(friction), {}, "table");
        for (int v = 0; v < 19 * 19; ++v) simulation.pin(lower, v);
        const Pose pose{.translation = {0.003, gap, 0.004}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}};
        upper = simulation.add_cloth(make_grid(0.2, 0.2, 7, 7), fabric_with(friction), pose, "napkin");
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) REQUIRE(simulation.step().ok());
    }
};

}  // namespace

TEST_CASE("A sheet that lies on a sheet rests between half of the thickness and the thickness") {
    SheetOnSheet scene(0.3, 0.8 * h);
    scene.run(60);
    for (const Vec3& x : scene.simulation.positions(scene.upper)) {
        CHECK(x.y() > 0.6 * h);
        CHECK(x.y() < h);
    }
    CHECK(mean(scene.simulation.velocities(scene.upper)).norm() < 1e-3);
}

TEST_CASE("A sheet that slides on a sheet is slowed down by mu g") {
    for (const double mu : {0.0, 0.2, 0.4}) {
        SheetOnSheet scene(mu, 0.9 * h);
        scene.run(20);
        const std::vector<Vec3> start(49, Vec3(0.7, 0.0, 0.3));
        scene.simulation.set_velocities(scene.upper, start);
        scene.run(4);
        const Vec3 before = mean(scene.simulation.velocities(scene.upper));
        scene.run(6);
        const Vec3 after = mean(scene.simulation.velocities(scene.upper));
        CAPTURE(mu);
        CHECK((before - after).norm() / 0.1 == Approx(mu * 9.81).epsilon(0.05).margin(0.02));
        CHECK(after.cross(start[0]).norm() < 0.02 * after.norm());
    }
}

TEST_CASE("On a slope a sheet sticks to a sheet and does not creep, or slides down as Coulomb has it") {
    const double slope = 0.3, g = 9.81;  // its tangent
    const Vec3 down = Vec3(slope, -1.0, 0.0).normalized();
    for (const double mu : {0.2, 0.35}) {
        SheetOnSheet scene(mu, 0.9 * h, {.gravity = g * down});
        scene.run(mu > slope ? 60 : 10);
        const Vec3 place = mean(scene.simulation.positions(scene.upper)), speed = mean(scene.simulation.velocities(scene.upper));
        scene.run(mu > slope ? 120 : 6);
        const Vec3 moved = mean(scene.simulation.positions(scene.upper)) - place;
        CAPTURE(mu);
        if (mu > slope) {
            CHECK(moved.norm() < 1e-4 * h);  // in 2 s
        } else {
            const double gained = mean(scene.simulation.velocities(scene.upper)).x() - speed.x();
            CHECK(gained / 0.1 == Approx(g * (down.x() + mu * down.y())).epsilon(0.05));
        }
    }
}

TEST_CASE("A split sheet, its halves side by side, falls on a ball: nothing crosses, and steps are solved") {
    const double gap = GENERATE(1e-6, 1e-5, 1e-4, 3e-4, 1e-3);
    CAPTURE(gap);
    Simulation simulation({}, make_brute_force_detector());
    simulation.add_obstacle(make_sphere(0.15, 3), {}, {.friction = 0.4});
    const TriangleMesh half = make_grid(0.3, 0.3, 7, 7);
    TriangleMesh split = joined(moved(half, {-0.15 - 0.5 * gap, 0.16, 0}), moved(half, {0.15 + 0.5 * gap, 0.16, 0}));
    split.grid_columns = split.grid_rows = 0;
    Fabric fabric = fabric_with(0.3);
    fabric.springs.shear = 0.0;
    const ClothId cloth = simulation.add_cloth(split, fabric, {}, "split");
    int contacts = 0, iterations = 0;
    for (int i = 0; i < 30; ++i) {
        const StepReport report = simulation.step();
        CHECK(report.status == StepStatus::ok);
        contacts += report.contacts;
        iterations += report.newton_iterations;
        const std::span<const Vec3> x = simulation.positions(cloth);
        REQUIRE(certify_cloth({.vertices = {x.begin(), x.end()}, .triangles = split.triangles}).crossing.empty());
    }
    CHECK(contacts > 0);
    CHECK(iterations < 600);
}

TEST_CASE("Sheets that meet in free space keep their momentum and do not pass each other") {
    Simulation simulation({.gravity = Vec3::Zero()}, make_brute_force_detector());
    const TriangleMesh sheet = make_grid(0.2, 0.2, 7, 7);
    const Pose turned{.translation = {0.01, 0.03, 0.02}, .rotation = {std::cos(0.3), 0.0, std::sin(0.3), 0.0}};
    const ClothId first = simulation.add_cloth(sheet, fabric_with(0.3), {}, "first");
    const ClothId second = simulation.add_cloth(sheet, fabric_with(0.3), turned, "second");
    simulation.set_velocities(second, std::vector<Vec3>(49, Vec3(0.1, -1.0, 0.0)));
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (const ClothId id : {first, second}) {
            for (int v = 0; v < 49; ++v) sum += simulation.masses(id)[v] * simulation.velocities(id)[v];
        }
        return sum;
    };
    const Vec3 start = momentum();
    int contacts = 0;
    for (int i = 0; i < 12; ++i) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        contacts += report.contacts;
        CHECK((momentum() - start).norm() < 1e-12 * start.norm());  // though their deformation is solved only to percents
    }
    CHECK(contacts > 0);
    CHECK(mean(simulation.velocities(first)).y() < -0.1);
    // Where they lie on each other; the rims that reach beyond go on.
    CHECK(simulation.positions(second)[24].y() > simulation.positions(first)[24].y() + 0.3 * h);
    TriangleMesh both = joined(sheet, sheet);
    for (int v = 0; v < 49; ++v) {
        both.vertices[v] = simulation.positions(first)[v];
        both.vertices[49 + v] = simulation.positions(second)[v];
    }
    CHECK(certify_cloth(both).crossing.empty());
}

TEST_CASE("A sheet that is pulled through a sheet by its pins fails by name and leaves both as they were") {
    SheetOnSheet scene(0.3, 0.02);
    for (int v = 0; v < 49; ++v) scene.simulation.pin(scene.upper, v);
    scene.run(1);
    const std::vector<Vec3> before(scene.simulation.positions(scene.upper).begin(),
                                   scene.simulation.positions(scene.upper).end());
    for (int v = 0; v < 49; ++v) scene.simulation.move_pin(scene.upper, v, before[v] - Vec3(0, 0.05, 0));
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK_THAT(report.explanation(), Catch::Contains("napkin") && Catch::Contains("through cloth"));
    for (int v = 0; v < 49; ++v) CHECK(scene.simulation.positions(scene.upper)[v] == before[v]);
}

TEST_CASE("Cloth finer than its thickness lies at rest as it was made") {
    Simulation simulation({.gravity = Vec3::Zero()}, make_brute_force_detector());
    const ClothId cloth = simulation.add_cloth(make_grid(0.02, 0.02, 21, 21), fabric_with(0.3));
    const std::vector<Vec3> before(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
    for (int i = 0; i < 5; ++i) CHECK(simulation.step().contacts == 0);
    for (std::size_t v = 0; v < before.size(); ++v) CHECK((simulation.positions(cloth)[v] - before[v]).norm() < 1e-12);
}

}  // namespace percale::test::self_contact_step_test
