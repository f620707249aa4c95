#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "engine/forces/total_force.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/reference_table.h"

// Exact values of forces and equilibria.
namespace percale::test::exact_statics_test {
namespace {

/// Spring forces of a model at some positions, N.
std::vector<Vec3> spring_forces(const ClothModel& model, const std::vector<Vec3>& places) {
    const Vec3Arrays positions = to_vec3_arrays(places);
    StepSprings springs;
    set_step_springs(compute, {model.adjacency, positions, DampingForm::velocity, 1.0}, springs);
    SpringTerms terms;
    Vec3Arrays forces, still;
    for (auto* vectors : {&forces, &still}) vectors->resize(model.vertex_count());
    evaluate_springs(compute, springs, {positions, still, 1.0}, false, forces, terms);
    return to_points(forces, model.vertex_count());
}

/// The pull of the part at x < 0 of a uniformly strained sheet on the other part: in its plane, x and z.
Eigen::Vector2d pull_across(const TriangleMesh& sheet, const Fabric& fabric, const Eigen::Matrix2d& strain) {
    const ClothModel model = cloth_model(sheet, fabric);
    std::vector<Vec3> places = model.rest;
    for (Vec3& x : places) {
        const Eigen::Vector2d moved = strain * Eigen::Vector2d(x.x(), x.z());
        x += Vec3(moved.x(), 0.0, moved.y());
    }
    const std::vector<Vec3> forces = spring_forces(model, places);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < forces.size(); ++i) {
        if (model.rest[i].x() < 0.0) sum += Eigen::Vector2d(forces[i].x(), forces[i].z());
    }
    return sum;
}

struct Moduli {
    double c11, c12, c66;  // N/m
};

/// Measured from the forces across a cut: a sheet of more rows less one of fewer, so that edges cancel. `higher` is the
/// difference of their widths, m.
Moduli moduli(const TriangleMesh& wide, const TriangleMesh& narrow, double higher, const Fabric& fabric) {
    const double e = 1e-7;
    const auto traction = [&](const Eigen::Matrix2d& strain) -> Eigen::Vector2d {
        return (pull_across(wide, fabric, strain) - pull_across(narrow, fabric, strain)) / (higher * e);
    };
    const Eigen::Matrix2d along = Eigen::Vector2d(e, 0.0).asDiagonal(), across = Eigen::Vector2d(0.0, e).asDiagonal();
    const Eigen::Matrix2d shear = 0.5 * e * (Eigen::Matrix2d() << 0, 1, 1, 0).finished();
    return {traction(along).x(), traction(across).x(), traction(shear).y()};
}

double relative_error(const Moduli& measured, const Moduli& exact) {
    return std::max({std::abs(measured.c11 / exact.c11 - 1.0), std::abs(measured.c12 / exact.c12 - 1.0),
                     std::abs(measured.c66 / exact.c66 - 1.0)});
}

/// Rows of regular triangles of edge 1, symmetric about x = 0 in the mean.
TriangleMesh regular_triangles(int columns, int rows) {
    TriangleMesh mesh;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            mesh.vertices.emplace_back(c - 0.5 * columns + 0.5 * (r % 2) + 0.25, 0.0, 0.5 * std::numbers::sqrt3 * r);
        }
    }
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c + 1 < columns; ++c) {
            const int a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
            // Odd rows are shifted to the right by half an edge.
            if (r % 2 == 0) {
                mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, d, b}, Triangle{b, d, e}});
            } else {
                mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, d, e}, Triangle{a, e, b}});
            }
        }
    }
    return mesh;
}

/// Stiffness of a hanging chain of N links against small sideways moves of its masses, N/m, from forces.
Eigen::MatrixXd sideways_stiffness(int links, double mass, double link, double k) {
    std::vector<Link> list;
    std::vector<Vec3> places = {Vec3::Zero()};
    for (int i = 0; i < links; ++i) {
        list.push_back({i, i + 1, link, k, 0.0});
        places.emplace_back(0.0, places.back().y() - link - mass * 9.81 * (links - i) / k, 0.0);
    }
    const ClothModel model = linked_masses(std::vector<double>(links + 1, mass), list);
    const double push = 1e-6 * link;
    Eigen::MatrixXd stiffness(links, links);
    for (int j = 0; j < links; ++j) {
        std::vector<Vec3> pushed = places;
        pushed[j + 1].z() = push;
        const std::vector<Vec3> forces = spring_forces(model, pushed);
        for (int i = 0; i < links; ++i) stiffness(i, j) = -forces[i + 1].z() / push;
    }
    return stiffness;
}

