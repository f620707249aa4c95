// Prints the cost of one linear solve on systems of steps of 1/60 s, on grids and on free meshes: multigrid and block Jacobi of
// the engine beside Eigen's simplicial Cholesky factorisation and Eigen's conjugate gradient (CHOLMOD's supernodal factorisation
// too where it was found). All get the same matrix and right side; the residual is that of the engine's product in double
// precision for every solver.
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#ifdef PERCALE_HAS_CHOLMOD
#include <Eigen/CholmodSupport>
#endif
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/forces/total_force.h"
#include "engine/linear/linear_solver.h"
#include "percale/simulation.h"
#include "tests/bench/bench_report.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::Vec3;
using percale::Vec3Arrays;
using percale::test::Figures;
using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;  // Eigen's product is fastest by rows

constexpr double dt = 1.0 / 60.0;         // s
constexpr double wanted_residual = 1e-4;  // relative

/// A cloth that is pinned and has moved for a while.
struct Scene {
    std::string name;
    percale::TriangleMesh mesh;
    percale::Fabric fabric;
    std::vector<int> pins;
    int steps;  // before the system is taken
};

Scene hanging_grid(int n) { return {"grid", percale::make_grid(1.0, 1.0, n, n), percale::test::bench_fabric(), {0, n - 1}, 30}; }

