#include "engine/forces/membrane_springs.h"

#include <Eigen/Dense>
#include <cmath>

#include "engine/linear/linear_solver.h"
#include "engine/support/thread_pool.h"
#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"

namespace percale::test::membrane_springs_test {
namespace {

/// A grid of unequal cells as a free mesh: no grid, no regular triangles.
TriangleMesh uneven_mesh() {
    TriangleMesh mesh = make_grid(0.6, 0.5, 7, 6);
    Random random(12);
    for (int r = 1; r < 5; ++r) {
        for (int c = 1; c < 6; ++c) {
            const double x = random.number(-0.03, 0.03), z = random.number(-0.03, 0.03);
            mesh.vertices[7 * r + c] += Vec3(x, 0.0, z);
        }
    }
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

/// Nearly equilateral triangles, 4 x 4 vertices 0.1 m apart.
TriangleMesh hexagonal_mesh() {
    TriangleMesh mesh;
    Random random(13);
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            const double x = random.number(-0.005, 0.005), z = random.number(-0.005, 0.005);
            mesh.vertices.emplace_back(0.1 * c + 0.05 * (r % 2) + x, 0.0, 0.0866 * r + z);
        }
    }
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const int i = 4 * r + c, below = i + 4, odd = r % 2;
            mesh.triangles.push_back({i, below + odd, i + 1});
            mesh.triangles.push_back({i + 1 - odd, below, below + 1});
        }
    }
    return mesh;
}

Eigen::Matrix2d some_gradient() {
    Eigen::Matrix2d gradient;
    gradient << 1.13, 0.07, -0.05, 0.94;
    return gradient;
}

double min_eigenvalue(const Eigen::MatrixXd& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// The sum of the forces on one edge column (x largest), whose traction is the first Piola stress F S in direction x.
Vec3 pull_on_last_column(const Strained& sheet, int columns) {
    Vec3 sum = Vec3::Zero();
    for (int i = columns - 1; i < sheet.model.vertex_count(); i += columns) sum += sheet.forces.at(i);
    return sum;
}

}  // namespace

TEST_CASE("Patch test: uniform strain gives uniform stress, that of the law, on grids of any moduli and on uneven meshes") {
    const Eigen::Matrix2d gradient = some_gradient();
    for (const bool grid : {true, false}) {
        const TriangleMesh mesh = grid ? make_grid(0.6, 0.5, 7, 6) : uneven_mesh();
        const Fabric fabric = grid ? woven_fabric() : moduli_fabric(90.0, 90.0, {}, 0.37);
        const Strained sheet(cloth_model(mesh, fabric), deformed(mesh.vertices, gradient));
        const Eigen::Vector3d strain = green_strain(gradient), stress = stress_law(fabric) * strain;
        CHECK(sheet.energy == Approx(0.5 * 0.3 * strain.dot(stress)).epsilon(1e-12));
        const double scale = 0.1 * stress.norm();
        for (int r = 1; r < 5; ++r) {
            for (int c = 1; c < 6; ++c) CHECK(sheet.forces.at(7 * r + c).norm() <= 1e-12 * scale);
        }
        Eigen::Matrix2d second_piola;
        second_piola << stress[0], stress[2], stress[2], stress[1];
        const Eigen::Vector2d traction = gradient * second_piola.col(0) * 0.5;
        const Vec3 expected = -Vec3(traction.x(), 0.0, traction.y());
        CHECK((pull_on_last_column(sheet, 7) - expected).norm() <= 1e-12 * expected.norm());
    }
}

TEST_CASE("At rest and after a rigid motion there is no force") {
    const TriangleMesh mesh = make_grid(0.4, 0.4, 6, 6);
    const Pose pose{.translation = {3.0, -1.0, 2.0}, .rotation = {0.5, -0.5, 0.5, 0.5}};
    for (const std::vector<Vec3>& places : {mesh.vertices, transform(pose, mesh.vertices)}) {
        const Strained sheet(cloth_model(mesh, woven_fabric()), places);
        for (int i = 0; i < 36; ++i) CHECK(sheet.forces.at(i).norm() <= 1e-12 * 200.0 * 0.08);
        CHECK(std::abs(sheet.energy) <= 1e-20);
    }
}

TEST_CASE("Forces are minus the slope of the energy, which both ways of summing it agree on") {
    const TriangleMesh mesh = make_grid(0.4, 0.3, 5, 4);
    const Strained sheet(cloth_model(mesh, woven_fabric()), disturbed(mesh.vertices, 1.05, 0.02, 5));
    CHECK(sheet.energy == Approx(sheet.energy_at(sheet.positions)).epsilon(1e-12));
    const double h = 1e-5;
    for (int i = 0; i < sheet.model.vertex_count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3Arrays ahead = sheet.positions, behind = sheet.positions;
            ahead.add(i, h * Vec3::Unit(axis));
            behind.add(i, -h * Vec3::Unit(axis));
            const double slope = (sheet.energy_at(ahead) - sheet.energy_at(behind)) / (2.0 * h);
            CHECK(sheet.forces.at(i)[axis] == Approx(-slope).margin(1e-6));
        }
    }
}

TEST_CASE("Internal forces have no sum and no moment") {
    const TriangleMesh mesh = make_grid(0.4, 0.3, 9, 7);
    const Strained sheet(cloth_model(mesh, woven_fabric()), disturbed(mesh.vertices, 1.0, 0.1, 6));
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.0;
    for (int i = 0; i < sheet.model.vertex_count(); ++i) {
        sum += sheet.forces.at(i);
        moment += sheet.positions.at(i).cross(sheet.forces.at(i));
        size += sheet.forces.at(i).norm();
    }
    CHECK(sum.norm() <= 1e-14 * size);
    CHECK(moment.norm() <= 1e-14 * size);
}

