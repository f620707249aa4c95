#include "engine/solve/block_matrix.h"

#include <Eigen/Dense>

#include "tests/support/catch.h"
#include "tests/support/dense_system.h"

namespace percale::test {

TEST_CASE("The matrix product is that of the assembled dense matrix") {
    for (const int vertices : {2, 8, 13, 40}) {
        RandomSystem system(vertices + 100u, vertices);
        const Eigen::VectorXd x = system.random_vector();
        Vectors y;
        y.resize(vertices);
        multiply(system.matrix, from_dense(x), y);
        const Eigen::VectorXd expected = system.dense() * x;
        CHECK((to_dense(y, vertices) - expected).norm() <= 1e-13 * expected.norm());
    }
}

TEST_CASE("The matrix is symmetric and positive definite, contact included") {
    RandomSystem system(1, 30);
    const Eigen::MatrixXd dense = system.dense();
    CHECK((dense - dense.transpose()).norm() == Approx(0.0).margin(1e-14 * dense.norm()));
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense, Eigen::EigenvaluesOnly).eigenvalues();
    CHECK(eigenvalues[0] > 0.0);
    CHECK(eigenvalues[0] >= 0.99 * *std::min_element(system.model.mass.begin(), system.model.mass.end()));
}

TEST_CASE("The preconditioner inverts the diagonal blocks, contact included") {
    RandomSystem system(2, 21);
    const Eigen::MatrixXd dense = system.dense();
    const Eigen::VectorXd r = system.random_vector();
    Vectors z;
    z.resize(21);
    precondition(system.matrix, from_dense(r), z);
    for (int i = 0; i < 21; ++i) {
        const Vec3 expected = system.matrix.free[i] * dense.block<3, 3>(3 * i, 3 * i).inverse() * r.segment<3>(3 * i);
        CHECK((z.at(i) - expected).norm() <= 1e-11 * (expected.norm() + 1e-3 * r.norm()));
    }
}

TEST_CASE("The filter clears prescribed vertices and padding and nothing else") {
    RandomSystem system(3, 11);
    Vectors x = from_dense(system.random_vector());
    x.x[12] = x.y[13] = x.z[15] = 7.0;
    const Vectors before = x;
    filter(system.matrix, x);
    for (int i = 0; i < 16; ++i) CHECK(x.at(i) == (i < 11 && system.matrix.free[i] > 0.0 ? before.at(i) : Vec3(Vec3::Zero())));
}

TEST_CASE("A new pattern starts free and empty") {
    const ClothModel model = cloth_model(make_grid(1.0, 1.0, 3, 3), sheet_fabric());
    BlockMatrix matrix;
    set_pattern(model.adjacency, matrix);
    for (int i = 0; i < 16; ++i) CHECK(matrix.free[i] == (i < 9 ? 1.0 : 0.0));
    CHECK(matrix.a == std::vector<double>(model.adjacency.other.size(), 0.0));
    CHECK(matrix.diagonal[0] == std::vector<double>(16, 0.0));
}

TEST_CASE("Refilling the matrix leaves nothing of what was there") {
    RandomSystem system(4, 19), other(5, 19);
    BlockMatrix refilled = system.matrix;
    fill_matrix(other.model.mass, system.terms, refilled);
    fill_matrix(system.model.mass, system.terms, refilled);
    set_contacts({}, refilled);
    set_contacts(system.contacts, refilled);
    const Vectors x = from_dense(system.random_vector());
    Vectors once, again;
    for (auto* y : {&once, &again}) y->resize(19);
    multiply(system.matrix, x, once);
    multiply(refilled, x, again);
    CHECK(same_bits(once, again));
    CHECK(refilled.inverse == system.matrix.inverse);
}

}  // namespace percale::test