/// A free mesh held at the vertices nearest to two upper corners of its box, a few steps into its fall.
Scene falling_mesh(const std::string& kind, int vertices) {
    const auto make = kind == "shirt"   ? percale::test::t_shirt
                      : kind == "skirt" ? percale::test::tube_skirt
                                        : +[](int count) { return percale::test::irregular_sheet(1.0, count); };
    Scene scene{kind, make(vertices), percale::test::bench_fabric(), {}, 8};
    scene.fabric.springs.shear = 0.0;
    Vec3 low = scene.mesh.vertices[0], high = low;
    for (const Vec3& x : scene.mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (const double x : {low.x(), high.x()}) {
        scene.pins.push_back(percale::test::nearest_vertex(scene.mesh, Vec3(x, high.y(), low.z())));
    }
    return scene;
}

/// The first system of the coming step: matrix terms and right side at q + dt v.
class System {
public:
    explicit System(const Scene& scene) : name(scene.name) {
        percale::Simulation simulation({.time_step = dt});
        const percale::ClothId cloth = simulation.add_cloth(scene.mesh, scene.fabric);
        for (const int pin : scene.pins) simulation.pin(cloth, pin);
        for (int step = 0; step < scene.steps; ++step) {
            const percale::StepReport report = simulation.step();
            if (!report.ok()) throw std::runtime_error(report.explanation());
        }
        percale::append_cloth(model, scene.mesh, scene.fabric, scene.name);
        percale::order_last_cloth(model);
        percale::finish_model(model);
        for (auto* vectors : {&positions_, &velocities_, &right}) vectors->resize(model.vertex_count());
        const std::span<const Vec3> positions = simulation.positions(cloth), velocities = simulation.velocities(cloth);
        for (int i = 0; i < model.vertex_count(); ++i) {
            positions_.set(i, positions[model.cloths[0].user_vertex(i)]);
            velocities_.set(i, velocities[model.cloths[0].user_vertex(i)]);
        }
        free.assign(right.padded_size(), 0.0);
        std::fill_n(free.begin(), model.vertex_count(), 1.0);
        for (const int pin : scene.pins) free[model.cloths[0].index_of(pin)] = 0.0;
        evaluate();
        for (int i = 0; i < model.vertex_count(); ++i) right.set(i, free[i] * dt * forces.total.at(i));
        percale::set_pattern(compute, model.adjacency, model.mass, matrix);
        matrix.free = free;
        percale::fill_matrix(forces.spring_terms, {}, percale::ForceBlocks(), matrix);
    }
    System(const System&) = delete;
    System& operator=(const System&) = delete;

    double relative_residual(const Vec3Arrays& x) const {
        Vec3Arrays product = x, rest = right;
        percale::AlignedVector<double> points;
        percale::multiply(matrix, x, points, product);
        percale::add_scaled(rest, -1.0, product);
        return std::sqrt(percale::dot(compute, rest, rest) / percale::dot(compute, right, right));
    }

    std::string name;
    percale::Compute compute;
    percale::ClothModel model;
    percale::Forces forces;
    percale::AlignedVector<double> free;
    Vec3Arrays right;
    percale::BlockMatrix matrix;

private:
    void evaluate() {
        percale::set_step_springs(compute, {model.adjacency, positions_, percale::DampingForm::length_rate, dt}, springs_);
        percale::add_scaled(positions_, dt, velocities_);
        percale::evaluate_forces({.compute = &compute,
                                  .model = &model,
                                  .springs = &springs_,
                                  .positions = &positions_,
                                  .velocities = &velocities_,
                                  .gravity = Vec3(0.0, -9.81, 0.0),
                                  .dt = dt,
                                  .with_matrix = true},
                                 forces);
    }

    Vec3Arrays positions_, velocities_;
    percale::StepSprings springs_;
};

/// The same matrix for Eigen, free vertices only, three rows each.
struct EigenSystem {
    std::vector<int> row;  // of a vertex, or -1
    Sparse matrix;         // both halves
    Eigen::VectorXd right;

    explicit EigenSystem(const System& system) : row(system.model.vertex_count(), -1) {
        int rows = 0;
        for (int i = 0; i < system.model.vertex_count(); ++i) {
            if (system.free[i] > 0.0) row[i] = 3 * rows++;
        }
        std::vector<Eigen::Triplet<double>> entries;
        add_diagonal(system, entries);
        add_springs(system, entries);
        matrix.resize(3 * rows, 3 * rows);
        matrix.setFromTriplets(entries.begin(), entries.end());
        right.resize(3 * rows);
        for (int i = 0; i < system.model.vertex_count(); ++i) {
            if (row[i] >= 0) right.segment<3>(row[i]) = system.right.at(i);
        }
    }

    Vec3Arrays to_vertices(const Eigen::VectorXd& x) const {
        Vec3Arrays result;
        result.resize(static_cast<int>(row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (row[i] >= 0) result.set(static_cast<int>(i), x.segment<3>(row[i]));
        }
        return result;
    }

private:
    void add_diagonal(const System& system, std::vector<Eigen::Triplet<double>>& entries) const {
        constexpr int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
        for (int i = 0; i < system.model.vertex_count(); ++i) {
            for (int k = 0; k < 9 && row[i] >= 0; ++k) {
                entries.emplace_back(row[i] + k / 3, row[i] + k % 3, system.matrix.diagonal[place[k / 3][k % 3]][i]);
            }
        }
    }
    void add_springs(const System& system, std::vector<Eigen::Triplet<double>>& entries) const {
        const percale::SpringNetwork& springs = system.model.springs;
        for (int s = 0; s < springs.size(); ++s) {
            const int i = row[springs.first[s]], j = row[springs.second[s]];
            if (i < 0 || j < 0) continue;
            const percale::SpringBlock block = percale::spring_block(system.model.adjacency, system.forces.spring_terms, s);
            for (int k = 0; k < 9; ++k) {
                const double value = -(k % 4 == 0 ? block.a : 0.0) - block.w[k / 3] * block.w[k % 3];
                entries.emplace_back(i + k / 3, j + k % 3, value);
                entries.emplace_back(j + k / 3, i + k % 3, value);
            }
        }
    }
};

/// Milliseconds of `work`: the minimum of several runs, or of one run where that takes long.
double least_ms(const std::function<void()>& work) {
    double least = percale::test::min_seconds(1, {work})[0];
    const int more = least > 1.0 ? 0 : std::clamp(static_cast<int>(0.3 / least), 2, 100);
    if (more > 0) least = std::min(least, percale::test::min_seconds(more, {work})[0]);
    return 1e3 * least;
}

/// The cost of one solver.
struct Cost {
    std::string solver;
    double setup = 0.0;  // ms, once a mesh
    double fill = 0.0;   // ms, for each matrix
    double solve = 0.0;  // ms
    int iterations = 0;
    double residual = 0.0;

    double total() const { return fill + solve; }
};

/// Cost of the engine's solver; every fill makes the coarser levels anew, as the first of a step does.
Cost measure_ours(const System& system, percale::LinearSolver choice) {
    percale::StepSolver solver;
    const auto fill = [&] {
        solver.start_stage();
        solver.fill(system.forces.spring_terms, {}, system.forces.blocks);
    };
    Cost cost{.solver = choice == percale::LinearSolver::cg ? "block Jacobi" : "multigrid"};
    const double first = 1e3 * percale::test::min_seconds(1, {[&] {
                                                              solver.set_model(system.compute, system.model, choice);
                                                              solver.matrix.free = system.free;
                                                              fill();
                                                          }})[0];
    cost.fill = least_ms(fill);
    cost.setup = std::max(0.0, first - cost.fill);
    Vec3Arrays x;
    percale::SolveReport report;
    cost.solve = least_ms([&] {
        x.resize(system.model.vertex_count());
        report = solver.solve(system.right, {.relative_residual = wanted_residual}, x);
    });
    cost.iterations = report.iterations;
    cost.residual = system.relative_residual(x);
    return cost;
}

/// A factorisation: its analysis is setup, the numbers are fill. Writing the values into Eigen's matrix is not counted.
template <class Factorisation>
Cost measure_direct(const System& system, const EigenSystem& eigen, const char* name) {
    Factorisation factorisation;
    Cost cost{.solver = name, .iterations = 1};
    cost.setup = 1e3 * percale::test::min_seconds(1, {[&] { factorisation.analyzePattern(eigen.matrix); }})[0];
    cost.fill = least_ms([&] { factorisation.factorize(eigen.matrix); });
    if (factorisation.info() != Eigen::Success) throw std::runtime_error(std::string(name) + " failed");
    Eigen::VectorXd x;
    cost.solve = least_ms([&] { x = factorisation.solve(eigen.right); });
    cost.residual = system.relative_residual(eigen.to_vertices(x));
    return cost;
}

Cost measure_eigen_cg(const System& system, const EigenSystem& eigen) {
    const SparseRows matrix = eigen.matrix;
    Eigen::ConjugateGradient<SparseRows, Eigen::Lower | Eigen::Upper, Eigen::DiagonalPreconditioner<double>> solver;
    solver.setTolerance(wanted_residual);
    Cost cost{.solver = "Eigen CG"};
    cost.fill = least_ms([&] { solver.compute(matrix); });
    Eigen::VectorXd x;
    cost.solve = least_ms([&] { x = solver.solve(eigen.right); });
    cost.iterations = static_cast<int>(solver.iterations());
    cost.residual = system.relative_residual(eigen.to_vertices(x));
    return cost;
}

std::vector<Cost> measure_all(const System& system, int max_direct) {
    std::vector<Cost> costs = {measure_ours(system, percale::LinearSolver::multigrid),
                               measure_ours(system, percale::LinearSolver::cg)};
    const EigenSystem eigen(system);
    costs.push_back(measure_eigen_cg(system, eigen));
    if (system.model.vertex_count() > max_direct) return costs;
    costs.push_back(measure_direct<Eigen::SimplicialLDLT<Sparse>>(system, eigen, "Eigen LDLT"));
#ifdef PERCALE_HAS_CHOLMOD
    costs.push_back(measure_direct<Eigen::CholmodSupernodalLLT<Sparse>>(system, eigen, "CHOLMOD"));
#endif
    return costs;
}

Figures row(const System& system, const Cost& cost, const Cost& ours) {
    const int vertices = system.model.vertex_count();
    const double ratio = cost.total() / ours.total();
    std::printf("%-9s %8d  %-12s %9.2f %9.3f %9.3f %6d %9.1e %8.2f\n", system.name.c_str(), vertices, cost.solver.c_str(),
                cost.setup, cost.fill, cost.solve, cost.iterations, cost.residual, ratio);
    return {{"mesh", system.name},           {"vertices", vertices},      {"solver", cost.solver},
            {"setup_ms", cost.setup},        {"fill_ms", cost.fill},      {"solve_ms", cost.solve},
            {"iterations", cost.iterations}, {"residual", cost.residual}, {"times_multigrid", ratio}};
}

void measure_scene(const Scene& scene, int max_direct, Figures& rows) {
    const System system(scene);
    const std::vector<Cost> costs = measure_all(system, max_direct);
    for (const Cost& cost : costs) rows.push_back(row(system, cost, costs[0]));
    std::fflush(stdout);
}

Figures measure(int largest, int max_vertices, int max_direct) {
    std::printf("%-9s %8s  %-12s %9s %9s %9s %6s %9s %8s\n", "mesh", "vertices", "solver", "setup ms", "fill ms", "solve ms",
                "iter", "residual", "times");
    Figures rows = Figures::array();
    for (const int n : {33, 65, 129, 257}) {
        if (n <= largest) measure_scene(hanging_grid(n), max_direct, rows);
    }
    for (const char* kind : {"irregular", "shirt", "skirt"}) {
        for (const int vertices : {1000, 4000, 16000}) {
            if (vertices <= max_vertices) measure_scene(falling_mesh(kind, vertices), max_direct, rows);
        }
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What one linear solve of a step costs: the engine's solvers beside Eigen's, to the same residual.",
                 "percale_linear_solvers");
    int largest = 129, vertices = 16000, direct = 20000;
    app.add_option("--largest", largest, "largest N of the grids 33, 65, 129, 257; 0: none")
        ->capture_default_str()
        ->check(CLI::Range(0, 257));
    app.add_option("--vertices", vertices, "largest free meshes of 1000, 4000, 16000 vertices; 0: none")
        ->capture_default_str()
        ->check(CLI::Range(0, 16000));
    app.add_option("--direct", direct, "most vertices that are factorised")->capture_default_str()->check(CLI::Range(0, 1000000));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(largest, vertices, direct); });
}
