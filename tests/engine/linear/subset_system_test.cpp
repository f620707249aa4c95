#include "engine/linear/subset_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/catch.h"
#include "tests/support/dense_system.h"
#include "tests/support/forces/membrane_cases.h"

namespace percale::test::subset_system_test {
namespace {

std::vector<int> free_ones_of(const BlockMatrix& matrix, std::vector<int> vertices) {
    std::erase_if(vertices, [&](int v) { return matrix.free[v] == 0.0; });
    return vertices;
}

/// A x = b of the rows and columns of these vertices, by a dense factorisation of the whole matrix's products.
Eigen::VectorXd solve_dense(const BlockMatrix& matrix, const std::vector<int>& vertices, const Eigen::VectorXd& b) {
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(vertices.size());
    Eigen::MatrixXd dense(size, size);
    Eigen::VectorXd right(size);
    AlignedVector<double> points;
    Vec3Arrays unit, product;
    for (auto* vectors : {&unit, &product}) vectors->resize(matrix.pattern->vertex_count);
    for (Eigen::Index column = 0; column < size; ++column) {
        const int vertex = vertices[column / 3];
        unit.set(vertex, Vec3::Unit(column % 3));
        multiply(matrix, unit, points, product);
        unit.set(vertex, Vec3::Zero());
        for (Eigen::Index row = 0; row < size; ++row) dense(row, column) = product.at(vertices[row / 3])[row % 3];
        right[column] = b[3 * vertex + column % 3];
    }
    return dense.ldlt().solve(right);
}

void check_against_dense(SubsetSystem& subset, const BlockMatrix& matrix, const std::vector<int>& vertices,
                         const Eigen::VectorXd& b) {
    const Eigen::VectorXd expected = solve_dense(matrix, vertices, b);
    Vec3Arrays x = from_dense(Eigen::VectorXd::Constant(b.size(), 7.0));
    subset.fill(matrix, vertices);
    CHECK(subset.solve(from_dense(b), 1e-12, x) > 0);
    double worst = 0.0;
    for (int v = 0; v < matrix.pattern->vertex_count; ++v) {
        const auto at = std::find(vertices.begin(), vertices.end(), v);
        if (at == vertices.end()) {
            REQUIRE(x.at(v) == Vec3(7.0, 7.0, 7.0));
        } else {
            worst = std::max(worst, (x.at(v) - Vec3(expected.segment<3>(3 * (at - vertices.begin())))).norm());
        }
    }
    CHECK(worst < 1e-9 * expected.norm());
}

}  // namespace

TEST_CASE("A subset is solved as its rows and columns are by a dense factorisation, contact included") {
    SubsetSystem subset;
    for (const int count : {9, 25, 60}) {
        RandomSystem system(static_cast<unsigned>(count) + 300u, count);
        CAPTURE(count);
        CoupledBlock between = system.random_contact(count);
        between.vertex = {0, 2, 4, 6};
        between.weight = {1.0, -0.2, -0.3, -0.5};
        system.contacts.push_back(between);
        for (const int size : {2, 3, count}) system.add_outer(size, 3.0);
        system.fill();
        for (const std::vector<int>& some : {std::vector<int>{4}, {0, 1, 2, 5, 8}, {8, 3, 6}}) {
            check_against_dense(subset, system.matrix, free_ones_of(system.matrix, some), system.random_vector());
        }
    }
}

TEST_CASE("A subset includes the coupling of the edges of membranes") {
    const TriangleMesh mesh = make_grid(0.6, 0.6, 9, 9);
    const Strained sheet(cloth_model(mesh, woven_fabric()), disturbed(mesh.vertices, 1.05, 0.01, 9));
    REQUIRE_FALSE(sheet.terms.corners.empty());
    BlockMatrix matrix;
    set_pattern(compute, sheet.model.adjacency, sheet.model.mass, matrix);
    fill_matrix(sheet.terms, {}, no_blocks, matrix);
    std::vector<int> vertices(20);
    std::iota(vertices.begin(), vertices.end(), 23);
    Random random(11);
    Eigen::VectorXd b(3 * 81);
    for (double& value : b) value = random.number(-1.0, 1.0);
    SubsetSystem subset;
    check_against_dense(subset, matrix, vertices, b);
}

TEST_CASE("A solve ends at the requested residual ratio, and at once where nothing is to be solved") {
    RandomSystem system(305, 60);
    std::vector<int> vertices(30);
    std::iota(vertices.begin(), vertices.end(), 0);
    SubsetSystem subset;
    subset.fill(system.matrix, free_ones_of(system.matrix, vertices));
    const Vec3Arrays b = from_dense(system.random_vector());
    const std::vector<int> free_ones = free_ones_of(system.matrix, vertices);
    Vec3Arrays x = from_dense(Eigen::VectorXd::Zero(180)), product = x;
    AlignedVector<double> points;
    for (const double ratio : {0.5, 1e-3, 1e-6}) {
        subset.solve(b, ratio, x);
        multiply(system.matrix, x, points, product);
        double left = 0.0, given = 0.0;
        for (const int v : free_ones) {
            left += (b.at(v) - product.at(v)).squaredNorm();
            given += b.at(v).squaredNorm();
        }
        CAPTURE(ratio);
        CHECK(std::sqrt(left / given) <= 1.0001 * ratio);
        CHECK(std::sqrt(left / given) > 1e-3 * ratio);
    }
    CHECK(subset.solve(from_dense(Eigen::VectorXd::Zero(180)), 0.1, x) == 0);
}

}  // namespace percale::test::subset_system_test