/// A chain of stiff links between two points, come to rest under its weight.
World hung_chain(int links, double length, double mass, double k) {
    const double link = length / links;
    std::vector<Link> list;
    std::vector<Vec3> places;
    // Two straight halves of the right length.
    const double drop = 0.5 * std::sqrt(length * length - 1.0);
    for (int i = 0; i <= links; ++i) {
        if (i > 0) list.push_back({i - 1, i, link, k, 0.0});
        const double s = static_cast<double>(i) / links;
        places.emplace_back(s, -2.0 * drop * std::min(s, 1.0 - s), 0.0);
    }
    World world =
        make_world(linked_masses(std::vector<double>(links + 1, mass), list), places,
                   {.time_step = 0.1, .newton_tolerance = 1e-9, .newton_iterations = 200, .linear_solver = LinearSolver::direct});
    for (const int end : {0, links}) world.scene.script.free[end] = 0.0;
    for (int n = 0; n < 250; ++n) REQUIRE(step(world).ok());
    return world;
}

}  // namespace

TEST_CASE("Raw springs on a square grid have the moduli C11 = ks + kd + 4 kb, C12 = C66 = kd", "[law]") {
    for (const auto& [ks, kd, kb] : {std::array{1000.0, 500.0, 10.0}, {300.0, 700.0, 50.0}, {100.0, 70.0, 10.0}}) {
        Fabric fabric = sheet_fabric();
        fabric.springs = {.structural = ks, .shear = kd, .bend = kb};
        const Moduli measured = moduli(make_grid(1.1, 0.8, 12, 9), make_grid(1.1, 0.7, 12, 8), 0.1, fabric);
        const Moduli exact{ks + kd + 4.0 * kb, kd, kd};
        check_law(
            "moduli of a square grid, ks " + figure(ks, 4) + " kd " + figure(kd, 4) + " kb " + figure(kb, 4) + ": relative error",
            relative_error(measured, exact), 1e-6);
        const double anisotropy = measured.c11 - measured.c12 - 2.0 * measured.c66;
        const bool isotropic = kd == 0.5 * (ks + 4.0 * kb);
        CHECK((std::abs(anisotropy) < 1e-5 * ks) == isotropic);
    }
}

TEST_CASE("Springs k on regular triangles have Young's modulus 2 k/sqrt(3) and Poisson's ratio 1/3", "[law]") {
    const double k = 800.0;
    Fabric fabric = free_fabric();
    fabric.springs = {.structural = k, .shear = 0.0, .bend = 0.0};
    const Moduli m = moduli(regular_triangles(12, 9), regular_triangles(12, 7), std::numbers::sqrt3, fabric);
    const double ratio = m.c12 / m.c11, young = m.c11 - m.c12 * ratio;
    check_law("regular triangles: relative error of Young's modulus", std::abs(young * std::numbers::sqrt3 / (2.0 * k) - 1.0),
              1e-6);
    check_law("regular triangles: error of Poisson's ratio", std::abs(ratio - 1.0 / 3.0), 1e-6);
    check_law("regular triangles: relative anisotropy", std::abs(m.c11 - m.c12 - 2.0 * m.c66) / m.c11, 1e-6);
}

TEST_CASE("A hanging chain's frequencies are the zeros of Laguerre polynomials", "[law]") {
    const double mass = 0.1, link = 0.2, k = 1e7;
    double worst = 0.0;
    Eigen::VectorXd squares;
    for (const std::vector<double>& row : reference_table("chain_modes.csv")) {
        const int links = static_cast<int>(row[0]), mode = static_cast<int>(row[1]);
        if (squares.size() != links) {
            const Eigen::MatrixXd stiffness = sideways_stiffness(links, mass, link, k);
            squares = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, Eigen::EigenvaluesOnly).eigenvalues() / mass;
        }
        worst = std::max(worst, std::abs(std::sqrt(squares[mode - 1] * link / 9.81) / row[2] - 1.0));
    }
    check_law("hanging chains of 2 to 100 links, from forces: relative error of their frequencies", worst, 2e-5);
}

TEST_CASE("A chain between two points hangs as the funicular polygon", "[law]") {
    const double mass = 1e-4, k = 2e4;
    double worst_sag = 0.0, worst_pull = 0.0;
    for (const std::vector<double>& row : reference_table("funicular.csv")) {
        const int links = static_cast<int>(row[0]);
        if (links != 4 && links != 10 && links != 20) continue;
        const World world = hung_chain(links, row[1], mass, k);
        const Vec3 first = world.state.cloth.positions.at(1) - world.state.cloth.positions.at(0);
        const double tension = k * (first.norm() - row[1] / links);
        worst_sag = std::max(worst_sag, std::abs(-world.state.cloth.positions.y[links / 2] / row[3] - 1.0));
        worst_pull = std::max(worst_pull, std::abs(tension * first.normalized().x() / (mass * 9.81) / row[2] - 1.0));
    }
    check_law("hung chains of 4, 10, 20 links: relative error of the sag", worst_sag, 1e-3);
    check_law("hung chains of 4, 10, 20 links: relative error of the horizontal tension", worst_pull, 1e-3);
}

}  // namespace percale::test::exact_statics_test
