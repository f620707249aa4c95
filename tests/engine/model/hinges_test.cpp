#include "engine/model/hinges.h"

#include "tests/support/bench_meshes.h"
#include "tests/support/bent_cloth.h"
#include "tests/support/catch.h"

namespace percale::test::hinges_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Sums over a sheet weighted by a window that falls to 0 at its edges: there a lattice has the energy per area that it has
/// everywhere inside.
struct Density {
    const ClothModel& model;
    Vec3 low, size;

    explicit Density(const ClothModel& of) : model(of), low(of.rest[0]), size(of.rest[0]) {
        for (const Vec3& x : model.rest) {
            low = low.cwiseMin(x);
            size = size.cwiseMax(x);
        }
        size -= low;
    }

    double window(const Vec3& x) const {
        const double a = std::sin(pi * (x.x() - low.x()) / size.x()), b = std::sin(pi * (x.z() - low.z()) / size.z());
        return a * a * b * b;
    }

    double area() const {
        double sum = 0.0;
        for (const auto& [a, b, c] : model.triangles) {
            const Vec3 middle = (model.rest[a] + model.rest[b] + model.rest[c]) / 3.0;
            sum += 0.5 * window(middle) * (model.rest[b] - model.rest[a]).cross(model.rest[c] - model.rest[a]).norm();
        }
        return sum;
    }

    double energy(const std::vector<Vec3>& points) const {
        const Vec3Arrays x = to_vec3_arrays(points);
        double sum = 0.0;
        for (const Hinge& hinge : model.hinges.all) {
            Vec3 middle = Vec3::Zero();
            double count = 0.0;
            for (const int i : hinge.vertex) {
                if (i < 0) continue;
                middle += model.rest[i];
                count += 1.0;
            }
            sum += window(middle / count) * hinge_energy({.all = {hinge}, .curved = {}}, x);
        }
        return sum;
    }
};

/// Energy of a sheet rolled in a direction over 1/2 B kappa^2 A, away from its edges.
double rolled_ratio(const TriangleMesh& mesh, double angle) {
    const ClothModel model = bending_model(mesh);
    const Density density(model);
    const double curvature = 0.5;
    return density.energy(rolled(model.rest, curvature, angle)) / (0.5 * bend_stiffness * curvature * curvature * density.area());
}

std::vector<TriangleMesh> some_meshes() {
    return {make_grid(1.0, 1.0, 9, 9), make_grid(1.0, 0.4, 2, 7), equilateral_sheet(0.1, 6, 7), irregular_sheet(1.0, 300)};
}

}  // namespace

TEST_CASE("A flat sheet of a file with rounding is flat, and a slightly rolled one is not") {
    Random random(12);
    TriangleMesh sheet = irregular_sheet(1.0, 300);
    sheet.vertices = transform(random.pose(2.0), std::span<const Vec3>(sheet.vertices));
    for (Vec3& x : sheet.vertices) x = (x * 1e6).array().round() / 1e6;
    CHECK(bending_model(sheet).hinges.curved.empty());
    // Two triangles of 0.1 m about an edge.
    const auto folded = [](double angle) {
        TriangleMesh mesh;
        mesh.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0.05, 0, 0.1}, {0.05, 0.1 * std::sin(angle), -0.1 * std::cos(angle)}};
        mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
        return bending_model(mesh).hinges.curved.size();
    };
    CHECK(folded(0.9e-3) == 0);
    CHECK(folded(1.1e-3) == 1);
    CHECK(folded(-1.1e-3) == 1);
}

TEST_CASE("A flat sheet and one moved, turned or sheared in its plane have no bending energy") {
    Random random(11);
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = bending_model(mesh);
        CHECK(model.hinges.curved.empty());
        const std::vector<Vec3> moved = transform(random.pose(2.0), std::span<const Vec3>(model.rest));
        CHECK(bending_energy(model, moved) < 1e-25);
        std::vector<Vec3> sheared = model.rest;
        for (Vec3& x : sheared) x = Vec3(1.2 * x.x() + 0.3 * x.z(), 0.0, 0.8 * x.z());
        CHECK(bending_energy(model, sheared) < 1e-25);
        const double bent = bending_energy(model, rolled(model.rest, 1.0, 0.3));
        const std::vector<Vec3> turned = transform(random.pose(2.0), std::span<const Vec3>(rolled(model.rest, 1.0, 0.3)));
        CHECK(bending_energy(model, turned) == Approx(bent).epsilon(1e-10));
    }
}

