// Moduli of springs and membranes, from the energies of uniform strains.

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"
#include "tests/support/laws.h"

namespace percale::test::moduli_test {
namespace {

constexpr double small = 1e-6;

/// Energy of the springs at one inner vertex of a grid of unit cells under a small strain, over its area.
double lattice_density(const ClothModel& model, int vertex, const std::vector<Vec3>& places) {
    double energy = 0.0;
    for (int k = 0; k < model.springs.size(); ++k) {
        const int i = model.springs.first[k], j = model.springs.second[k];
        if (i != vertex && j != vertex) continue;
        const double stretch = (places[i] - places[j]).norm() - model.springs.rest_length[k];
        energy += 0.25 * model.springs.stiffness[k] * stretch * stretch;
    }
    return energy;
}

/// A strain's energy density as C: e.C e/2.
struct Moduli {
    double c11, c12, c66;
};

template <class Density>
Moduli measured(Density density) {
    const auto doubled = [&](double xx, double xy, double zx, double zz) {
        Eigen::Matrix2d gradient;
        gradient << 1.0 + small * xx, small * xy, small * zx, 1.0 + small * zz;
        return 2.0 * density(gradient) / (small * small);
    };
    const double c11 = doubled(1.0, 0.0, 0.0, 0.0), c22 = doubled(0.0, 0.0, 0.0, 1.0);
    return {c11, 0.5 * (doubled(1.0, 0.0, 0.0, 1.0) - c11 - c22), doubled(0.0, 0.5, 0.5, 0.0)};
}

Moduli lattice_moduli(const Fabric& fabric) {
    const TriangleMesh grid = make_grid(6.0, 6.0, 7, 7);
    const ClothModel model = cloth_model(grid, fabric);
    return measured(
        [&](const Eigen::Matrix2d& gradient) { return lattice_density(model, 24, deformed(grid.vertices, gradient)); });
}

/// The mean over a sheet without the part of its outermost edges: edges there have one triangle.
Moduli sheet_moduli(const Fabric& fabric) {
    const TriangleMesh grid = make_grid(1.0, 1.0, 9, 9);
    const ClothModel model = cloth_model(grid, fabric);
    return measured([&](const Eigen::Matrix2d& gradient) {
        const Vec3Arrays places = to_vec3_arrays(deformed(grid.vertices, gradient));
        return elastic_energy(model.springs, places) + membrane_energy(model.membrane, places);
    });
}

double young(const Moduli& m) { return m.c11 - m.c12 * m.c12 / m.c11; }

/// Half a second of a sheet of moduli that hangs from two corners; one row of its triangles is `aspect` times as long as high.
std::vector<Vec3> hung_with_slivers(double aspect, const StepSettings& settings) {
    constexpr int side = 17, thin_row = 9;
    constexpr double cell = 0.4 / (side - 1);
    const TriangleMesh grid = make_grid(0.4, 0.4, side, side);
    std::vector<Vec3> places = grid.vertices;
    for (int c = 0; c < side; ++c)
        places[thin_row * side + c] = places[(thin_row - 1) * side + c] + Vec3(0.0, 0.0, cell / aspect);
    TriangleMesh mesh{.vertices = std::move(places), .triangles = {}};
    for (int r = 0; r + 1 < side; ++r) {
        for (int c = 0; c + 1 < side; ++c) {
            const int a = r * side + c;
            mesh.triangles.push_back({a, a + side, a + 1});
            mesh.triangles.push_back({a + 1, a + side, a + side + 1});
        }
    }
    Fabric fabric = sheet_fabric();
    fabric.springs = {.structural = 0.0};
    fabric.stretch_stiffness = std::array{100.0, 100.0};
    fabric.poisson_ratio = 0.3;
    fabric.bend_stiffness = 1e-5;
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(mesh, fabric);
    for (const int corner : {0, side - 1}) simulation.pin(cloth, corner);
    while (simulation.time() < 0.5 - 1e-9) simulation.step();
    return copy(simulation.positions(cloth));
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

}  // namespace

TEST_CASE("Square grid of springs: C11 = ks + kd + 4 kb, C12 = C66 = kd, isotropic where kd = (ks + 4 kb)/2") {
    for (const SpringConstants springs : {SpringConstants{1000.0, 500.0, 10.0}, {70.0, 30.0, 0.0}, {50.0, 35.0, 5.0}}) {
        const Moduli m = lattice_moduli({.springs = springs});
        CHECK(m.c11 == Approx(springs.structural + springs.shear + 4.0 * springs.bend).epsilon(1e-5));
        CHECK(m.c12 == Approx(springs.shear).epsilon(1e-4));
        CHECK(m.c66 == Approx(springs.shear).epsilon(1e-5));
    }
    const Moduli isotropic = lattice_moduli({.springs = {.structural = 50.0, .shear = 35.0, .bend = 5.0}});
    CHECK(isotropic.c11 - isotropic.c12 == Approx(2.0 * isotropic.c66).epsilon(1e-4));
}

TEST_CASE("Triangle springs have the requested stretch and shear moduli, whatever Poisson's ratio") {
    for (const double nu : {-0.4, 0.0, 0.3, 0.7}) {
        const Moduli m = sheet_moduli(moduli_fabric(80.0, 80.0, 11.0, nu));
        CHECK(young(m) == Approx(80.0).epsilon(1e-4));
        CHECK(m.c12 / m.c11 == Approx(nu).margin(1e-4));
        CHECK(m.c66 == Approx(11.0).epsilon(1e-4));
    }
}

TEST_CASE("Van Gelder's springs on a grid of alternating diagonals are 1.20 times too stiff, with Poisson's ratio 0.2") {
    Fabric fabric = moduli_fabric(80.0, 80.0, {}, 0.0);
    fabric.membrane = Membrane::van_gelder;
    const Moduli m = sheet_moduli(fabric);
    CHECK(young(m) == Approx(1.2 * 80.0).epsilon(1e-4));
    CHECK(m.c12 / m.c11 == Approx(0.2).epsilon(1e-4));
}

TEST_CASE("Where triangles are slivers steps stay within newton_error_ratio of the error of the time step, or a third", "[law]") {
    const StepSettings exact{.linear_solver = LinearSolver::direct},
        half{.time_step = 1.0 / 120.0, .linear_solver = LinearSolver::direct};
    for (const double aspect : {3.0, 10.0, 30.0}) {
        const std::vector<Vec3> places = hung_with_slivers(aspect, exact);
        const double time_error = largest_distance(places, hung_with_slivers(aspect, half));
        const double by_default = largest_distance(places, hung_with_slivers(aspect, {}));
        const double by_quarter = largest_distance(places, hung_with_slivers(aspect, {.newton_error_ratio = 0.25}));
        const std::string name = "slivers " + std::to_string(static_cast<int>(aspect)) + " : 1, moduli: ";
        check_law(name + "default steps from exact ones, share of the time error", by_default / time_error, 1.0);
        check_law(name + "steps of a quarter from exact ones, share of the time error", by_quarter / time_error, 0.33);
    }
}

}  // namespace percale::test::moduli_test
