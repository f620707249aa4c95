#include "engine/plan/plan_costs.h"

#include <malloc.h>

#include <optional>

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::plan_costs_test {
namespace {

/// Bytes that the program holds; 0 where the allocator does not report them (sanitizers bring their own).
double allocated() {
    const auto figures = mallinfo2();
    return static_cast<double>(figures.uordblks) + static_cast<double>(figures.hblkhd);
}

/// Predicted over allocated memory of a simulation that has run some steps.
std::optional<double> memory_ratio(const TriangleMesh& mesh, const Fabric& fabric, const StepSettings& settings) {
    const double before = allocated();
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(mesh, fabric);
    simulation.pin(cloth, 0);
    simulation.pin(cloth, 1);
    for (int n = 0; n < 5; ++n) simulation.step();
    const double used = allocated() - before;
    if (used <= 0.0) return std::nullopt;
    return simulation.plan().memory_bytes / used;
}

TriangleMesh free_grid(int side) {
    TriangleMesh mesh = make_grid(1.0, 1.0, side, side);
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

double evaluations(const StepSettings& settings, const SceneFacts& facts) {
    return predicted_evaluations(make_step_plan(settings, facts), settings);
}

}  // namespace

TEST_CASE("Predicted memory is the allocated one to within a fifth") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::symplectic_euler, Scheme::rk4}) {
        for (const int side : {33, 65}) {
            for (const double bend : {0.0, 10.0}) {
                const double dt = scheme == Scheme::backward_euler ? 1.0 / 60.0 : 1e-4;
                const StepSettings settings{.time_step = dt, .scheme = scheme, .linear_solver = LinearSolver::multigrid};
                CAPTURE(static_cast<int>(scheme), side, bend);
                const Fabric fabric{.springs = {.structural = 1000.0, .shear = 500.0, .bend = bend}};
                const auto grid = memory_ratio(make_grid(1.0, 1.0, side, side), fabric, settings);
                if (!grid) return;
                CHECK(*grid == Approx(1.0).margin(0.2));
                const Fabric plain{.springs = {.structural = 1000.0, .shear = 0.0, .bend = bend}};
                CHECK(*memory_ratio(free_grid(side), plain, settings) == Approx(1.0).margin(0.2));
            }
        }
    }
}

TEST_CASE("Predicted memory grows by every triangle of cloth and obstacle only where there is contact") {
    SceneFacts facts{.cloth_vertices = 100, .cloth_triangles = 162};
    const auto memory = [&] { return predicted_memory(make_step_plan({}, facts), facts); };
    const double alone = memory();
    facts.cloth_triangles = 200;
    CHECK(memory() == alone);
    facts.obstacles = 1;
    const double near = memory();
    CHECK(near > alone);
    facts.obstacle_triangles = 1000;
    CHECK(memory() > near);
}

TEST_CASE("The predicted cost is that of the scheme, less for fewer allowed iterations, and zero where nothing is solved") {
    const SceneFacts facts{.cloth_vertices = 100};
    CHECK(evaluations({.scheme = Scheme::symplectic_euler}, facts) == 1.0);
    CHECK(evaluations({.scheme = Scheme::rk4}, facts) == 4.0);
    CHECK(evaluations({}, facts) > evaluations({.newton_iterations = 1}, facts));
    CHECK(evaluations({}, {.cloth_vertices = 100, .obstacles = 1}) > evaluations({}, facts));
    CHECK(evaluations({}, {.cloth_vertices = 100, .pinned_vertices = 100}) == 0.0);
}

}  // namespace percale::test::plan_costs_test
