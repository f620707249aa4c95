#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/skip.h"
#include "tests/support/stepped_scene.h"

namespace percale::test::start_repair_run_test {

// Starts in conflict with obstacles, through the whole of a simulation.

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
void run_clean(SteppedScene& scene, int steps, double max_strain) {
    for (int n = 0; n < steps; ++n) {
        const StepReport report = scene.simulation.step();
        REQUIRE(report.ok());
        REQUIRE(report.largest_strain < max_strain);
        REQUIRE(scene.faults() == 0);
    }
}

}  // namespace

TEST_CASE("a sheet through a sphere's middle is moved out, reported, and then simulated") {
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
        skip("no bunny00.off in " + real_mesh_folder().string() + " (PERCALE_REAL_MESHES)");
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

TEST_CASE("resolving initial penetration keeps velocities, pins and what is planned for them") {
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

TEST_CASE("a start is refused where that is requested, and where there is no exit, and nothing has moved then") {
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

namespace {

const Fabric meeting_fabric{.area_density = 0.2,
                            .thickness = 4e-3,
                            .self_contact = true,
                            .springs = {.structural = 500.0, .bend = 2.0},
                            .spring_damping = 0.5};

TriangleMesh free_grid(int columns, int rows) {
    TriangleMesh mesh = make_grid(0.4, 0.4, columns, rows);
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

/// Triangle pairs of cloth that cross, all cloths together, but for those of one stitch.
std::size_t crossings(const Simulation& simulation, const std::vector<TriangleMesh>& meshes,
                      const std::vector<Stitch>& stitches = {}) {
    TriangleMesh all;
    for (int c = 0; c < static_cast<int>(meshes.size()); ++c) {
        TriangleMesh cloth = meshes[c];
        const std::span<const Vec3> x = simulation.positions({c});
        cloth.vertices.assign(x.begin(), x.end());
        all = c == 0 ? cloth : joined(all, cloth);
    }
    return certify_cloth(all, stitches).crossing.size();
}

/// Two panels of one cloth, the second through the first, sewn edge to edge within 0.2 s.
struct SewnPanels {
    TriangleMesh mesh;
    std::vector<Stitch> stitches;
    Simulation simulation;

    explicit SewnPanels(bool contact = false)
        : simulation({.time_step = 1.0 / 60.0, .measure = StepMeasures::all, .gravity = Vec3::Zero()},
                     make_brute_force_detector()) {
        TriangleMesh second = moved(free_grid(11, 11), {0.2, 0, 0});
        for (Vec3& x : second.vertices) x.y() = 0.5 * x.x() - 0.05;
        mesh = joined(free_grid(11, 11), second);
        mesh.grid_columns = mesh.grid_rows = 0;
        for (int k = 0; k < 11; ++k) stitches.push_back({11 * k + 10, 121 + 11 * k, 121 + 11 * k, 0.0});
        simulation.add_cloth(mesh, meeting_fabric);
        simulation.add_seam({0}, {0}, stitches, {.over = 0.2, .stiffness = 500.0, .contact_while_closing = contact});
    }
    void run(int steps) {
        for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
    }
};

}  // namespace

TEST_CASE("a sheet interleaved with another is moved out of it, reported, and then simulated") {
    TriangleMesh wavy = make_grid(0.4, 0.4, 19, 19);
    for (Vec3& x : wavy.vertices) x.y() = 0.0005 + 0.005 * std::sin(22.0 * x.x()) * std::cos(17.0 * x.z());
    const std::vector<TriangleMesh> sheets = {make_grid(0.4, 0.4, 21, 21), wavy};
    const StartRule rule = GENERATE(StartRule::repair, StartRule::refuse);
    Simulation simulation({.time_step = 1.0 / 60.0, .start = rule, .gravity = Vec3::Zero()}, make_brute_force_detector());
    for (const TriangleMesh& sheet : sheets) simulation.add_cloth(sheet, meeting_fabric);
    REQUIRE(crossings(simulation, sheets) > 100);
    const std::string error = error_of([&] { simulation.prepare(); });
    if (rule == StartRule::refuse) {
        CHECK(holds(error, {"intersecting triangle pairs", "move them apart", "start = repair"}));
        CHECK(simulation.positions({1})[5] == wavy.vertices[5]);
        return;
    }
    CHECK(error == "nothing was thrown");
    CHECK(crossings(simulation, sheets) == 0);
    REQUIRE(simulation.start_repair().size() == 2);
    for (const StartMove& move : simulation.start_repair()) {
        CHECK(move.obstacle == -1);
        CHECK(move.obstacle_name == "cloth");
        CHECK(move.largest_move < 0.03);
    }
    for (int n = 0; n < 30; ++n) {
        REQUIRE(simulation.step().ok());
        REQUIRE(crossings(simulation, sheets) == 0);
    }
    CHECK(simulation.largest_strain() < 0.1);
}

TEST_CASE("panels that are sewn without contact cross until their seam has closed, and then do not") {
    SewnPanels panels;
    panels.run(11);
    CHECK(panels.simulation.start_repair().empty());
    CHECK(crossings(panels.simulation, {panels.mesh}, panels.stitches) > 0);
    while (panels.simulation.time() < 0.2) panels.run(1);
    CHECK_FALSE(panels.simulation.start_repair().empty());
    for (int n = 0; n < 30; ++n) {
        REQUIRE(crossings(panels.simulation, {panels.mesh}, panels.stitches) == 0);
        panels.run(1);
    }
    const std::vector<double> gaps = panels.simulation.seam_gaps({0});
    CHECK(*std::max_element(gaps.begin(), gaps.end()) < 1e-3);
}

TEST_CASE("a seam that is open when panels are taken apart is not closed by that") {
    SewnPanels panels(true);
    std::vector<Stitch> far;  // from the left rim to the right one, 0.6 m away
    for (int k = 0; k < 11; ++k) far.push_back({11 * k, 131 + 11 * k, 131 + 11 * k, 0.0});
    const SeamId seam = panels.simulation.add_seam({0}, {0}, far, {.over = 0.2, .stiffness = 500.0});
    const std::vector<double> before = panels.simulation.seam_gaps(seam);
    panels.simulation.prepare();
    CHECK(crossings(panels.simulation, {panels.mesh}, panels.stitches) == 0);
    const std::vector<double> after = panels.simulation.seam_gaps(seam);
    for (std::size_t k = 0; k < before.size(); ++k) CHECK(after[k] > 0.9 * before[k]);
}

TEST_CASE("a step whose seams close over cloth that cannot come apart is taken back") {
    SewnPanels panels;
    panels.run(11);
    for (int v = 0; v < 242; ++v) panels.simulation.pin({0}, v);
    const std::uint64_t before = panels.simulation.state_hash();
    const double time = panels.simulation.time();
    for (int attempt = 0; attempt < 2; ++attempt) {
        const std::string error = error_of([&] { panels.simulation.step(); });
        CHECK(holds(error, {"is sewn through itself", "no way out"}));
        CHECK(panels.simulation.time() == time);
        CHECK(panels.simulation.state_hash() == before);
        CHECK_FALSE(panels.simulation.meets({0}, {0}));
    }
    for (int v = 0; v < 242; ++v) panels.simulation.unpin({0}, v);
    const StepReport report = panels.simulation.step();
    REQUIRE(report.ok());
    CHECK(panels.simulation.meets({0}, {0}));
    CHECK(crossings(panels.simulation, {panels.mesh}, panels.stitches) == 0);
    // The report measures the cloth as it lies now.
    CHECK(report.largest_strain == panels.simulation.largest_strain());
    CHECK(report.energy.total() == Approx(panels.simulation.energy().total()));
}

TEST_CASE("panels that are sewn over a ball leave the ball and each other") {
    SewnPanels panels;
    panels.simulation.add_obstacle(make_sphere(0.05, 3), {.translation = Vec3(-0.1, -0.04, 0)}, {.name = "ball"});
    panels.run(40);
    CHECK(crossings(panels.simulation, {panels.mesh}, panels.stitches) == 0);
    bool off_ball = false, off_cloth = false;
    for (const StartMove& move : panels.simulation.start_repair()) (move.obstacle < 0 ? off_cloth : off_ball) = true;
    CHECK((off_ball && off_cloth));
    TriangleMesh cloth = panels.mesh;
    const std::span<const Vec3> x = panels.simulation.positions({0});
    cloth.vertices.assign(x.begin(), x.end());
    CHECK(certify(cloth, moved(make_sphere(0.05, 3), {-0.1, -0.04, 0}), 0.1).clean());
}

TEST_CASE("sewing without contact continues from a saved state with the same bits, before and after closing") {
    const int saved_after = GENERATE(4, 20);
    SewnPanels whole, resumed;
    whole.run(saved_after);
    const std::vector<std::byte> state = whole.simulation.save();
    resumed.simulation.restore(state);
    CHECK(resumed.simulation.start_repair().size() == whole.simulation.start_repair().size());
    whole.run(25);
    resumed.run(25);
    CHECK(resumed.simulation.state_hash() == whole.simulation.state_hash());
    // A state of the other kind is refused, and changes nothing.
    SewnPanels other(true);
    CHECK(holds(error_of([&] { other.simulation.restore(state); }), {"seams"}));
}

}  // namespace percale::test::start_repair_run_test
