#include "engine/linear/conjugate_gradient.h"

#include "tests/support/catch.h"
#include "tests/support/dense_system.h"

namespace percale::test::conjugate_gradient_test {
namespace {

double energy_norm(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) { return std::sqrt(x.dot(a * x)); }

struct Solved {
    SolveReport report;
    Eigen::VectorXd x;
};

Solved solve(const RandomSystem& system, const Eigen::VectorXd& b, const Eigen::VectorXd& start, const SolveTarget& target) {
    SolveSpace space;
    Vec3Arrays x = from_dense(start);
    const SolveReport report = solve_cg(system.matrix, from_dense(b), target, space, x);
    return {report, to_dense(x, system.model.vertex_count())};
}

double free_residual(const RandomSystem& system, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
    Eigen::VectorXd r = b - system.dense() * x;
    for (int i = 0; i < r.size(); ++i) r[i] *= system.matrix.free[i / 3];
    return r.norm();
}

}  // namespace

TEST_CASE("Conjugate gradient agrees with a dense factorisation, prescribed vertices kept") {
    for (const int vertices : {2, 9, 25, 60}) {
        RandomSystem system(vertices + 7u, vertices);
        const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
        const Solved solved = solve(system, b, start, {.relative_residual = 1e-13});
        const Eigen::VectorXd expected = system.solve_dense(b, start);
        CAPTURE(vertices, solved.report.iterations);
        CHECK(solved.report.converged);
        CHECK((solved.x - expected).norm() <= 1e-9 * expected.norm());
        for (int i = 0; i < start.size(); ++i) {
            if (system.matrix.free[i / 3] == 0.0) CHECK(solved.x[i] == start[i]);
        }
    }
}

TEST_CASE("A system that the preconditioner inverts takes one iteration") {
    // Masses and contacts of single vertices: the matrix is its block diagonal.
    RandomSystem system(31, 17);
    system.slacken();
    for (CoupledBlock& block : system.contacts) {
        block.vertex = {block.vertex[0], -1, -1, -1};
        block.weight = {1.0, 0.0, 0.0, 0.0};
    }
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
    // The inverses are held in single precision; their rounding is corrected in the second iteration.
    const Eigen::VectorXd expected = system.solve_dense(b, start);
    const Solved solved = solve(system, b, start, {.relative_residual = 1e-5});
    CHECK(solved.report.iterations == 1);
    CHECK(solved.report.converged);
    CHECK((solved.x - expected).norm() <= 1e-5 * expected.norm());
    const Solved exact = solve(system, b, start, {.relative_residual = 1e-12});
    CHECK(exact.report.iterations <= 3);
    CHECK((exact.x - expected).norm() <= 1e-11 * expected.norm());
}

TEST_CASE("Nothing to do takes no iteration") {
    RandomSystem system(32, 17);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(51);
    const Solved solved = solve(system, zero, zero, {.relative_residual = 1e-12});
    CHECK(solved.report.iterations == 0);
    CHECK(solved.report.converged);
    CHECK(solved.x == zero);
}

TEST_CASE("The residual rule stops at the residual it names") {
    RandomSystem system(33, 50);
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
    const double first = free_residual(system, b, start);
    int before = 0;
    for (const double target : {1e-1, 1e-3, 1e-6, 1e-9}) {
        const Solved solved = solve(system, b, start, {.relative_residual = target});
        CHECK(solved.report.converged);
        CHECK(free_residual(system, b, solved.x) <= target * first * (1.0 + 1e-6));
        CHECK(solved.report.iterations > before);
        before = solved.report.iterations;
        const Solved one_less = solve(system, b, start, {.relative_residual = target, .max_iterations = before - 1});
        CHECK_FALSE(one_less.report.converged);
        CHECK(free_residual(system, b, one_less.x) > target * first);
    }
}

TEST_CASE("The energy rule leaves an error of about its fraction of the solution, in the energy norm") {
    for (unsigned seed = 40; seed < 50; ++seed) {
        RandomSystem system(seed, 80);
        const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
        const Eigen::VectorXd exact = system.solve_dense(b, start);
        const Eigen::MatrixXd a = system.dense();
        const Solved solved = solve(system, b, start, {.relative_gain = 0.05});
        CHECK(solved.report.converged);
        CHECK(solved.report.iterations >= 10);
        CHECK(energy_norm(a, solved.x - exact) <= 0.05 * energy_norm(a, exact - start));
    }
}

TEST_CASE("The absolute energy rule works alone and stops sooner the more is allowed") {
    RandomSystem system(51, 80);
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
    const Eigen::MatrixXd a = system.dense();
    const Eigen::VectorXd exact = system.solve_dense(b, start);
    const double whole = energy_norm(a, exact - start);
    int before = 2000;
    for (const double ratio : {1e-4, 1e-3, 1e-2}) {
        const Solved solved = solve(system, b, start, {.absolute_gain = ratio * ratio * whole * whole});
        CHECK(solved.report.converged);
        CHECK(solved.report.iterations < before);
        CHECK(energy_norm(a, solved.x - exact) <= ratio * whole);
        before = solved.report.iterations;
    }
}

TEST_CASE("The iteration limit is kept and reported as not converged") {
    RandomSystem system(34, 50);
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
    const Solved solved = solve(system, b, start, {.relative_residual = 1e-14, .max_iterations = 3});
    CHECK(solved.report.iterations == 3);
    CHECK_FALSE(solved.report.converged);
}

TEST_CASE("A second solve in the same work space has the same bits") {
    RandomSystem system(35, 30), small(36, 5);
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values();
    SolveSpace space;
    Vec3Arrays first = from_dense(start), second = from_dense(start), other = from_dense(Eigen::VectorXd::Zero(15));
    solve_cg(system.matrix, from_dense(b), {.relative_residual = 1e-8}, space, first);
    solve_cg(small.matrix, from_dense(small.random_vector()), {.relative_residual = 1e-8}, space, other);
    solve_cg(system.matrix, from_dense(b), {.relative_residual = 1e-8}, space, second);
    CHECK(same_bits(first, second));
}

}  // namespace percale::test::conjugate_gradient_test
