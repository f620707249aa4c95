#include "engine/model/membrane.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"

namespace percale::test::membrane_test {
namespace {

using Corners = std::array<Eigen::Vector2d, 3>;

Eigen::Vector2d random_corner(Random& random) {
    const double x = random.number(-1.0, 1.0), y = random.number(-1.0, 1.0);
    return {x, y};
}

Eigen::Vector3d eigenvalues(const Eigen::Matrix3d& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
}

Corners equilateral(double side) { return {Eigen::Vector2d{0.0, 0.0}, {side, 0.0}, {0.5 * side, 0.5 * std::sqrt(3.0) * side}}; }

SpringNetwork network_of(const TriangleMesh& mesh, const Fabric& fabric, std::vector<MembraneTriangle>& triangles,
                         int first = 0) {
    SpringNetwork network;
    append_membrane(network, triangles, {mesh, {}}, fabric, first, "flag");
    return network;
}

TriangleMesh one_triangle(double side) {
    TriangleMesh mesh;
    mesh.vertices = {{0.0, 0.0, 0.0}, {0.0, 0.0, side}, {0.5 * std::sqrt(3.0) * side, 0.0, 0.5 * side}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

}  // namespace

TEST_CASE("Moduli give back the stress of a strip that is pulled along warp or weft") {
    const Fabric fabric = woven_fabric();
    const Eigen::Matrix3d law = stress_law(fabric), compliance = law.inverse();
    CHECK(1.0 / compliance(0, 0) == Approx(200.0));
    CHECK(1.0 / compliance(1, 1) == Approx(120.0));
    CHECK(1.0 / compliance(2, 2) == Approx(15.0));
    const double nu_12 = -compliance(1, 0) * 200.0, nu_21 = -compliance(0, 1) * 120.0;
    CHECK(std::sqrt(nu_12 * nu_21) == Approx(0.25));
    CHECK(eigenvalues(law)[0] > 0.0);
}

TEST_CASE("Without shear_stiffness equal moduli are isotropic, whatever Poisson's ratio") {
    for (const double nu : {-0.5, 0.0, 0.3, 0.9}) {
        const Fabric fabric = moduli_fabric(80.0, 80.0, {}, nu);
        CHECK(is_isotropic(fabric));
        const Eigen::Matrix3d law = stress_law(fabric);
        CHECK(law(0, 0) - law(0, 1) == Approx(2.0 * law(2, 2)));
        CHECK(is_isotropic(moduli_fabric(80.0, 80.0, 40.0 / (1.0 + nu), nu)));
        CHECK_FALSE(is_isotropic(moduli_fabric(80.0, 80.0, 30.0 / (1.0 + nu), nu)));
        CHECK_FALSE(is_isotropic(moduli_fabric(80.0, 70.0, {}, nu)));
    }
}

TEST_CASE("The energy of any triangle in any strain is its area times that of the law") {
    Random random(3);
    const Eigen::Matrix3d law = stress_law(woven_fabric());
    for (int round = 0; round < 200; ++round) {
        const Eigen::Vector2d a = random_corner(random), b = random_corner(random), c = random_corner(random);
        const Eigen::Vector2d first = b - a, second = c - a;
        const double area = 0.5 * std::abs(first.x() * second.y() - first.y() * second.x());
        if (area < 0.02) continue;
        const double xx = random.number(-0.3, 0.3), yy = random.number(-0.3, 0.3), xy = random.number(-0.3, 0.3);
        Eigen::Matrix2d strain;
        strain << xx, xy, xy, yy;
        const Eigen::Vector3d components{xx, yy, 2.0 * xy};
        const Eigen::Vector2d edges[] = {c - b, a - c, b - a};
        Eigen::Vector3d s;
        for (int e = 0; e < 3; ++e) s[e] = 2.0 * edges[e].dot(strain * edges[e]);
        const Eigen::Matrix3d stiffness = triangle_stiffness({a, b, c}, law);
        CHECK(0.5 * s.dot(stiffness * s) == Approx(0.5 * area * components.dot(law * components)).epsilon(1e-10));
        CHECK(stiffness == stiffness.transpose());
        CHECK(eigenvalues(stiffness)[0] > 0.0);
    }
}

TEST_CASE("On equilateral triangles Poisson's ratio 1/3 couples no edges: springs of 2k/sqrt(3)") {
    const double side = 0.1, young = 50.0;
    const Eigen::Matrix3d stiffness =
        triangle_stiffness(equilateral(side), stress_law(moduli_fabric(young, young, {}, 1.0 / 3.0)));
    CHECK(Eigen::Matrix3d(stiffness - Eigen::Matrix3d(stiffness.diagonal().asDiagonal())).norm() <= 1e-12 * stiffness.norm());
    // An inner edge has two triangles.
    CHECK(2.0 * 4.0 * side * side * stiffness(0, 0) == Approx(young * std::sqrt(3.0) / 2.0));
}

TEST_CASE("A grid's edges are springs without stiffness, its diagonals of the shear kind, and warp is along its rows") {
    TriangleMesh grid = make_grid(0.4, 0.3, 5, 4);
    // Turned about y by a quarter turn, with warp.
    for (Vec3& x : grid.vertices) x = Vec3(x.z(), x.y(), -x.x());
    std::vector<MembraneTriangle> triangles;
    const Fabric fabric = woven_fabric();
    const SpringNetwork network = network_of(grid, fabric, triangles, 7);
    REQUIRE(network.size() == 4 * 4 + 3 * 5 + 12);
    REQUIRE(triangles.size() == 24);
    for (int k = 0; k < network.size(); ++k) {
        const int apart = network.second[k] - network.first[k];
        CHECK((network.kind[k] == SpringKind::structural) == (apart == 1 || apart == 5));
        CHECK(network.stiffness[k] == 0.0);
        CHECK(network.damping[k] == 0.0);
        CHECK(network.first[k] >= 7);
    }
    for (const MembraneTriangle& t : triangles) {
        // Longer along warp alone by 1 %: s = 2 * 0.01 L^2 there, and in proportion on the diagonal.
        Vec3 s;
        for (int e = 0; e < 3; ++e) {
            const int a = t.vertex[(e + 1) % 3] - 7, b = t.vertex[(e + 2) % 3] - 7;
            const double along = (grid.vertices[a] - grid.vertices[b]).z();
            s[e] = 0.02 * along * along;
        }
        CHECK(0.5 * s.dot(t.stiffness * s) == Approx(0.5 * 0.005 * stress_law(fabric)(0, 0) * 1e-4));
    }
}

TEST_CASE("A free mesh takes isotropic moduli and refuses others by name, as it does not define warp") {
    std::vector<MembraneTriangle> triangles;
    CHECK(scene_error([&] { network_of(one_triangle(0.1), moduli_fabric(50.0, 50.0, {}, 0.3), triangles); }) == "");
    CHECK(triangles.size() == 1);
    CHECK(
        mentions(scene_error([&] { network_of(one_triangle(0.1), woven_fabric(), triangles); }), {"flag", "warp", "free mesh"}));
    CHECK(mentions(scene_error([&] { network_of(one_triangle(0.1), moduli_fabric(50.0, 50.0, 3.0, 0.0), triangles); }),
                   {"shear_stiffness", "25"}));
    CHECK(triangles.size() == 1);
}

TEST_CASE("Van Gelder's springs are E area/length^2 for each triangle, without triangles in the model") {
    std::vector<MembraneTriangle> triangles;
    Fabric fabric = moduli_fabric(50.0, 50.0, {}, 0.0);
    fabric.membrane = Membrane::van_gelder;
    const SpringNetwork network = network_of(one_triangle(0.1), fabric, triangles);
    CHECK(triangles.empty());
    REQUIRE(network.size() == 3);
    for (const double stiffness : network.stiffness) CHECK(stiffness == Approx(50.0 * std::sqrt(3.0) / 4.0));
}

TEST_CASE("damping_time times the stiffness of an edge alone is its damping, and spring_damping is used as it is") {
    std::vector<MembraneTriangle> triangles;
    Fabric fabric = moduli_fabric(50.0, 50.0, {}, 1.0 / 3.0);
    fabric.damping_time = 0.02;
    for (const double damping : network_of(one_triangle(0.1), fabric, triangles).damping) {
        CHECK(damping == Approx(0.02 * 50.0 * std::sqrt(3.0) / 4.0));
    }
    fabric.damping_time.reset();
    fabric.spring_damping = 0.3;
    for (const double damping : network_of(one_triangle(0.1), fabric, triangles).damping) CHECK(damping == 0.3);
}

}  // namespace percale::test::membrane_test
