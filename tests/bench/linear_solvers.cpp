// Prints what one linear solve costs: ours and Eigen's, the same system, the same residual, thread CPU time.
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>

#include "engine/solve/linear_solver.h"
#include "engine/step/world.h"
#include "percale/percale.h"
#include "tests/support/cpu_time.h"

namespace {

using namespace percale;

/// A system as it comes up in a step: a sheet that has fallen for a while.
struct System {
    ClothModel model;
    Compute compute;
    Vectors positions;
    StepSprings springs;
    Forces forces;
    AlignedVector<double> free;
    Vectors right;
};

System make_system(int vertices) {
    const Fabric fabric{.area_density = 0.2, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}, .spring_damping = 0.1};
    System system;
    const TriangleMesh mesh = make_grid(1.0, 1.0, vertices, vertices);
    Simulation simulation({.time_step = 1.0 / 240.0});
    const ClothId cloth = simulation.add_cloth(mesh, fabric);
    for (const int corner : {0, vertices - 1}) simulation.pin(cloth, corner);
    for (int step = 0; step < 120; ++step) simulation.step();
    append_cloth(system.model, mesh, fabric, "sheet");
    finish_model(system.model);
    const int count = system.model.vertex_count();
    for (auto* vectors : {&system.positions, &system.right, &system.forces.total}) vectors->resize(count);
    Vectors velocities = system.positions;
    copy_in(simulation.positions(cloth), system.positions);
    copy_in(simulation.velocities(cloth), velocities);
    const double dt = 1.0 / 60.0;
    set_step_springs(system.compute, {system.model.adjacency, system.positions, DampingForm::length_rate, dt}, system.springs);
    add_scaled(system.positions, dt, velocities);
    evaluate_forces({.compute = &system.compute,
                     .model = &system.model,
                     .springs = &system.springs,
                     .positions = &system.positions,
                     .velocities = &velocities,
                     .gravity = Vec3(0.0, -9.81, 0.0),
                     .dt = dt,
                     .with_matrix = true},
                    system.forces);
    system.free.assign(system.positions.padded_size(), 0.0);
    for (int i = 0; i < count; ++i) system.free[i] = i == 0 || i == vertices - 1 ? 0.0 : 1.0;
    for (int i = 0; i < count; ++i) system.right.set(i, system.free[i] * dt * system.forces.total.at(i));
    return system;
}

double best_time(const std::function<void()>& work) {
    double best = 1e300, total = 0.0;
    for (int k = 0; k < 3 || (total < 0.3 && k < 200); ++k) {
        const double start = test::cpu_seconds();
        work();
        const double time = test::cpu_seconds() - start;
        best = std::min(best, time);
        total += time;
    }
    return 1e3 * best;
}

double relative_residual(StepSolver& solver, const System& system, const Vectors& x) {
    Vectors product = x;
    AlignedVector<double> points;
    multiply(solver.matrix, x, points, product);
    Vectors rest = system.right;
    add_scaled(rest, -1.0, product);
    return std::sqrt(dot(system.compute, rest, rest) / dot(system.compute, system.right, system.right));
}

}  // namespace

int main(int argc, char** argv) {
    const int most = argc > 1 ? std::atoi(argv[1]) : 129;
    for (const int vertices : {33, 65, 129, 257}) {
        if (vertices > most) break;
        System system = make_system(vertices);
        for (const LinearSolver choice : {LinearSolver::multigrid, LinearSolver::cg}) {
            StepSolver solver;
            solver.set_model(system.compute, system.model, choice);
            solver.matrix.free = system.free;
            const double build = test::cpu_seconds();
            solver.fill(system.forces.spring_terms, {});
            const double built = test::cpu_seconds() - build;
            const double fill = best_time([&] { solver.fill(system.forces.spring_terms, {}); });
            Vectors x;
            SolveReport report;
            const double solve = best_time([&] {
                x.resize(system.model.vertex_count());
                report = solver.solve(system.right, {.relative_residual = 1e-4}, x);
            });
            std::printf("N %d %s: first %.2f fill %.3f solve %.3f ms, %d iterations, residual %.1e\n", vertices,
                        choice == LinearSolver::cg ? "block Jacobi" : "multigrid", 1e3 * built, fill, solve, report.iterations,
                        relative_residual(solver, system, x));
        }
    }
}