TEST_CASE("Where all edges pull, the matrix is the exact derivative of the forces, to the precision of floats") {
    const TriangleMesh mesh = hexagonal_mesh();
    const Fabric fabric = moduli_fabric(90.0, 90.0, {}, 0.2);
    const std::vector<Vec3> places = disturbed(mesh.vertices, 1.4, 0.002, 7);
    const Strained sheet(cloth_model(mesh, fabric), places);
    const Eigen::MatrixXd matrix = sheet.matrix();
    const double h = 1e-6;
    double largest = 0.0;
    for (int k = 0; k < matrix.cols(); ++k) {
        std::vector<Vec3> ahead = places, behind = places;
        ahead[k / 3][k % 3] += h;
        behind[k / 3][k % 3] -= h;
        const Strained after(cloth_model(mesh, fabric), ahead), before(cloth_model(mesh, fabric), behind);
        const Eigen::VectorXd slope =
            -Strained::dt * Strained::dt / (2.0 * h) * (to_dense(after.forces, 16) - to_dense(before.forces, 16));
        largest = std::max(largest, (slope - matrix.col(k)).norm());
    }
    CHECK(largest <= 1e-6 * matrix.norm());
}

TEST_CASE("The matrix is symmetric, positive semidefinite and blind to translations in any state, crumpled or inside out") {
    const TriangleMesh mesh = make_grid(0.4, 0.3, 5, 4);
    for (const double stretch : {1.2, 0.7, 0.2, -0.5}) {
        const Strained sheet(cloth_model(mesh, moduli_fabric(60.0, 12.0, 80.0, 0.6)), disturbed(mesh.vertices, stretch, 0.03, 8));
        const Eigen::MatrixXd matrix = sheet.matrix();
        CHECK((matrix - matrix.transpose()).norm() <= 1e-15 * matrix.norm());
        CHECK(min_eigenvalue(matrix) >= -1e-7 * matrix.norm());
        for (int axis = 0; axis < 3; ++axis) {
            Eigen::VectorXd shift = Eigen::VectorXd::Zero(matrix.cols());
            for (int i = axis; i < shift.size(); i += 3) shift[i] = 1.0;
            CHECK((matrix * shift).norm() <= 1e-14 * matrix.norm() * shift.norm());
        }
    }
}

TEST_CASE("Diagonal blocks are those of the matrix, and factorisation, multigrid and block Jacobi solve it") {
    const TriangleMesh mesh = make_grid(0.6, 0.6, 13, 13);
    const Strained sheet(cloth_model(mesh, woven_fabric()), disturbed(mesh.vertices, 1.05, 0.01, 9));
    const Eigen::MatrixXd matrix = sheet.matrix();
    const int count = sheet.model.vertex_count();
    Random random(10);
    Vec3Arrays b;
    b.resize(count);
    for (int i = 0; i < count; ++i) b.set(i, sheet.model.mass[i] * random.point(1.0));
    for (const LinearSolver which : {LinearSolver::direct, LinearSolver::multigrid, LinearSolver::cg}) {
        StepSolver solver;
        solver.set_model(compute, sheet.model, which);
        solver.matrix.free[0] = solver.matrix.free[12] = 0.0;
        solver.start_stage();
        solver.fill(sheet.terms, {}, no_blocks);
        for (int i = 0; i < count; ++i) {
            std::array<double, 6> block;
            for (int k = 0; k < 6; ++k) block[k] = solver.matrix.diagonal[k][i];
            const Eigen::Matrix3d expected = matrix.block<3, 3>(3 * i, 3 * i) + sheet.model.mass[i] * Eigen::Matrix3d::Identity();
            CHECK((full_block(block) - expected).norm() <= 1e-12 * expected.norm());
        }
        Vec3Arrays x;
        x.resize(count);
        const SolveReport report = solver.solve(b, {.relative_residual = 1e-8}, x);
        CHECK(report.converged);
        Eigen::VectorXd product = matrix * to_dense(x, count);
        for (int i = 0; i < count; ++i) {
            product.segment<3>(3 * i) += sheet.model.mass[i] * x.at(i) - b.at(i);
            if (solver.matrix.free[i] == 0.0) product.segment<3>(3 * i).setZero();
        }
        CHECK(product.norm() <= 3e-8 * to_dense(b, count).norm());
        if (which == LinearSolver::multigrid) CHECK(report.iterations <= 40);
    }
}

TEST_CASE("All instruction sets and any number of threads give the same bits") {
    const TriangleMesh mesh = make_grid(1.0, 1.0, 96, 90);
    Strained sheet(cloth_model(mesh, woven_fabric()), disturbed(mesh.vertices, 1.02, 0.003, 11));
    const Vec3Arrays forces = sheet.forces;
    const SpringTerms terms = sheet.terms;
    const double energy = sheet.energy;
    ThreadPool pool(2);
    for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
        if (kernels_for(set) == nullptr) continue;
        for (Workers* threads : {static_cast<Workers*>(nullptr), static_cast<Workers*>(&pool)}) {
            sheet.evaluate({.kernels = kernels_for(set), .workers = threads});
            CHECK(same_bits(sheet.forces, forces));
            CHECK(sheet.terms.values == terms.values);
            CHECK(sheet.terms.corners == terms.corners);
            CHECK(sheet.energy == energy);
        }
    }
}

}  // namespace percale::test::membrane_springs_test
