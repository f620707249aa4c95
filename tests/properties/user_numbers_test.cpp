// Free meshes have another order in memory than in the user's mesh. All input and output of a caller has the user's numbers.
#include "engine/mesh/lumped_mass.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::user_numbers_test {
namespace {

constexpr int grid_vertices = 12;

/// A small grid and then a free sheet, 2 cm above a plane, neither in an order that the engine would choose for the sheet.
struct TwoCloths {
    Simulation simulation;
    TriangleMesh mesh = shuffled(irregular_sheet(0.5, 300));
    Pose pose{.translation = Vec3(0.0, 0.02, 0.0), .rotation = {0.6, 0.0, 0.8, 0.0}};
    ClothId grid, sheet;

    explicit TwoCloths(const StepSettings& settings = {}, std::unique_ptr<ContactDetector> detector = nullptr)
        : simulation(settings, std::move(detector)) {
        grid = simulation.add_cloth(make_grid(0.2, 0.2, 4, 3), sheet_fabric(), {.translation = Vec3(2.0, 0.02, 0.0)}, "towel");
        sheet = simulation.add_cloth(mesh, free_fabric(), pose, "sheet");
    }
    int count() const { return static_cast<int>(mesh.vertices.size()); }
};

/// The plane, with an optional invented crossing.
class CrossingDetector : public PlaneDetector {
public:
    StartFault check_start(std::span<const Vec3>) override {
        return {.obstacle = 0, .intersecting_pairs = 1, .cloth_triangle = crossing, .obstacle_triangle = 1};
    }
    int crossing = 0;
};

std::vector<Vec3> hung(const TriangleMesh& mesh, const StepSettings& settings, int steps) {
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(mesh, free_fabric());
    for (const double x : {-0.5, 0.5}) simulation.pin(cloth, nearest_vertex(mesh, Vec3(x, 0.0, -0.5)));
    for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
    return copy(simulation.positions(cloth));
}

/// The same with all vertices in the user's order.
std::vector<Vec3> hung_in_users_order(const TriangleMesh& mesh, const StepSettings& settings, int steps) {
    SolverScene scene = solver_scene(mesh, free_fabric(), settings);
    for (const double x : {-0.5, 0.5}) scene.pin(nearest_vertex(mesh, Vec3(x, 0.0, -0.5)));
    for (int n = 0; n < steps; ++n) scene.step();
    return to_points(scene.state.positions, scene.model.vertex_count());
}

}  // namespace

TEST_CASE("A free mesh moves as it would in the user's order of its vertices") {
    const TriangleMesh mesh = shuffled(irregular_sheet(1.0, 600));
    for (const Scheme scheme : basic_schemes) {
        const bool implicit = scheme == Scheme::backward_euler;
        // Iterations enough that no step is halved: near their limit rounding would decide it.
        const StepSettings settings{
            .time_step = implicit ? 1.0 / 60.0 : 2e-4, .scheme = scheme, .newton_tolerance = 1e-9, .newton_iterations = 500};
        const int steps = implicit ? 10 : 200;
        const double difference = largest_difference(hung(mesh, settings, steps), hung_in_users_order(mesh, settings, steps));
        CAPTURE(difference);
        CHECK(difference < (implicit ? 1e-7 : 1e-10));
    }
}

TEST_CASE("A mesh and the same mesh shuffled move alike to the bit") {
    const TriangleMesh mesh = irregular_sheet(1.0, 600), mixed = shuffled(mesh);
    const std::vector<Vec3> one = hung(mesh, {}, 15), other = hung(mixed, {}, 15);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) REQUIRE(one[mesh.triangles[t][k]] == other[mixed.triangles[t][k]]);
    }
}

TEST_CASE("Views show the user's vertices at every time") {
    TwoCloths scene;
    Simulation& s = scene.simulation;
    const std::vector<Vec3> start = transform(scene.pose, scene.mesh.vertices);
    TriangleMesh rest = scene.mesh;
    rest.vertices = start;
    CHECK(copy(s.positions(scene.sheet)) == start);
    const std::span<const double> masses = s.masses(scene.sheet);
    CHECK(std::vector<double>(masses.begin(), masses.end()) == lumped_masses(rest, sheet_fabric().area_density));
    REQUIRE(s.step().ok());
    // All fall alike, except for rounding.
    for (int i = 0; i < scene.count(); ++i) {
        CHECK((s.positions(scene.sheet)[i] - start[i] - Vec3(0, -9.81 / 3600, 0)).norm() < 1e-9);
    }
    CHECK(s.positions(scene.grid).size() == grid_vertices);
    CHECK((s.positions(scene.grid)[0] - Vec3(1.9, 0.02 - 9.81 / 3600, -0.1)).norm() < 1e-9);
}

