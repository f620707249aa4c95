#include <cmath>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/steps.h"

// Compliant obstacles that give way to cloth where they leave it no room.
namespace percale::test::compliant_obstacle_law_test {
namespace {

constexpr double dt = 1.0 / 60.0, radius = 0.2, thickness = 0.005;

Fabric felt(bool meets_cloth) {
    Fabric fabric{.area_density = 0.2,
                  .thickness = thickness,
                  .springs = {.structural = 500.0, .shear = 100.0, .bend = 1.0},
                  .spring_damping = 0.5};
    fabric.self_contact = meets_cloth;
    return fabric;
}

struct Squeeze {
    bool left_yields = true, right_yields = true, bends = false;
    int layers = 1;
    StepSettings step = {};
};

/// Sheets that hang between two balls; the right one comes nearer until the balls would overlap by 50 mm, stays, and leaves.
struct Squeezed {
    TriangleMesh ball = make_sphere(radius, 3);
    Simulation simulation;
    std::vector<ClothId> sheets;
    ObstacleId left, right;
    int steps = 0;

    explicit Squeezed(const Squeeze& squeeze = {}, const Backend& backend = backends().back())
        : simulation(squeeze.step, backend.make_detector()) {
        const Rotation upright{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
        for (int layer = 0; layer < squeeze.layers; ++layer) {
            const Pose pose{.translation = {0.012 * layer, 0.0, 0.0}, .rotation = upright};
            sheets.push_back(simulation.add_cloth(make_grid(0.7, 0.7, 19, 19), felt(squeeze.layers > 1), pose));
            const auto x = simulation.positions(sheets.back());
            for (int v = 0; v < static_cast<int>(x.size()); ++v) {
                if (x[static_cast<std::size_t>(v)].y() > 0.34) simulation.pin(sheets.back(), v);
            }
        }
        left = simulation.add_obstacle(ball, {.translation = {-0.225, -0.1, 0.0}},
                                       {.name = "left", .deforming = squeeze.bends, .yields = squeeze.left_yields});
        right = simulation.add_obstacle(ball, right_pose(0.0), {.name = "right", .yields = squeeze.right_yields});
    }

    /// 0.45 m apart at first, 0.35 m from 0.6 s to 1 s, 0.5 m from 1.4 s on.
    static Pose right_pose(double time) {
        const double closed = std::clamp(time / 0.6, 0.0, 1.0), opened = std::clamp((time - 1.0) / 0.4, 0.0, 1.0);
        return {.translation = {0.225 - 0.1 * closed + 0.15 * opened, -0.1, 0.0}};
    }

    StepReport step() {
        simulation.move_obstacle(right, right_pose(++steps * dt));
        return simulation.step();
    }

    std::vector<Vec3> shape(ObstacleId obstacle) const {
        const auto shape = simulation.obstacle_shape(obstacle);
        return shape.empty() ? ball.vertices : std::vector<Vec3>(shape.begin(), shape.end());
    }

    /// Checks all sheets against both balls as they are.
    bool is_clean() const {
        bool clean = true;
        for (const ClothId sheet : sheets) {
            TriangleMesh cloth{.vertices = {}, .triangles = make_grid(0.7, 0.7, 19, 19).triangles};
            const auto x = simulation.positions(sheet);
            cloth.vertices.assign(x.begin(), x.end());
            for (const ObstacleId obstacle : {left, right}) {
                const std::vector<Vec3> here = shape(obstacle);
                const TriangleMesh there{transform(simulation.obstacle_pose(obstacle), here), ball.triangles};
                clean = clean && certify(cloth, there, 0.01).clean();
            }
        }
        return clean;
    }
};

struct Outcome {
    bool ok = true, clean = true;
    double yielded = 0.0;
    int pinched = 0, max_newton = 0;
    std::string reason;
};

Outcome squeeze_through(Squeezed& scene, int steps = 96) {
    Outcome outcome;
    for (int n = 0; n < steps && outcome.ok; ++n) {
        const StepReport report = scene.step();
        outcome.ok = report.ok();
        outcome.reason = report.explanation();
        outcome.clean = outcome.clean && scene.is_clean();
        outcome.yielded = std::max(outcome.yielded, report.yielded);
        outcome.pinched += report.pinched > 0 ? 1 : 0;
        outcome.max_newton = std::max(outcome.max_newton, report.newton_iterations);
    }
    return outcome;
}

}  // namespace

TEST_CASE(
    "Balls that overlap where cloth hangs between them give way by half of the overlap each, and are round again after it") {
    Squeezed scene;
    const Outcome outcome = squeeze_through(scene);
    CAPTURE(outcome.reason, outcome.yielded);
    CHECK(outcome.ok);
    CHECK(outcome.clean);
    CHECK(outcome.pinched > 30);
    // 50 mm of overlap, and the room that cloth keeps: 0.6 of two thicknesses.
    CHECK(outcome.yielded > 0.5 * (0.05 + 0.6 * 2.0 * thickness) * 0.9);
    CHECK(outcome.yielded < 0.5 * (0.05 + 2.0 * 2.0 * thickness) * 1.2);
    CHECK(scene.shape(scene.left) == scene.ball.vertices);
    CHECK(scene.shape(scene.right) == scene.ball.vertices);
}

TEST_CASE("A single compliant ball gives way by all of the overlap, and balls that are not compliant stop the step by name") {
    Squeezed one({.left_yields = false});
    const Outcome outcome = squeeze_through(one);
    CAPTURE(outcome.reason, outcome.yielded);
    CHECK(outcome.ok);
    CHECK(outcome.clean);
    CHECK(outcome.yielded > 0.05);
    CHECK(outcome.yielded < 0.09);
    CHECK(one.simulation.obstacle_shape(one.left).empty());
    Squeezed none({.left_yields = false, .right_yields = false});
    const Outcome stopped = squeeze_through(none);
    CHECK_FALSE(stopped.ok);
    CHECK(stopped.clean);
    CHECK(stopped.reason.find("close on the cloth") != std::string::npos);
}

TEST_CASE("Surfaces give way to two layers of cloth, and by projection", "[slow]") {
    Squeezed layers({.layers = 2});
    const Outcome two = squeeze_through(layers);
    CAPTURE(two.reason);
    CHECK(two.ok);
    CHECK(two.clean);
    Squeezed projected({.step = {.contact_response = ContactResponse::projection}});
    const Outcome by_projection = squeeze_through(projected);
    CAPTURE(by_projection.reason);
    CHECK(by_projection.ok);
    CHECK(by_projection.clean);
}

TEST_CASE("Giving way is the same in every bit for every tree and any number of threads, and after resuming", "[slow]") {
    std::vector<std::uint64_t> hashes;
    for (const Backend& backend : backends()) {
        for (const int threads : {1, 3}) {
            Squeezed scene({.step = {.threads = threads}}, backend);
            for (int n = 0; n < 60; ++n) REQUIRE(scene.step().ok());
            hashes.push_back(scene.simulation.state_hash());
        }
    }
    Squeezed saved, resumed;
    for (int n = 0; n < 40; ++n) REQUIRE(saved.step().ok());
    resumed.simulation.restore(saved.simulation.save());
    CHECK(same_bits(saved.shape(saved.left), resumed.shape(resumed.left)));
    CHECK(saved.shape(saved.left) != saved.ball.vertices);
    resumed.steps = 40;
    for (int n = 0; n < 20; ++n) REQUIRE(resumed.step().ok());
    hashes.push_back(resumed.simulation.state_hash());
    for (const std::uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

TEST_CASE("A compliant obstacle that need not give way equals a deforming one, in every bit") {
    Squeezed yields({.left_yields = true, .right_yields = false}),
        bends({.left_yields = false, .right_yields = false, .bends = true});
    for (int n = 0; n < 10; ++n) {
        const StepReport report = yields.step();
        REQUIRE(report.ok());
        CHECK(report.pinched == 0);
        CHECK(report.pinching == std::array{-1, -1});
        REQUIRE(bends.step().ok());
    }
    CHECK(yields.simulation.state_hash() == bends.simulation.state_hash());
    CHECK(yields.shape(yields.left) == yields.ball.vertices);
}

TEST_CASE("Deflections of a pinch that lasts stay as they are, in every bit, and one body pinches with its own parts", "[slow]") {
    // Two balls in one mesh that come together about a small sheet that lies on nothing else.
    TriangleMesh jaws = make_sphere(radius, 3);
    const std::vector<Vec3> ball = jaws.vertices;
    const auto shape = [&](double gap) {
        std::vector<Vec3> both;
        for (const double side : {-1.0, 1.0})
            for (const Vec3& x : ball) both.emplace_back(x + Vec3(0.0, side * (radius + 0.5 * gap), 0.0));
        return both;
    };
    const std::size_t count = jaws.triangles.size();
    const int shift = static_cast<int>(ball.size());
    for (std::size_t i = 0; i < count; ++i)
        jaws.triangles.push_back({jaws.triangles[i][0] + shift, jaws.triangles[i][1] + shift, jaws.triangles[i][2] + shift});
    jaws.vertices = shape(0.03);
    for (const bool yields : {true, false}) {
        Simulation simulation({}, backends().back().make_detector());
        simulation.add_cloth(make_grid(0.1, 0.1, 7, 7), felt(false));
        const ObstacleId body = simulation.add_obstacle(jaws, {}, {.name = "jaws", .deforming = true, .yields = yields});
        StepReport report;
        std::vector<Vec3> before;
        int same = 0;  // last steps in which no vertex moved
        for (int n = 1; n <= 160 && report.ok(); ++n) {
            simulation.deform_obstacle(body, shape(std::max(-0.02, 0.03 - 0.001 * n)));
            report = simulation.step();
            const auto now = simulation.obstacle_shape(body);
            same = std::ranges::equal(now, before) ? same + 1 : 0;
            before.assign(now.begin(), now.end());
        }
        CAPTURE(report.explanation());
        CHECK(report.ok() == yields);
        if (yields) {
            CHECK(same > 20);
            CHECK((report.pinched > 0 || report.slept));
            CHECK(report.yielded > 0.01);
            continue;
        }
        CHECK(report.explanation().find("parts of obstacle 0 (jaws) close on the cloth") != std::string::npos);
    }
}

}  // namespace percale::test::compliant_obstacle_law_test
