#include <cmath>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/steps.h"

// Obstacles whose vertices move one by one.
namespace percale::test::deforming_body_test {
namespace {

constexpr double dt = 1.0 / 60.0;

Fabric cover() {
    return {.area_density = 0.2,
            .thickness = 0.005,
            .springs = {.structural = 500.0, .shear = 100.0, .bend = 1.0},
            .spring_damping = 0.1};
}

/// A ball that breathes, nods and turns: its shape at a time, s.
std::vector<Vec3> breathing(const TriangleMesh& ball, double time) {
    std::vector<Vec3> shape;
    for (const Vec3& x : ball.vertices) {
        const double swell = 1.0 + 0.25 * std::sin(7.0 * time) * std::cos(9.0 * x.x() + 3.0 * time),
                     lean = 0.1 * std::sin(4.0 * time);
        const double angle = 2.0 * time * (0.2 + x.y());
        const Vec3 turned(std::cos(angle) * x.x() + std::sin(angle) * x.z(), x.y(),
                          std::cos(angle) * x.z() - std::sin(angle) * x.x());
        shape.push_back(swell * turned + Vec3(lean * x.y() / 0.2, 0.0, 0.0));
    }
    return shape;
}

/// A sheet on the breathing ball.
struct Breathing {
    TriangleMesh ball = make_sphere(0.2, 3);
    Simulation simulation;
    ClothId cloth;
    ObstacleId body;
    int steps = 0;

    explicit Breathing(const Backend& backend = backends().back(), StepSettings settings = {})
        : simulation(settings, backend.make_detector()) {
        cloth = simulation.add_cloth(make_grid(0.7, 0.7, 21, 21), cover(), {.translation = {0.0, 0.215, 0.0}});
        body = simulation.add_obstacle(ball, {}, {.friction = 0.5, .name = "ball", .deforming = true});
    }

    StepReport step() {
        simulation.deform_obstacle(body, breathing(ball, ++steps * dt));
        const StepReport report = simulation.step();
        CAPTURE(report.explanation());
        REQUIRE(report.ok());
        return report;
    }

    Certificate certificate() const {
        TriangleMesh here{.vertices = {}, .triangles = make_grid(0.7, 0.7, 21, 21).triangles};
        const auto x = simulation.positions(cloth);
        here.vertices.assign(x.begin(), x.end());
        TriangleMesh there = ball;
        const auto shape = simulation.obstacle_shape(body);
        there.vertices.assign(shape.begin(), shape.end());
        return certify(here, there, 0.01);
    }
};

std::string error_of(const auto& call) {
    try {
        call();
    } catch (const SceneError& error) {
        return error.what();
    }
    return {};
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Cloth on a body that deforms never crosses it, and comes as near as elsewhere", "[slow]") {
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        Breathing scene(backends().back(), {.contact_response = response});
        double nearest = 1.0;
        for (int n = 0; n < 90; ++n) {
            scene.step();
            const Certificate certificate = scene.certificate();
            CAPTURE(n);
            CHECK(certificate.clean());
            CHECK(certificate.smallest_distance > 0.0);
            nearest = std::min(nearest, certificate.smallest_distance);
        }
        CHECK(nearest < 0.005);
    }
}

TEST_CASE("A deforming body gives the same with every tree and number of threads, and resumed in every bit", "[slow]") {
    std::vector<std::uint64_t> hashes;
    for (const Backend& backend : backends()) {
        for (const int threads : {1, 3}) {
            Breathing scene(backend, {.threads = threads});
            for (int n = 0; n < 40; ++n) scene.step();
            hashes.push_back(scene.simulation.state_hash());
        }
    }
    Breathing saved, resumed;
    for (int n = 0; n < 15; ++n) saved.step();
    saved.simulation.deform_obstacle(saved.body, breathing(saved.ball, 16 * dt));  // set, not yet reached
    resumed.simulation.restore(saved.simulation.save());
    CHECK(same_bits(std::vector<Vec3>(resumed.simulation.obstacle_shape(resumed.body).begin(),
                                      resumed.simulation.obstacle_shape(resumed.body).end()),
                    breathing(saved.ball, 15 * dt)));
    REQUIRE(resumed.simulation.step().ok());
    resumed.steps = 16;
    for (int n = 0; n < 24; ++n) resumed.step();
    hashes.push_back(resumed.simulation.state_hash());
    for (const std::uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

TEST_CASE("A shape that moves as a whole carries cloth as a pose does") {
    // A plate under a sheet translates and turns: by its pose, or vertex by vertex.
    const TriangleMesh plate = make_box({0.5, 0.05, 0.5});
    const auto run = [&](bool by_shape) {
        Simulation simulation({}, backends().back().make_detector());
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 9, 9), cover(), {.translation = {0.0, 0.029, 0.0}});
        const ObstacleId body = simulation.add_obstacle(plate, {}, {.friction = 0.6, .name = "plate", .deforming = by_shape});
        for (int n = 1; n <= 60; ++n) {
            const double t = n * dt, angle = 0.3 * t * t;
            const Pose pose{.translation = {0.4 * t * t, 0.05 * t, 0.0},
                            .rotation = {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0}};
            if (by_shape) {
                simulation.deform_obstacle(body, transform(pose, std::span<const Vec3>(plate.vertices)));
            } else {
                simulation.move_obstacle(body, pose);
            }
            REQUIRE(simulation.step().ok());
        }
        const auto x = simulation.positions(cloth);
        return std::vector<Vec3>(x.begin(), x.end());
    };
    const std::vector<Vec3> rigid = run(false), bent = run(true);
    double apart = 0.0;
    for (std::size_t i = 0; i < rigid.size(); ++i) apart = std::max(apart, (rigid[i] - bent[i]).norm());
    CHECK(rigid[40].x() > 0.3);  // it was carried along
    CHECK(apart < 2e-3);
}

TEST_CASE("A body that swells by much in one step is followed in parts, or the whole step fails") {
    Breathing scene;
    for (int n = 0; n < 20; ++n) scene.step();
    std::vector<Vec3> swollen = breathing(scene.ball, 20 * dt);
    for (Vec3& x : swollen) x.y() += 0.4;
    scene.simulation.deform_obstacle(scene.body, swollen);
    const StepReport report = scene.simulation.step();
    CHECK(report.parts > 2);
    CHECK(report.ok());
    CHECK(scene.certificate().clean());
    for (Vec3& x : swollen) x.y() += 40.0;
    scene.simulation.deform_obstacle(scene.body, swollen);
    const std::uint64_t before = scene.simulation.state_hash();
    CHECK_FALSE(scene.simulation.step().ok());
    CHECK(scene.simulation.state_hash() == before);
}

TEST_CASE("A fold that is flat at first opens and holds cloth") {
    // A sheet whose vertices all lie on one line at first.
    TriangleMesh sheet = make_grid(0.6, 0.6, 4, 4);
    sheet.grid_columns = sheet.grid_rows = 0;
    TriangleMesh folded = sheet;
    for (Vec3& x : folded.vertices) x = Vec3(0.3, 0.0, x.z() + 0.1 * x.x());
    Simulation simulation({}, backends().back().make_detector());
    const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 5, 5), cover(), {.translation = {0.0, 0.4, 0.0}});
    const ObstacleId plate = simulation.add_obstacle(folded, {}, {.name = "fold", .deforming = true});
    for (int n = 1; n <= 60; ++n) {
        std::vector<Vec3> shape = sheet.vertices;
        for (std::size_t i = 0; i < shape.size(); ++i) {
            shape[i] = folded.vertices[i] + std::min(1.0, n / 10.0) * (shape[i] - folded.vertices[i]);
        }
        simulation.deform_obstacle(plate, shape);
        const StepReport report = simulation.step();
        CAPTURE(n, report.explanation());
        REQUIRE(report.ok());
    }
    for (const Vec3& x : simulation.positions(cloth)) CHECK(x.y() > 0.0);
}

