#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/stepped_scene.h"

// Starts in conflict with obstacles, through the whole of a simulation.
using namespace percale;
using namespace percale::test;

namespace {

std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

bool holds(const std::string& text, const std::vector<std::string>& words) {
    return std::all_of(words.begin(), words.end(), [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

TriangleMesh tilted(TriangleMesh mesh, double angle) {
    return placed(std::move(mesh),
                  {.translation = Vec3::Zero(), .rotation = {std::cos(angle / 2), std::sin(angle / 2), 0, 0}, .scale = 1.0});
}

/// The scan 0.5 m high, centred.
TriangleMesh scaled(TriangleMesh mesh) {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) * 0.5 / (high - low).y();
    return mesh;
}

/// Strain and faults of some steps.
void run_clean(SteppedScene& scene, int steps, double most_strain) {
    for (int n = 0; n < steps; ++n) {
        const StepReport report = scene.simulation.step();
        REQUIRE(report.ok());
        REQUIRE(report.largest_strain < most_strain);
        REQUIRE(scene.faults() == 0);
    }
}

}  // namespace

TEST_CASE("a sheet through a sphere's middle is moved out, told about, and then simulated") {
    SteppedScene scene(make_grid(1, 1, 25, 25), {.time_step = 1.0 / 60.0, .measure = StepMeasures::all});
    scene.add(make_sphere(0.25, 3), "ball");
    CHECK(scene.faults() > 0);
    const std::vector<Vec3> before = scene.mesh.vertices;
    scene.simulation.prepare();
    CHECK(scene.faults() == 0);
    CHECK(scene.simulation.time() == 0.0);
    CHECK(scene.simulation.energy().kinetic == 0.0);
    REQUIRE(scene.simulation.start_repair().size() == 1);
    const StartMove move = scene.simulation.start_repair()[0];
    CHECK(move.cloth_name == "sheet");
    CHECK(move.obstacle_name == "ball");
    double largest = 0.0;
    int moved_count = 0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        const double way = (scene.simulation.positions(scene.cloth)[v] - before[v]).norm();
        largest = std::max(largest, way);
        moved_count += way > 5e-4;
    }
    CHECK(move.largest_move == largest);
    CHECK(move.vertices_moved == moved_count);
    CHECK(largest > 0.2);
    CHECK(largest < 0.35);
    run_clean(scene, 30, 0.5);
    CHECK(scene.simulation.start_repair().size() == 1);
}

TEST_CASE("a tilted sheet through a body scan is moved out and simulated") {
    const auto scan = read_off(real_mesh_folder() / "bunny00.off");
    if (!scan) {
        WARN("skipped: no bunny00.off in " << real_mesh_folder() << " (PERCALE_REAL_MESHES)");
        return;
    }
    SteppedScene scene(tilted(make_grid(1, 1, 25, 25), 0.4), {.time_step = 1.0 / 60.0, .measure = StepMeasures::all});
    scene.add(scaled(*scan), "bunny");
    run_clean(scene, 6, 0.5);
    REQUIRE(scene.simulation.start_repair().size() == 1);
    CHECK(scene.simulation.start_repair()[0].obstacle_name == "bunny");
}

TEST_CASE("two obstacles that close on a sheet end the run with both names before anything crosses") {
    SteppedScene scene(make_grid(0.3, 0.3, 7, 7), {.time_step = 1.0 / 60.0, .gravity = Vec3::Zero()});
    scene.add(make_box({0.5, 0.1, 0.5}), "press");
    scene.add(make_box({0.5, 0.1, 0.5}), "anvil");
    const auto put = [&](double gap) {
        for (int k = 0; k < 2; ++k) {
            const double y = (k == 0 ? 1.0 : -1.0) * (0.05 + gap);
            scene.simulation.move_obstacle(scene.obstacles[k], {.translation = Vec3(0, y, 0)});
        }
    };
    scene.simulation.set_positions(scene.cloth, moved(scene.mesh, {0, 3, 0}).vertices);
    put(0.04);
    REQUIRE(scene.simulation.step().ok());
    scene.simulation.set_positions(scene.cloth, scene.mesh.vertices);
    scene.simulation.set_velocities(scene.cloth, std::vector<Vec3>(49, Vec3::Zero()));
    StepReport report;
    for (int n = 1; n < 40; ++n) {
        put(0.04 - 0.002 * n);
        report = scene.simulation.step();
        REQUIRE(scene.faults() == 0);
        if (!report.ok()) break;
    }
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(holds(report.explanation(), {"press", "anvil", "close on the cloth"}));
}

TEST_CASE("a repair keeps velocities, pins and what is planned for them") {
    SteppedScene scene(make_grid(1, 1, 17, 17), {.time_step = 1.0 / 60.0});
    scene.add(make_sphere(0.2, 2), "ball");
    for (const int v : {0, 16}) scene.simulation.pin(scene.cloth, v);
    std::vector<Vec3> velocities(289, Vec3(0.1, 0.2, 0.3));
    scene.simulation.set_velocities(scene.cloth, velocities);
    velocities[0] = velocities[16] = Vec3::Zero();
    scene.simulation.move_pin(scene.cloth, 0, scene.mesh.vertices[0] + Vec3(0, 0.001, 0));
    scene.simulation.prepare();
    CHECK(scene.faults() == 0);
    CHECK(scene.simulation.positions(scene.cloth)[0] == scene.mesh.vertices[0]);
    for (std::size_t v = 0; v < 289; ++v) CHECK(scene.simulation.velocities(scene.cloth)[v] == velocities[v]);
    REQUIRE(scene.simulation.step().ok());
    CHECK(scene.simulation.positions(scene.cloth)[0] == scene.mesh.vertices[0] + Vec3(0, 0.001, 0));
    CHECK(scene.simulation.positions(scene.cloth)[16] == scene.mesh.vertices[16]);
}

TEST_CASE("a start is refused where that is asked for, and where there is no way out, nothing has moved then") {
    const TriangleMesh sheet = make_grid(1, 1, 9, 9);
    const StartRule rule = GENERATE(StartRule::refuse, StartRule::repair);
    SteppedScene scene(sheet, {.time_step = 1.0 / 60.0, .start = rule});
    scene.add(make_sphere(0.3, 3), "ball");
    if (rule == StartRule::repair) {
        // Held all around so tightly that it cannot be lifted over the ball without stretching by more than half.
        for (int v = 0; v < 81; ++v) {
            if (sheet.vertices[v].norm() > 0.31) scene.simulation.pin(scene.cloth, v);
        }
    }
    const std::uint64_t hash = scene.simulation.state_hash();
    CHECK(holds(error_of([&] { scene.simulation.prepare(); }),
                {"the cloth starts through ball", rule == StartRule::refuse ? "start = repair" : "way out", "apart"}));
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.start_repair().empty());
}

