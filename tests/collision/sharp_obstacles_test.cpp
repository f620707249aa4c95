#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/stepped_scene.h"

namespace percale::test::sharp_obstacles_test {
namespace {

/// Needles on a grid: three-sided, 4 mm wide at the bottom, sharp at the top.
TriangleMesh needles(int count, double spacing, double height) {
    TriangleMesh all;
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < count; ++k) {
            const Vec3 foot((i - 0.5 * (count - 1)) * spacing, -height, (k - 0.5 * (count - 1)) * spacing);
            TriangleMesh needle;
            for (int s = 0; s < 3; ++s) {
                const double angle = 2.0 * std::numbers::pi * s / 3.0;
                needle.vertices.push_back(foot + 0.002 * Vec3(std::cos(angle), 0.0, -std::sin(angle)));
            }
            needle.vertices.push_back(foot + Vec3(1e-4, height, 2e-4));
            needle.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
            all = joined(all, needle);
        }
    }
    return all;
}

/// A wedge along z whose edge, at the top, has an angle of about 0.2 degrees.
TriangleMesh knife() {
    return {
        .vertices = {{-2e-4, -0.1, -0.4}, {2e-4, -0.1, -0.4}, {0, 0, -0.4}, {-2e-4, -0.1, 0.4}, {2e-4, -0.1, 0.4}, {0, 0, 0.4}},
        .triangles = {{0, 2, 1}, {3, 4, 5}, {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}, {0, 1, 4}, {0, 4, 3}}};
}

TriangleMesh standing_on_a_corner(const Vec3& size) {
    const TriangleMesh box = make_box(size);
    const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(size, Vec3::UnitY());
    TriangleMesh turned = placed(box, {.translation = Vec3::Zero(), .rotation = {q.w(), q.x(), q.y(), q.z()}, .scale = 1.0});
    return moved(turned, {0, -0.5 * size.norm(), 0});
}

/// A half pipe along z: open, met from its hollow side and over its rims.
TriangleMesh half_pipe() {
    TriangleMesh pipe = make_grid(1.0, 0.8, 13, 5);
    for (Vec3& x : pipe.vertices) {
        const double angle = std::numbers::pi * (x.x() + 0.5);
        x = {-0.15 * std::cos(angle), -0.15 * std::sin(angle), x.z()};
    }
    return pipe;
}

struct Obstacle {
    const char* name;
    TriangleMesh mesh;
};

std::vector<Obstacle> sharp_obstacles() {
    const TriangleMesh blade{.vertices = {{-0.1, -0.2, 0.013}, {0.1, -0.2, 0.011}, {0.012, 0, 0.01}}, .triangles = {{0, 1, 2}}};
    const TriangleMesh flat{.vertices = {{-0.1, 0, -0.1}, {0.12, 0, -0.08}, {0.01, 0, 0.12}}, .triangles = {{0, 2, 1}}};
    return {{"one needle", moved(needles(1, 0.1, 0.2), {0.013, 0, 0.017})},
            {"needles", needles(4, 0.07, 0.1)},
            {"knife", knife()},
            {"upright triangle", blade},
            {"flat triangle", flat},
            {"ground of two triangles", make_plane(1.0)},
            {"box", moved(make_box({0.1, 0.1, 0.1}), {0, -0.05, 0})},
            {"box on its corner", standing_on_a_corner({0.1, 0.12, 0.14})},
            {"half pipe", half_pipe()}};
}

}  // namespace

TEST_CASE("sheets that fall on sharp and thin obstacles never cross them") {
    const double speed = GENERATE(0.0, 5.0);
    for (const Obstacle& obstacle : sharp_obstacles()) {
        CAPTURE(obstacle.name, speed);
        SteppedScene scene(moved(make_grid(0.4, 0.4, 13, 13), {0.003, 0.02, 0.001}), {.time_step = 1.0 / 60.0});
        scene.add(obstacle.mesh, obstacle.name);
        scene.simulation.set_velocities(scene.cloth, std::vector<Vec3>(169, Vec3(0.1 * speed, -speed, 0)));
        int faults = 0, bad_steps = 0, contacts = 0;
        for (int n = 0; n < 40; ++n) {
            const StepReport report = scene.simulation.step();
            bad_steps += report.ok() ? 0 : 1;
            contacts += report.contacts;
            faults += scene.faults();
        }
        CHECK(faults == 0);
        CHECK(bad_steps == 0);
        CHECK(contacts > 0);
    }
}

TEST_CASE("a sheet dragged over needles by its edge does not go through them") {
    SteppedScene scene(moved(make_grid(0.4, 0.4, 13, 13), {0, 0.01, 0}), {.time_step = 1.0 / 60.0});
    scene.add(needles(4, 0.07, 0.1), "needles");
    for (int v = 0; v < 13; ++v) scene.simulation.pin(scene.cloth, v);
    int faults = 0, bad_steps = 0;
    for (int n = 0; n < 30; ++n) {
        for (int v = 0; v < 13; ++v) {
            scene.simulation.move_pin(scene.cloth, v, scene.simulation.positions(scene.cloth)[v] - Vec3(0, 0, 1.0 / 60.0));
        }
        bad_steps += scene.simulation.step().ok() ? 0 : 1;
        faults += scene.faults();
    }
    CHECK(faults == 0);
    CHECK(bad_steps == 0);
}

}  // namespace percale::test::sharp_obstacles_test