TEST_CASE("A step in parts that fails is undone as a whole: the next is divided as before") {
    Breathing scene(backends().back(), {.work_limit = 40});
    for (int n = 0; n < 20; ++n) scene.step();
    std::vector<Vec3> swollen = breathing(scene.ball, 20 * dt);
    for (Vec3& x : swollen) x += Vec3(0.3, 0.5, 0.0);
    scene.simulation.deform_obstacle(scene.body, swollen);
    const std::uint64_t before = scene.simulation.state_hash();
    const StepReport first = scene.simulation.step(), second = scene.simulation.step();
    REQUIRE_FALSE(first.ok());
    CHECK(first.newton_iterations > 20);  // not all in the first part
    CHECK(second.newton_iterations == first.newton_iterations);
    CHECK(second.explanation() == first.explanation());
    CHECK(scene.simulation.state_hash() == before);
}

TEST_CASE("A shape on a pose, moved in turns by either") {
    Simulation simulation({}, backends().back().make_detector());
    const TriangleMesh ball = make_sphere(0.1, 2);
    const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 7, 7), cover(), {.translation = {1.0, 0.26, 0.0}});
    const ObstacleId body =
        simulation.add_obstacle(ball, {.translation = {1.0, 0.0, 0.0}, .scale = 2.0}, {.name = "ball", .deforming = true});
    std::vector<Vec3> flat = ball.vertices;
    for (Vec3& x : flat) x.y() *= 0.5;
    simulation.deform_obstacle(body, flat);
    REQUIRE(simulation.step().ok());
    simulation.move_obstacle(body, Pose{.translation = {1.0, 0.12, 0.0}, .scale = 2.0});
    for (int n = 0; n < 60; ++n) REQUIRE(simulation.step().ok());
    // The ball's top lies at 0.12 + 2 * 0.05.
    double highest = 0.0;
    for (const Vec3& x : simulation.positions(cloth)) highest = std::max(highest, x.y());
    CHECK(highest == Approx(0.225).margin(0.004));
}

TEST_CASE("Invalid shapes are refused by name") {
    Breathing scene;
    Simulation& simulation = scene.simulation;
    std::vector<Vec3> shape = scene.ball.vertices;
    shape.pop_back();
    CHECK(says(error_of([&] { simulation.deform_obstacle(scene.body, shape); }), "642"));
    shape = scene.ball.vertices;
    shape[7].y() = std::nan("");
    CHECK(says(error_of([&] { simulation.deform_obstacle(scene.body, shape); }), "vertex 7"));
    const ObstacleId rigid = simulation.add_obstacle(make_plane(1.0), {.translation = {0, -1, 0}}, {.name = "floor"});
    CHECK(says(error_of([&] { simulation.deform_obstacle(rigid, make_plane(1.0).vertices); }), "deforming"));
    TriangleMesh split = make_plane(1.0);
    split.vertices.push_back(split.vertices[split.triangles[0][0]]);
    split.triangles[0][0] = static_cast<int>(split.vertices.size()) - 1;
    const ObstacleId doubled =
        simulation.add_obstacle(split, {.translation = {0, -2, 0}}, {.name = "doubled", .deforming = true});
    split.vertices.back().x() += 0.1;
    const std::string parted = error_of([&] { simulation.deform_obstacle(doubled, split.vertices); });
    CHECK(says(parted, "doubled"));
    CHECK(says(parted, "part by 0.1"));
    CHECK(simulation.step().ok());  // everything is as before
}

}  // namespace percale::test::deforming_body_test