TEST_CASE("a pin that starts inside an obstacle is named, whatever the rule") {
    const StartRule rule = GENERATE(StartRule::refuse, StartRule::repair);
    SteppedScene scene(make_grid(1, 1, 9, 9), {.time_step = 1.0 / 60.0, .start = rule});
    scene.add(make_sphere(0.3, 3), "ball");
    scene.simulation.pin(scene.cloth, 40);
    CHECK(holds(error_of([&] { scene.simulation.prepare(); }), {"pinned vertex 40 of sheet", "inside ball"}));
    CHECK_THROWS_AS(scene.simulation.prepare(), StartError);
    scene.simulation.unpin(scene.cloth, 40);
    if (rule == StartRule::repair) CHECK_NOTHROW(scene.simulation.prepare());
}

TEST_CASE("a pin dragged into an obstacle ends the step with the pin's name and nothing crossed") {
    SteppedScene scene(moved(make_grid(0.4, 0.4, 9, 9), {0, 0.02, 0}), {.time_step = 1.0 / 60.0});
    scene.add(moved(make_box({1, 0.2, 1}), {0, -0.1, 0}), "table");
    scene.simulation.pin(scene.cloth, 40);
    StepReport report;
    for (int n = 0; n < 20; ++n) {
        scene.simulation.move_pin(scene.cloth, 40, scene.simulation.positions(scene.cloth)[40] - Vec3(0, 0.005, 0));
        report = scene.simulation.step();
        REQUIRE(scene.faults() == 0);
        if (!report.ok()) break;
    }
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.blocked_vertex == 40);
    CHECK(holds(report.explanation(), {"pinned vertex 40", "sheet", "table"}));
}

TEST_CASE("a start is checked where the obstacle has come to, also after steps") {
    SteppedScene scene(moved(make_grid(0.3, 0.3, 7, 7), {0, 2, 0}),
                       {.time_step = 1.0 / 60.0, .start = StartRule::refuse, .gravity = Vec3::Zero()});
    scene.add(make_box({0.5, 0.1, 0.5}), "box");
    scene.simulation.move_obstacle(scene.obstacles[0], {.translation = Vec3(0, 1, 0)});
    REQUIRE(scene.simulation.step().ok());
    scene.simulation.set_positions(scene.cloth, moved(make_grid(0.3, 0.3, 7, 7), {0, 1, 0}).vertices);
    CHECK(holds(error_of([&] { scene.simulation.prepare(); }), {"inside box"}));
    scene.simulation.set_positions(scene.cloth, make_grid(0.3, 0.3, 7, 7).vertices);
    CHECK_NOTHROW(scene.simulation.prepare());
}