TEST_CASE("Data set on a free mesh are read back, vertex by vertex") {
    TwoCloths scene;
    Simulation& s = scene.simulation;
    Random random(3);
    s.pin(scene.sheet, 17);
    const std::vector<Vec3> grid = copy(s.positions(scene.grid));
    const std::vector<Vec3> positions = random_points(random, scene.count(), 1.0);
    std::vector<Vec3> velocities = random_points(random, scene.count(), 1.0);
    s.set_positions(scene.sheet, positions);
    s.set_velocities(scene.sheet, velocities);
    velocities[17] = Vec3::Zero();
    CHECK(copy(s.positions(scene.sheet)) == positions);
    CHECK(copy(s.velocities(scene.sheet)) == velocities);
    CHECK(copy(s.positions(scene.grid)) == grid);
    CHECK(copy(s.velocities(scene.grid)) == std::vector<Vec3>(grid_vertices, Vec3::Zero()));
}

TEST_CASE("Pins of a free mesh hold, move and release the user's vertices in every scheme") {
    for (const Scheme scheme : basic_schemes) {
        TwoCloths scene({.time_step = 1e-4, .scheme = scheme});
        Simulation& s = scene.simulation;
        const std::vector<Vec3> start = copy(s.positions(scene.sheet));
        for (const int vertex : {0, 123, 250}) s.pin(scene.sheet, vertex);
        s.unpin(scene.sheet, 250);
        const Vec3 target = start[123] + Vec3(1e-5, 2e-5, -1e-5);
        s.move_pin(scene.sheet, 123, target);
        REQUIRE(s.step().ok());
        const std::span<const Vec3> positions = s.positions(scene.sheet);
        for (int i = 0; i < scene.count(); ++i) CHECK((positions[i] == start[i]) == (i == 0));
        CHECK(positions[123] == target);
        CHECK(s.velocities(scene.sheet)[0] == Vec3::Zero());
        CHECK(s.velocities(scene.sheet)[250] != Vec3::Zero());
        CHECK(mentions(scene_error([&] { s.unpin(scene.sheet, 250); }), {"sheet", "vertex 250", "not pinned"}));
    }
}

TEST_CASE("A cloth that is added later leaves a free mesh's state and pins with the user's vertices") {
    TwoCloths scene;
    Simulation& s = scene.simulation;
    s.pin(scene.sheet, 40);
    for (int n = 0; n < 3; ++n) REQUIRE(s.step().ok());
    const std::vector<Vec3> positions = copy(s.positions(scene.sheet)), velocities = copy(s.velocities(scene.sheet));
    const TriangleMesh ball = make_sphere(0.1, 2);
    const ClothId later = s.add_cloth(ball, free_fabric(), {.translation = Vec3(0, 5, 0)});
    CHECK(copy(s.positions(scene.sheet)) == positions);
    CHECK(copy(s.velocities(scene.sheet)) == velocities);
    CHECK(copy(s.positions(later)) == transform(Pose{.translation = Vec3(0, 5, 0)}, ball.vertices));
    REQUIRE(s.step().ok());
    CHECK(s.positions(scene.sheet)[40] == positions[40]);
    CHECK(s.positions(scene.sheet)[41] != positions[41]);
}

TEST_CASE("A blocked pin of a free mesh is named by the user's number, and the views show the state before") {
    TwoCloths scene({}, std::make_unique<PlaneDetector>());
    Simulation& s = scene.simulation;
    s.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    s.pin(scene.sheet, 7);
    s.pin(scene.sheet, 222);
    const std::vector<Vec3> start = copy(s.positions(scene.sheet));
    s.move_pin(scene.sheet, 222, start[222] - Vec3(0, 0.05, 0));
    const StepReport report = s.step();
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.blocked_cloth == scene.sheet.index);
    CHECK(report.blocked_vertex == 222);
    CHECK(mentions(report.explanation(), {"pinned vertex 222", "sheet", "floor"}));
    CHECK(copy(s.positions(scene.sheet)) == start);
}

TEST_CASE("A start inside an obstacle names the user's vertex of a free mesh") {
    TwoCloths scene({}, std::make_unique<PlaneDetector>());
    scene.simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    std::vector<Vec3> positions = copy(scene.simulation.positions(scene.sheet));
    positions[99].y() = -0.01;
    scene.simulation.set_positions(scene.sheet, positions);
    try {
        scene.simulation.prepare();
        FAIL("the start was taken");
    } catch (const StartError& error) {
        CHECK(mentions(error.what(), {"inside floor", "vertex 99 of sheet"}));
        CHECK(error.fault().inside_vertex == grid_vertices + 99);
        CHECK(error.fault().vertices_inside == 1);
    }
}

TEST_CASE("A start through an obstacle names a corner of the user's triangle") {
    auto made = std::make_unique<CrossingDetector>();
    CrossingDetector& detector = *made;
    TwoCloths scene({}, std::move(made));
    scene.simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    const int grid_triangles = static_cast<int>(make_grid(0.2, 0.2, 4, 3).triangles.size());
    detector.crossing = grid_triangles + 50;
    try {
        scene.simulation.prepare();
        FAIL("the start was taken");
    } catch (const StartError& error) {
        CHECK(mentions(error.what(), {"through floor", "vertex " + std::to_string(scene.mesh.triangles[50][0]) + " of sheet"}));
        CHECK(error.fault().cloth_triangle == grid_triangles + 50);
    }
}

}  // namespace percale::test::user_numbers_test
