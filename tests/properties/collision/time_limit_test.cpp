#include <algorithm>
#include <cmath>
#include <vector>

#include "percale/certify.h"
#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

namespace percale::test::time_limit_test {

// Steps that a host's time limit ends before they are solved.

namespace {

/// A sheet that falls on a ball, which moves aside, solved far more exactly than needed.
struct Falling {
    Simulation simulation;
    TriangleMesh sheet = make_grid(0.4, 0.4, 9, 9), body = make_sphere(0.12, 2);
    ClothId cloth;
    ObstacleId ball;
    double speed = 0.004;  // m a step, of the ball
    long iterations = 0;
    int late = 0, steps = 0;

    explicit Falling(StepSettings settings)
        : simulation(exact(settings), backends().back().make_detector()),
          cloth(simulation.add_cloth(sheet, {.area_density = 0.2, .springs = {.structural = 500.0, .shear = 200.0, .bend = 5.0}},
                                     {.translation = {0.0, 0.14, 0.0}})),
          ball(simulation.add_obstacle(body, {}, {.friction = 0.4, .name = "ball"})) {}

    static StepSettings exact(StepSettings settings) {
        if (!settings.adaptive) settings.newton_tolerance = 1e-7;
        settings.measure = StepMeasures::all;
        return settings;
    }

    void step() {
        simulation.move_obstacle(ball, {.translation = {speed * std::max(0, ++steps - 15), 0.0, 0.0}});
        const StepReport report = simulation.step();
        INFO(report.explanation());
        REQUIRE(report.ok());
        if (!report.out_of_time) return watch(report);
        const bool adaptive = report.status == StepStatus::tolerance_missed;
        CHECK((adaptive || report.status == StepStatus::not_converged));
        CHECK(report.explanation().find("ended by its time limit") != std::string::npos);
        watch(report);
    }

    void watch(const StepReport& report) {
        CHECK(report.largest_speed < 20.0);
        CHECK(report.largest_strain < 0.6);
        iterations += report.newton_iterations;
        late += report.out_of_time;
        sheet.vertices.assign(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        TriangleMesh there = body;
        for (Vec3& x : there.vertices) x += simulation.obstacle_pose(ball).translation;
        CHECK(certify(sheet, there, 0.0).clean());
    }
};

}  // namespace

TEST_CASE("A step whose time is up is accepted as it is: it arrives, crosses nothing, stays finite and reports so", "[slow]") {
    std::vector<StepSettings> ways(4);
    ways[1].contact_response = ContactResponse::projection;
    ways[2].scheme = Scheme::tr_bdf2;
    ways[3].adaptive = true;
    for (const StepSettings& settings : ways) {
        CAPTURE(static_cast<int>(settings.scheme), static_cast<int>(settings.contact_response), settings.adaptive);
        Falling free(settings), limited(settings);
        limited.simulation.set_time_limit(1e-6);
        if (settings.adaptive) free.speed = limited.speed = 0.0;
        for (int n = 0; n < 36; ++n) {
            free.step();
            limited.step();
        }
        CHECK(free.late == 0);
        CHECK(limited.late > 20);
        CHECK(3 * limited.iterations < 2 * free.iterations);
        CHECK(limited.simulation.time() == free.simulation.time());
        CHECK(limited.simulation.obstacle_pose(limited.ball).translation.x() == Approx(21 * limited.speed));
    }
}

TEST_CASE("A step whose time is up long before an obstacle has arrived fails and moves nothing, and a teleport succeeds") {
    const auto jump = [](double limit) {
        Falling scene({});
        for (int n = 0; n < 30; ++n) scene.step();
        const std::vector<Vec3> before(scene.simulation.positions(scene.cloth).begin(),
                                       scene.simulation.positions(scene.cloth).end());
        const Pose start = scene.simulation.obstacle_pose(scene.ball);
        scene.simulation.set_time_limit(limit);
        const Pose far{.translation = start.translation + Vec3(0.0, 1.5, 0.0)};
        scene.simulation.move_obstacle(scene.ball, far);
        const StepReport report = scene.simulation.step();
        if (limit == 0.0) {
            CHECK(report.ok());
            return report.newton_iterations;
        }
        INFO(report.explanation());
        CHECK(report.status == StepStatus::work_limit);
        CHECK(report.out_of_time);
        CHECK(report.explanation().find("teleport") != std::string::npos);
        CHECK(std::equal(before.begin(), before.end(), scene.simulation.positions(scene.cloth).begin()));
        CHECK(scene.simulation.obstacle_pose(scene.ball).translation == start.translation);
        scene.simulation.move_obstacle(scene.ball, start);  // a failed step keeps targets
        scene.simulation.teleport({&scene.cloth, 1}, {&scene.ball, 1}, {.translation = far.translation - start.translation});
        CHECK(scene.simulation.step().ok());
        return report.newton_iterations;
    };
    const int limited = jump(1e-6), free = jump(0.0);
    CHECK(limited < 40);
    CHECK(free > 2 * limited);
}

TEST_CASE("Explicit steps ignore the time limit") {
    const auto hanging = [](bool adaptive, double limit) {
        Simulation simulation({.adaptive = adaptive, .scheme = Scheme::rk4});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 7, 7), {});
        simulation.pin(cloth, 0);
        simulation.set_time_limit(limit);
        for (int n = 0; n < 10; ++n) CHECK_FALSE(simulation.step().out_of_time);
        return simulation.state_hash();
    };
    for (const bool adaptive : {false, true}) CHECK(hanging(adaptive, 1e-6) == hanging(adaptive, 0.0));
}

TEST_CASE("A time limit that is not reached, or was removed, changes no bit") {
    Falling none({}), ample({}), taken_back({});
    ample.simulation.set_time_limit(1e3);
    taken_back.simulation.set_time_limit(1e-6);
    taken_back.simulation.set_time_limit(0.0);
    for (int n = 0; n < 20; ++n) {
        for (Falling* each : {&none, &ample, &taken_back}) each->step();
    }
    CHECK(ample.simulation.state_hash() == none.simulation.state_hash());
    CHECK(taken_back.simulation.state_hash() == none.simulation.state_hash());
    for (const double wrong : {-1.0, 1e-7, 1e7, std::nan("")}) CHECK_THROWS_AS(none.simulation.set_time_limit(wrong), SceneError);
}

}  // namespace percale::test::time_limit_test
