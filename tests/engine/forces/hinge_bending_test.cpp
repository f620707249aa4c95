#include "engine/forces/hinge_bending.h"

#include <Eigen/Dense>

#include "engine/forces/springs.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/bent_cloth.h"
#include "tests/support/catch.h"

namespace percale::test::hinge_bending_test {
namespace {

constexpr double dt = 1.0 / 60.0;

/// Flat, and curved at rest.
std::vector<TriangleMesh> some_meshes() { return {make_grid(0.5, 0.4, 5, 4), irregular_sheet(0.5, 300), make_sphere(0.3, 1)}; }

/// A model whose pairs have bending and no spring, so that all forces are those of hinges.
ClothModel hinges_alone(const TriangleMesh& mesh) {
    ClothModel model = bending_model(mesh);
    std::fill(model.springs.stiffness.begin(), model.springs.stiffness.end(), 0.0);
    std::fill(model.springs.damping.begin(), model.springs.damping.end(), 0.0);
    model.adjacency = make_adjacency(model.springs, model.vertex_count());
    return model;
}

struct Evaluated {
    double energy = 0.0;
    Vec3Arrays forces;
    SpringTerms terms;
};

Evaluated evaluate(const ClothModel& model, const Vec3Arrays& positions) {
    Evaluated result;
    StepSprings springs;
    set_step_springs(compute, {model.adjacency, positions, DampingForm::velocity, dt}, springs);
    Vec3Arrays still;
    still.resize(model.vertex_count());
    result.forces.resize(model.vertex_count());
    result.energy = evaluate_springs(compute, springs, {positions, still, dt}, true, result.forces, result.terms);
    result.energy += add_curved_hinges(model.hinges, positions, result.forces);
    return result;
}

std::vector<Vec3> shaken(const std::vector<Vec3>& points, double reach, unsigned seed) {
    Random random(seed);
    std::vector<Vec3> result = points;
    for (Vec3& x : result) x += random.point(reach);
    return result;
}

}  // namespace

TEST_CASE("The energy of pairs and curved hinges is the hinges' energy, and forces are minus its derivative") {
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = hinges_alone(mesh);
        const std::vector<Vec3> points = shaken(model.rest, 0.02, 5),
                                way = shaken(std::vector<Vec3>(points.size(), Vec3::Zero()), 1.0, 6);
        const Vec3Arrays x = to_vec3_arrays(points);
        const Evaluated here = evaluate(model, x);
        CHECK(here.energy == Approx(hinge_energy(model.hinges, x)).epsilon(1e-9));
        CHECK(here.energy > 0.0);
        double slope = 0.0, size = 0.0;
        for (std::size_t i = 0; i < way.size(); ++i) {
            slope -= here.forces.at(static_cast<int>(i)).dot(way[i]);
            size += here.forces.at(static_cast<int>(i)).norm();
        }
        const double h = 1e-6;
        Vec3Arrays ahead = x, behind = x;
        add_scaled(ahead, h, to_vec3_arrays(way));
        add_scaled(behind, -h, to_vec3_arrays(way));
        const double difference = (hinge_energy(model.hinges, ahead) - hinge_energy(model.hinges, behind)) / (2.0 * h);
        CHECK(difference == Approx(slope).margin(1e-6 * size));
    }
}

TEST_CASE("A curved rest shape is at rest, and has energy when opened or closed") {
    const ClothModel model = hinges_alone(make_sphere(0.3, 1));
    REQUIRE(model.hinges.curved.size() == model.hinges.all.size());
    // The dihedral angle of an icosahedron, 138.19 degrees, distributed by one subdivision.
    for (const Hinge& hinge : model.hinges.all) CHECK(std::abs(hinge.rest_angle) == Approx(0.353).margin(0.04));
    const Evaluated rest = evaluate(model, to_vec3_arrays(model.rest));
    CHECK(std::abs(rest.energy) < 1e-16);
    CHECK(std::sqrt(dot(compute, rest.forces, rest.forces)) < 1e-13);
    // Turned inside out every angle has the other sign.
    std::vector<Vec3> mirrored = model.rest;
    for (Vec3& x : mirrored) x.x() = -x.x();
    double expected = 0.0;
    for (const Hinge& hinge : model.hinges.all) expected += 2.0 * hinge.stiffness * hinge.rest_angle * hinge.rest_angle;
    CHECK(bending_energy(model, mirrored) == Approx(expected).epsilon(1e-9));
}

TEST_CASE("Forces of hinges have no sum and no moment on a cloth as a whole") {
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = hinges_alone(mesh);
        const std::vector<Vec3> points = shaken(model.rest, 0.03, 9);
        const Evaluated here = evaluate(model, to_vec3_arrays(points));
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
        double size = 0.0;
        for (int i = 0; i < model.vertex_count(); ++i) {
            force += here.forces.at(i);
            moment += points[i].cross(here.forces.at(i));
            size += here.forces.at(i).norm();
        }
        CHECK(force.norm() < 1e-12 * size);
        CHECK(moment.norm() < 1e-12 * size);
    }
}

TEST_CASE("The matrix of flat hinges is the exact one, positive semidefinite and the same everywhere") {
    for (const TriangleMesh& mesh : {make_grid(0.5, 0.4, 5, 4), equilateral_sheet(0.1, 4, 5)}) {
        const ClothModel model = hinges_alone(mesh);
        const Vec3Arrays x = to_vec3_arrays(shaken(model.rest, 0.05, 2)), flat = to_vec3_arrays(model.rest);
        const Evaluated here = evaluate(model, x);
        const int count = model.vertex_count();
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
        for (int k = 0; k < model.springs.size(); ++k) {
            const auto [a, w] = spring_block(model.adjacency, here.terms, k);
            CHECK(w.norm() == 0.0);
            const int i = model.springs.first[k], j = model.springs.second[k];
            matrix(i, i) += a;
            matrix(j, j) += a;
            matrix(i, j) -= a;
            matrix(j, i) -= a;
        }
        // Forces are linear in positions: dt^2 f = -A x.
        const double scale = matrix.cwiseAbs().maxCoeff();
        for (int i = 0; i < count; ++i) {
            Vec3 product = Vec3::Zero();
            for (int j = 0; j < count; ++j) product += matrix(i, j) * x.at(j);
            CHECK((product + dt * dt * here.forces.at(i)).norm() < 1e-5 * scale);
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
        CHECK(solver.eigenvalues().minCoeff() > -1e-6 * scale);
    }
}

}  // namespace percale::test::hinge_bending_test
