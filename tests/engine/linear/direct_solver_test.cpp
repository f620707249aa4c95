#include "engine/linear/direct_solver.h"

#include <algorithm>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/dense_system.h"

namespace percale::test::direct_solver_test {
namespace {

void check_against_dense(DirectSolver& solver, RandomSystem& system) {
    const Eigen::VectorXd b = system.random_vector(), start = system.prescribed_values(), expected = system.solve_dense(b, start);
    Vec3Arrays x = from_dense(start);
    REQUIRE(solver.solve(system.matrix, from_dense(b), x));
    CHECK((to_dense(x, system.model.vertex_count()) - expected).norm() <= 1e-9 * expected.norm());
    for (int i = 0; i < system.model.vertex_count(); ++i) {
        if (system.matrix.free[i] == 0.0) CHECK(x.at(i) == Vec3(start.segment<3>(3 * i)));
    }
}

}  // namespace

TEST_CASE("The direct solver agrees with a dense factorisation, contact included, prescribed vertices kept") {
    for (const int vertices : {2, 9, 25, 60}) {
        RandomSystem system(static_cast<unsigned>(vertices) + 200u, vertices);
        for (const int size : {1, 2, std::min(vertices, 12)}) system.add_outer(size, 3.0);
        system.fill();
        DirectSolver solver;
        CAPTURE(vertices);
        check_against_dense(solver, system);
    }
}

TEST_CASE("One direct solver follows changes of values, contacts, pins and size") {
    DirectSolver solver;
    RandomSystem system(210, 40), other(211, 25);
    check_against_dense(solver, system);
    system.positions = to_vec3_arrays(random_points(system.random, 40, 0.7));
    system.evaluate();
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    check_against_dense(solver, system);
    check_against_dense(solver, other);
    system.contacts.push_back(system.random_contact(40));
    system.contacts.push_back(system.random_contact(40));
    system.matrix.free[17] = 0.0;
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    check_against_dense(solver, system);
    DirectSolver moved = std::move(solver);
    check_against_dense(moved, system);
}

TEST_CASE("A matrix that is not positive definite is refused") {
    RandomSystem system(212, 12);
    system.matrix.free[5] = 1.0;
    system.contacts.push_back(
        {.vertex = {5, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {-1e6, 0.0, 0.0, -1e6, 0.0, -1e6}});
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    DirectSolver solver;
    Vec3Arrays x = from_dense(Eigen::VectorXd::Zero(36));
    CHECK_FALSE(solver.solve(system.matrix, from_dense(system.random_vector()), x));
}

TEST_CASE("With every vertex prescribed there is nothing to solve") {
    RandomSystem system(213, 10);
    std::fill(system.matrix.free.begin(), system.matrix.free.end(), 0.0);
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    const Eigen::VectorXd start = system.random_vector();
    Vec3Arrays x = from_dense(start);
    DirectSolver solver;
    CHECK(solver.solve(system.matrix, from_dense(system.random_vector()), x));
    CHECK(to_dense(x, 10) == start);
}

}  // namespace percale::test::direct_solver_test
