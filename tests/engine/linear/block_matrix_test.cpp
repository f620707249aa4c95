#include "engine/linear/block_matrix.h"

#include <Eigen/Dense>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/dense_system.h"

namespace percale::test::block_matrix_test {

TEST_CASE("The matrix product is that of the assembled dense matrix on the free rows, 0 on the others") {
    for (const int vertices : {2, 8, 13, 40, 90}) {
        RandomSystem system(vertices + 100u, vertices);
        for (const int size : {1, 2, vertices / 2, vertices}) system.add_outer(size, 3.0);
        system.fill();
        const Eigen::VectorXd x = system.random_vector();
        AlignedVector<double> points;
        Vec3Arrays y;
        y.resize(vertices);
        const double product = multiply(system.matrix, from_dense(x), points, y);
        Eigen::VectorXd expected = system.dense() * x;
        for (int i = 0; i < expected.size(); ++i) expected[i] *= system.matrix.free[i / 3];
        CHECK((to_dense(y, vertices) - expected).norm() <= 1e-13 * expected.norm());
        CHECK(product == Approx(x.dot(expected)).margin(1e-13 * x.norm() * expected.norm()));
        for (int i = 0; i < vertices; ++i) CHECK((system.matrix.free[i] > 0.0 || y.at(i) == Vec3::Zero()));
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

TEST_CASE("The preconditioner inverts the diagonal blocks, every contact constraint taken whole by weight") {
    RandomSystem system(2, 21);
    std::vector<Eigen::Matrix3d> blocks;
    const std::vector<CoupledBlock> contacts = std::exchange(system.contacts, {});
    const Eigen::MatrixXd dense = system.dense();
    for (int i = 0; i < 21; ++i) blocks.emplace_back(dense.block<3, 3>(3 * i, 3 * i));
    for (const CoupledBlock& contact : contacts) {
        for (int k = 0; k < 4 && contact.vertex[k] >= 0; ++k) {
            blocks[contact.vertex[k]] += contact.weight[k] * full_block(contact.k);
        }
    }
    fill_matrix(system.terms, contacts, no_blocks, system.matrix);
    const Eigen::VectorXd r = system.random_vector();
    Vec3Arrays z;
    z.resize(21);
    precondition(system.matrix, from_dense(r), z, {0, z.slices()});
    for (int i = 0; i < 21; ++i) {
        // The inverses are held in single precision.
        const Eigen::Matrix3d inverse = blocks[i].inverse();
        const Vec3 expected = system.matrix.free[i] * inverse * r.segment<3>(3 * i);
        CHECK((z.at(i) - expected).norm() <= 1e-6 * inverse.norm() * r.segment<3>(3 * i).norm());
    }
}

TEST_CASE("The block diagonal holds masses and springs, without contact and whatever is prescribed") {
    RandomSystem system(6, 27);
    system.contacts.clear();
    const Eigen::MatrixXd dense = system.dense();
    for (int i = 0; i < 27; ++i) {
        std::array<double, 6> block;
        for (int k = 0; k < 6; ++k) block[k] = system.matrix.diagonal[k][i];
        const Eigen::Matrix3d expected = dense.block<3, 3>(3 * i, 3 * i);
        CHECK((full_block(block) - expected).norm() <= 1e-13 * expected.norm());
        CHECK((full_block(inverse_block(block)) * expected - Eigen::Matrix3d::Identity()).norm() <= 1e-10);
    }
}

TEST_CASE("The filter clears prescribed vertices and padding and nothing else") {
    RandomSystem system(3, 11);
    Vec3Arrays x = from_dense(system.random_vector());
    x.x[12] = x.y[13] = x.z[15] = 7.0;
    const Vec3Arrays before = x;
    filter(system.matrix, x);
    for (int i = 0; i < 16; ++i) CHECK(x.at(i) == (i < 11 && system.matrix.free[i] > 0.0 ? before.at(i) : Vec3(Vec3::Zero())));
}

TEST_CASE("A new pattern starts free and without contacts") {
    const ClothModel model = cloth_model(make_grid(1.0, 1.0, 3, 3), sheet_fabric());
    RandomSystem system(7, 12);
    BlockMatrix& matrix = system.matrix;
    set_pattern(compute, model.adjacency, model.mass, matrix);
    REQUIRE(matrix.padded() == 16);
    for (int i = 0; i < 16; ++i) CHECK(matrix.free[i] == (i < 9 ? 1.0 : 0.0));
    CHECK(matrix.coupled.size() == 0);
    CHECK(matrix.by_vertex.empty());
}

TEST_CASE("The diagonal holds an upper bound of local outer blocks, and nothing of wide ones") {
    RandomSystem system(9, 30);
    std::fill(system.matrix.free.begin(), system.matrix.free.begin() + 30, 1.0);
    for (const int size : {1, 3, 4, 12, 13, 30}) system.add_outer(size, 3.0);
    system.fill();
    CHECK(system.matrix.local_outer == std::vector{0, 1, 2, 3});
    CHECK(system.matrix.wide_outer.size() == 2);
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::VectorXd u = system.random_vector();
        double energy = 0.0, bound = 0.0;
        for (const int number : system.matrix.local_outer) {
            const double along = dot(system.blocks.outer[number], from_dense(u));
            energy += along * along;
        }
        for (const VertexBlocks& blocks : system.matrix.by_vertex) {
            const Vec3 part = u.segment<3>(3 * blocks.vertex);
            bound += part.dot(full_block(blocks.outer) * part);
        }
        CHECK(energy <= bound * (1.0 + 1e-12));
    }
}

TEST_CASE("Refilling the matrix leaves nothing of what was there") {
    RandomSystem system(4, 19), other(5, 19);
    BlockMatrix refilled = system.matrix;
    fill_matrix(system.terms, other.contacts, no_blocks, refilled);
    fill_matrix(system.terms, {}, no_blocks, refilled);
    fill_matrix(system.terms, system.contacts, no_blocks, refilled);
    const Vec3Arrays x = from_dense(system.random_vector());
    AlignedVector<double> points;
    Vec3Arrays once, again;
    for (auto* y : {&once, &again}) y->resize(19);
    CHECK(multiply(system.matrix, x, points, once) == multiply(refilled, x, points, again));
    CHECK(same_bits(once, again));
    CHECK(refilled.inverse == system.matrix.inverse);
}

TEST_CASE("A constraint between cloths enters the product exactly and the diagonal as an upper bound") {
    RandomSystem system(8, 24);
    const CoupledBlock row{.vertex = {1, 20, 7, 13}, .weight = {1.0, -0.2, -0.5, -0.3}, .k = {5.0, 1.0, -0.5, 4.0, 0.3, 6.0}};
    std::fill(system.matrix.free.begin(), system.matrix.free.begin() + 24, 1.0);
    system.contacts = {row};
    fill_matrix(system.terms, system.contacts, no_blocks, system.matrix);
    const Eigen::VectorXd x = system.random_vector();
    AlignedVector<double> points;
    Vec3Arrays y;
    y.resize(24);
    multiply(system.matrix, from_dense(x), points, y);
    const Eigen::VectorXd expected = system.dense() * x;
    CHECK((to_dense(y, 24) - expected).norm() <= 1e-13 * expected.norm());
    REQUIRE(system.matrix.by_vertex.size() == 4);
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::VectorXd u = system.random_vector();
        Vec3 apart = Vec3::Zero();
        for (int k = 0; k < 4; ++k) apart += row.weight[k] * u.segment<3>(3 * row.vertex[k]);
        double bound = 0.0;
        for (const VertexBlocks& blocks : system.matrix.by_vertex) {
            const Vec3 part = u.segment<3>(3 * blocks.vertex);
            bound += part.dot(full_block(blocks.coupled) * part);
        }
        CHECK(apart.dot(full_block(row.k) * apart) <= bound * (1.0 + 1e-12));
    }
}

}  // namespace percale::test::block_matrix_test
