// Cloth whose rest shape differs from its start.

#include <cmath>

#include "percale/fabric_presets.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::rest_shape_test {
namespace {

Fabric woven() {
    Fabric fabric{.area_density = 0.2, .spring_damping = 0.05};
    fabric.springs = {.structural = 0.0};
    fabric.stretch_stiffness = std::array{400.0, 150.0};
    fabric.shear_stiffness = 20.0;
    return fabric;
}

Fabric even() {
    Fabric fabric = woven();
    fabric.stretch_stiffness = std::array{250.0, 250.0};
    fabric.shear_stiffness.reset();
    fabric.bend_stiffness = 1e-4;
    return fabric;
}

Fabric knitted() {
    Fabric fabric = free_fabric();
    fabric.springs.bend = 0.0;
    fabric.bend_stiffness = 1e-5;
    return fabric;
}

/// An irregular strip in the plane y = 0, length along x.
TriangleMesh strip() {
    TriangleMesh mesh = irregular_sheet(0.3, 400);
    for (Vec3& x : mesh.vertices) x.z() *= 0.5;
    return mesh;
}

/// Every panel of a layout: the triangles left and right of the middle moved, turned and mirrored.
RestShape laid_out(const TriangleMesh& mesh) {
    RestShape shape = rest_shape_of(mesh, mesh, "strip");
    for (auto& corners : shape.corners) {
        const bool left = corners[0].x() + corners[1].x() + corners[2].x() < 0.0;
        for (Vec3& x : corners) x = left ? Vec3(x.z(), x.x(), 0.0) : Vec3(3.0 - x.x(), 7.0 + x.z(), 0.0);
    }
    return shape;
}

double energy_of(const TriangleMesh& mesh, const Fabric& fabric, const RestShape& shape) {
    Simulation simulation({.measure = StepMeasures::all, .gravity = Vec3::Zero()});
    simulation.add_cloth(mesh, fabric, {}, "strip", shape);
    return simulation.energy().elastic;
}

/// Ratio of force per width to strain of a strip that is pulled along its length, from its energy: 1/2 E e^2 area.
double pulled_modulus(const Fabric& fabric, const Vec3& warp) {
    constexpr double strain = 0.01, length = 0.3, width = 0.15;
    const TriangleMesh mesh = strip();
    RestShape shape = rest_shape_of(mesh, mesh, "strip");
    shape.warp = warp;
    Simulation simulation({.time_step = 0.01, .newton_tolerance = 1e-8, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
    const ClothId cloth = simulation.add_cloth(mesh, fabric, {}, "strip", shape);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const double x = mesh.vertices[i].x();
        if (std::abs(std::abs(x) - 0.5 * length) > 1e-9) continue;
        const int vertex = static_cast<int>(i);
        simulation.pin(cloth, vertex);
        simulation.move_pin(cloth, vertex, mesh.vertices[i] + Vec3(strain * x, 0.0, 0.0));
    }
    for (int n = 0; n < 60; ++n) REQUIRE(simulation.step().ok());
    return 2.0 * simulation.energy().elastic / (strain * strain * length * width);
}

}  // namespace

TEST_CASE("A rest shape equal to the start changes nothing but rounding", "[slow]") {
    const TriangleMesh mesh = strip();
    for (const Fabric& fabric : {knitted(), free_fabric(), even()}) {
        std::vector<std::vector<Vec3>> ends;
        for (const bool said : {false, true}) {
            Simulation simulation({.newton_tolerance = 1e-10});
            const ClothId cloth =
                simulation.add_cloth(mesh, fabric, {}, "strip", said ? rest_shape_of(mesh, mesh, "strip") : RestShape{});
            simulation.pin(cloth, 0);
            for (int n = 0; n < 10; ++n) simulation.step();
            ends.push_back(copy(simulation.positions(cloth)));
        }
        for (std::size_t i = 0; i < ends[0].size(); ++i) CHECK((ends[0][i] - ends[1][i]).norm() < 1e-9);
    }
}

TEST_CASE("Panels laid out apart store no energy where they are joined flat, and that of the joined sheet where it is bent") {
    const TriangleMesh flat = strip();
    TriangleMesh bent = flat;
    for (Vec3& x : bent.vertices) x = Vec3(0.1 * std::sin(x.x() / 0.1), 0.1 * std::cos(x.x() / 0.1), x.z());
    for (const Fabric& fabric : {knitted(), free_fabric(), even()}) {
        const RestShape apart = laid_out(flat), joined = rest_shape_of(flat, flat, "strip");
        CHECK(energy_of(flat, fabric, apart) < 1e-20);
        CHECK(energy_of(bent, fabric, apart) == Approx(energy_of(bent, fabric, joined)).epsilon(1e-9));
        CHECK(energy_of(bent, fabric, joined) > 1e-7);
    }
}

TEST_CASE("Cloth that starts stretched has the strain and the energy of it, masses of its rest shape, and goes back") {
    const TriangleMesh rest = strip();
    TriangleMesh start = rest;
    for (Vec3& x : start.vertices) x *= 1.1;
    const RestShape shape = rest_shape_of(start, rest, "strip");
    Simulation simulation({.newton_tolerance = 1e-8, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
    const ClothId cloth = simulation.add_cloth(start, even(), {}, "strip", shape);
    CHECK(simulation.largest_strain() == Approx(0.1));
    double mass = 0.0;
    for (const double m : simulation.masses(cloth)) mass += m;
    CHECK(mass == Approx(0.2 * 0.3 * 0.15));
    // Green's strain (1.1^2 - 1)/2 along both, Poisson's ratio 0.
    const double green = 0.5 * (1.21 - 1.0);
    CHECK(simulation.energy().elastic == Approx(green * green * 250.0 * 0.3 * 0.15));
    for (int n = 0; n < 120; ++n) simulation.step();
    CHECK(simulation.largest_strain() < 1e-3);
    const auto x = simulation.positions(cloth);
    CHECK((x[0] - x[1]).norm() == Approx((rest.vertices[0] - rest.vertices[1]).norm()).epsilon(1e-3));
}

TEST_CASE("The pose's scale acts on the rest shape, too") {
    const TriangleMesh mesh = strip();
    Simulation simulation({.measure = StepMeasures::all, .gravity = Vec3::Zero()});
    const Pose pose{.translation = Vec3(1, 2, 3), .rotation = {.w = 0.6, .x = 0.8, .y = 0.0, .z = 0.0}, .scale = 2.5};
    simulation.add_cloth(mesh, knitted(), pose, "strip", laid_out(mesh));
    CHECK(std::abs(simulation.largest_strain()) < 1e-12);
    CHECK(simulation.energy().elastic < 1e-18);
}

TEST_CASE("A strip cut along warp and one cut across give every preset's two moduli, on an irregular mesh", "[slow]") {
    double worst = 0.0;
    for (const FabricPreset& preset : fabric_presets()) {
        const Fabric& fabric = preset.fabric;
        const auto [warp, weft] = *fabric.stretch_stiffness;
        const double along = pulled_modulus(fabric, Vec3(2, 0, 0)), across = pulled_modulus(fabric, Vec3(0, 0.3, -0.1));
        CAPTURE(preset.name, along, across);
        worst = std::max({worst, std::abs(along / warp - 1.0), std::abs(across / weft - 1.0)});
    }
    check_law("moduli of strips along warp and weft, relative error", worst, 0.02);
}

TEST_CASE("Warp of a mesh that is its own rest shape turns with the pose") {
    const TriangleMesh mesh = strip();
    const Pose pose{.rotation = {.w = std::sqrt(0.5), .x = 0.0, .y = std::sqrt(0.5), .z = 0.0}};
    std::vector<double> energies;
    for (const bool posed : {false, true}) {
        Simulation simulation({.measure = StepMeasures::all, .gravity = Vec3::Zero()});
        RestShape shape;
        shape.warp = Vec3::UnitX();
        const ClothId cloth = simulation.add_cloth(mesh, woven(), posed ? pose : Pose{}, "strip", shape);
        std::vector<Vec3> x = copy(simulation.positions(cloth));
        const Vec3 stretch = posed ? Vec3(1.0, 1.0, 1.05) : Vec3(1.05, 1.0, 1.0);
        for (Vec3& point : x) point = point.cwiseProduct(stretch);
        simulation.set_positions(cloth, x);
        energies.push_back(simulation.energy().elastic);
    }
    CHECK(energies[0] == Approx(energies[1]).epsilon(1e-9));
    CHECK(energies[0] == Approx(0.5 * 400.0 * 0.05125 * 0.05125 * 0.3 * 0.15));
}

}  // namespace percale::test::rest_shape_test