TEST_CASE("Grids store the energy of an isotropic plate of Poisson ratio 0, bent in any direction and twisted") {
    for (const auto& [columns, rows] : {std::pair(41, 41), std::pair(41, 21)}) {
        const TriangleMesh mesh = make_grid(1.0, 1.0, columns, rows);
        for (const double angle : {0.0, 0.3, 0.25 * pi, 1.1, 0.5 * pi}) {
            CAPTURE(columns, rows, angle);
            CHECK(rolled_ratio(mesh, angle) == Approx(1.0).epsilon(1e-3));
        }
        // y = t x z has the twist t and no curvature along the axes: B t^2 an area.
        const ClothModel model = bending_model(mesh);
        std::vector<Vec3> twisted = model.rest;
        for (Vec3& x : twisted) x.y() = 1e-3 * x.x() * x.z();
        CHECK(bending_energy(model, twisted) == Approx(bend_stiffness * 1e-6).epsilon(1e-9));
    }
}

TEST_CASE("A whole strip stores 1/2 B kappa^2 per area of its inner length along both axes of a grid") {
    const double curvature = 0.5, segment = 0.05;
    for (const bool turned : {false, true}) {
        const ClothModel model = bending_model(turned ? make_grid(0.1, 1.0, 3, 21) : make_grid(1.0, 0.1, 21, 3));
        const double energy = bending_energy(model, rolled(model.rest, curvature, turned ? 0.5 * pi : 0.0));
        // Twenty segments meet at nineteen places.
        CHECK(energy == Approx(0.5 * bend_stiffness * curvature * curvature * 0.1 * 19 * segment).epsilon(2e-4));
    }
}

TEST_CASE("Equilateral triangles are exact in every direction, other triangles stay within the stated anisotropy") {
    const TriangleMesh lattice = equilateral_sheet(0.02, 51, 58);
    for (const double angle : {0.0, 0.2, 0.25 * pi, 1.3}) CHECK(rolled_ratio(lattice, angle) == Approx(1.0).epsilon(2e-3));
    // A grid read as a free mesh: right triangles, exact along their legs, 1.5 times too stiff in between.
    TriangleMesh right = make_grid(1.0, 1.0, 41, 41);
    right.grid_columns = right.grid_rows = 0;
    CHECK(rolled_ratio(right, 0.0) == Approx(1.0).epsilon(1e-3));
    CHECK(rolled_ratio(right, 0.5 * pi) == Approx(1.0).epsilon(1e-3));
    CHECK(rolled_ratio(right, 0.25 * pi) == Approx(1.5).epsilon(1e-3));
    for (const double angle : {0.0, 0.7, 1.5, 2.2}) {
        const double ratio = rolled_ratio(irregular_sheet(1.0, 3000), angle);
        CAPTURE(angle, ratio);
        CHECK(ratio > 0.9);
        CHECK(ratio < 1.6);
    }
}

TEST_CASE("The energies of all pairs add up to those of the hinges, wherever the vertices are") {
    Random random(3);
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = bending_model(mesh);
        const std::vector<Vec3> points = random_points(random, model.vertex_count(), 0.5);
        double pairs = 0.0;
        for (int k = 0; k < model.springs.size(); ++k) {
            const Vec3 x = points[model.springs.first[k]] - points[model.springs.second[k]];
            pairs += 0.5 * model.springs.bending[k] * x.squaredNorm();
        }
        CHECK(pairs == Approx(bending_energy(model, points)).epsilon(1e-10));
    }
}

TEST_CASE("Hinges of a cloth join its own vertices, those of the next cloth others") {
    ClothModel model = bending_model(make_grid(1.0, 1.0, 4, 5));
    const std::size_t before = model.hinges.all.size();
    append_cloth(model, irregular_sheet(1.0, 300), free_fabric(), "second");
    order_last_cloth(model);
    append_hinges_of_last_cloth(model, 1e-4);
    finish_model(model);
    REQUIRE(model.hinges.all.size() > before);
    for (std::size_t k = 0; k < model.hinges.all.size(); ++k) {
        for (const int vertex : model.hinges.all[k].vertex) CHECK((vertex < 20) == (k < before || vertex < 0));
    }
    CHECK(bending_energy(model, model.rest) < 1e-25);
}

TEST_CASE("A fold beside a pinned triangle or segment is twice as stiff, others are not") {
    ClothModel model = bending_model(make_grid(1.0, 0.25, 5, 2));
    std::vector<double> free(10, 1.0);
    for (const int vertex : {0, 1, 5, 6}) free[vertex] = 0.0;
    set_model_clamps(free, model);
    for (const Hinge& hinge : model.hinges.all) {
        const bool at_clamp = hinge.folds && (hinge.vertex[0] == 1 || hinge.vertex[0] == 6);
        CHECK(hinge.clamp == (at_clamp ? 2.0 : 1.0));
    }
    set_model_clamps(std::vector<double>(10, 1.0), model);
    for (const Hinge& hinge : model.hinges.all) CHECK(hinge.clamp == 1.0);
}

}  // namespace percale::test::hinges_test
