#include "engine/linear/multigrid.h"

#include <Eigen/Dense>
#include <utility>

#include "engine/linear/direct_solver.h"
#include "engine/linear/multigrid_solve.h"
#include "tests/support/catch.h"
#include "tests/support/dense_system.h"
#include "tests/support/forces/sheet_system.h"

namespace percale::test::multigrid_test {
namespace {

Vec3Arrays cycle(Multigrid& multigrid, const Vec3Arrays& r) {
    const Slices all{0, r.slices()};
    const double scale = std::sqrt(dot(compute, r, r));
    compute.kernels->to_float(1.0 / scale, r.axes(), {multigrid.residual().data(), multigrid.padded()}, all);
    multigrid.cycle();
    Vec3Arrays z;
    z.resize(static_cast<int>(r.padded_size()));
    compute.kernels->add_float(scale, {multigrid.correction().data(), multigrid.padded()}, z.axes(), all);
    return z;
}

struct Solved {
    SolveReport report;
    Vec3Arrays x;
};

Solved solve(const SheetSystem& sheet, const Vec3Arrays& b, double tolerance) {
    Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    MultigridSpace space;
    Solved solved;
    solved.x.resize(sheet.count());
    solved.report =
        solve_multigrid(sheet.matrix, multigrid, b, {.relative_residual = tolerance, .max_iterations = 300}, space, solved.x);
    return solved;
}

/// Iterations to 1e-4 for the step's own right side, or a random one, whichever takes more.
int iterations(SheetSystem& sheet) {
    int most = 0;
    for (const Vec3Arrays& b : {sheet.right, sheet.random_vector()}) {
        const Solved solved = solve(sheet, b, 1e-4);
        CHECK(solved.report.converged);
        Vec3Arrays filtered = b;
        filter(sheet.matrix, filtered);
        CHECK(sheet.residual(b, solved.x) <= 1.001e-4 * std::sqrt(dot(compute, filtered, filtered)));
        most = std::max(most, solved.report.iterations);
    }
    return most;
}

void check_float_product(SheetSystem& sheet) {
    Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    const Vec3Arrays x = sheet.random_vector();
    const std::size_t padded = multigrid.padded();
    AlignedVector<float> narrow(3 * padded), product(3 * padded);
    compute.kernels->to_float(1.0, x.axes(), {narrow.data(), padded}, {0, x.slices()});
    multigrid.multiply(narrow, product);
    AlignedVector<double> points;
    Vec3Arrays expected = x, found = sheet.zeros();
    multiply(sheet.matrix, x, points, expected);
    compute.kernels->add_float(1.0, {product.data(), padded}, found.axes(), {0, x.slices()});
    CAPTURE(sheet.count());
    const double size = std::sqrt(dot(compute, expected, expected));
    const Vec3Arrays error = difference(found, expected);
    CHECK(std::sqrt(dot(compute, error, error)) <= 1e-6 * size);
    for (int i = 0; i < sheet.count(); ++i) CHECK((sheet.matrix.free[i] > 0.0 || found.at(i) == Vec3::Zero()));
}

void check_symmetric_and_definite(SheetSystem& sheet, Multigrid& multigrid) {
    for (int trial = 0; trial < 10; ++trial) {
        const Vec3Arrays r = sheet.random_vector(), s = sheet.random_vector();
        const Vec3Arrays z = cycle(multigrid, r), w = cycle(multigrid, s);
        const double zr = dot(compute, z, r), ws = dot(compute, w, s);
        CHECK(zr > 0.0);
        CHECK(ws > 0.0);
        CHECK(dot(compute, z, s) == Approx(dot(compute, w, r)).margin(1e-4 * std::sqrt(zr * ws)));
        for (int i = 0; i < sheet.count(); ++i) CHECK((sheet.matrix.free[i] > 0.0 || z.at(i) == Vec3::Zero()));
    }
}

void check_symmetric_and_definite(SheetSystem& sheet) {
    Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    check_symmetric_and_definite(sheet, multigrid);
}

/// Two sheets 1 cm apart, their vertices not above each other, the first one's first.
ClothModel two_layers(int side) {
    Fabric fabric = sheet_fabric();
    fabric.springs.shear = 0.0;
    TriangleMesh mesh = make_grid(1.0, 1.0, side, side);
    mesh.grid_columns = mesh.grid_rows = 0;
    const TriangleMesh upper = mesh;
    const double cell = 1.0 / (side - 1);
    for (const Vec3& x : upper.vertices) mesh.vertices.push_back(x + Vec3(0.3 * cell, 0.01, 0.4 * cell));
    const int first = side * side;
    for (const auto& [a, b, c] : upper.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    return cloth_model(mesh, fabric);
}

/// Every vertex of either that lies over or under the other is held on three of its vertices.
void lay_on_each_other(int side, double factor, SheetSystem& layers) {
    const auto lower = [&](int column, int row) { return row * side + column; };
    const auto upper = [&](int column, int row) { return side * side + row * side + column; };
    for (int r = 0; r + 1 < side; ++r) {
        for (int c = 0; c + 1 < side; ++c) {
            layers.lay_upon(upper(c, r), {lower(c, r), lower(c + 1, r), lower(c, r + 1)}, {0.3, 0.3, 0.4}, factor);
            layers.lay_upon(lower(c + 1, r + 1), {upper(c + 1, r + 1), upper(c, r + 1), upper(c + 1, r)}, {0.3, 0.3, 0.4},
                            factor);
        }
    }
    layers.fill();
}

}  // namespace

TEST_CASE("One cycle is a symmetric positive definite operator on the free vertices") {
    for (const int side : {4, 9, 17, 24}) {
        SheetSystem sheet(static_cast<unsigned>(side), side, 0.4);
        sheet.pin_share(0.1);
        sheet.add_contacts(0.3, 0.1, 1e3);
        CAPTURE(side);
        check_symmetric_and_definite(sheet);
    }
}

TEST_CASE("One cycle takes most of the error of a smooth and of a rough solution") {
    for (const int side : {17, 33, 65}) {
        SheetSystem sheet(static_cast<unsigned>(side), side, 0.1);
        Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
        multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
        Vec3Arrays smooth;
        smooth.resize(sheet.count());
        for (int i = 0; i < sheet.count(); ++i) {
            const Vec3& x = sheet.model.rest[i];
            smooth.set(i, (x.z() + 0.5) * Vec3(std::sin(3.0 * x.x()), 1.0, std::cos(2.0 * x.z())));
        }
        for (const Vec3Arrays& exact : {smooth, sheet.random_vector()}) {
            AlignedVector<double> points;
            Vec3Arrays b = exact;
            multiply(sheet.matrix, exact, points, b);
            Vec3Arrays error = difference(exact, cycle(multigrid, b));
            CAPTURE(side);
            CHECK(sheet.energy_norm(error) <= 0.6 * sheet.energy_norm(exact));
        }
    }
}

TEST_CASE("Prescribed vertices are left at zero") {
    SheetSystem sheet(3, 20, 0.4);
    sheet.pin_share(0.3);
    Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    const Vec3Arrays z = cycle(multigrid, sheet.random_vector());
    for (int i = 0; i < sheet.count(); ++i) CHECK((sheet.matrix.free[i] > 0.0) == (z.at(i) != Vec3::Zero()));
}

TEST_CASE("Hanging sheets of any size need a handful of iterations, at rest and crumpled") {
    for (const int side : {17, 24, 33, 48, 65}) {
        for (const double noise : {0.0, 0.2, 0.6}) {
            SheetSystem sheet(static_cast<unsigned>(side) + 50u, side, noise);
            CAPTURE(side, noise);
            CHECK(iterations(sheet) <= 18);
        }
    }
}

TEST_CASE("Taut and slack sheets stay cheap, though slack springs resist along one line only") {
    for (const int side : {17, 33, 65}) {
        for (const Vec3& stretch : {Vec3(1.2, 1.0, 1.2), Vec3(0.7, 1.0, 1.2), Vec3(0.7, 1.0, 0.7), Vec3(1.0, 1.0, 0.3)}) {
            SheetSystem sheet(static_cast<unsigned>(side) + 40u, side, 0.05, stretch);
            CAPTURE(side, stretch.x(), stretch.z());
            CHECK(iterations(sheet) <= 45);
        }
    }
}

TEST_CASE("Pins anywhere cost no more iterations") {
    for (const int side : {17, 33, 65}) {
        for (const double ratio : {0.05, 0.2, 0.6}) {
            SheetSystem sheet(static_cast<unsigned>(side) + 60u, side, 0.3);
            sheet.pin_share(ratio);
            CAPTURE(side, ratio);
            CHECK(iterations(sheet) <= 18);
        }
    }
}

TEST_CASE("Contacts of any stiffness cost few iterations more") {
    struct Factors {
        double least, most;
    };
    for (const int side : {17, 33, 65}) {
        for (const double ratio : {0.2, 0.6}) {
            for (const auto& [least, most] : {Factors{0.1, 0.1}, Factors{1.0, 1.0}, Factors{1e3, 1e3}, Factors{0.1, 1e3}}) {
                SheetSystem sheet(static_cast<unsigned>(side) + 70u, side, 0.3);
                sheet.add_contacts(ratio, least, most);
                CAPTURE(side, ratio, least, most);
                CHECK(iterations(sheet) <= 25);
            }
        }
    }
}

TEST_CASE("Layers held on each other by stiff contact cost a few times as much as those held by soft contact") {
    for (const int side : {17, 33}) {
        const auto needed = [&](double factor) {
            SheetSystem layers(static_cast<unsigned>(side), two_layers(side), 0.1 / side);
            lay_on_each_other(side, factor, layers);
            return iterations(layers);
        };
        const int apart = needed(0.01);
        CAPTURE(side, apart);
        CHECK(needed(4.0) <= 3 * apart);
        CHECK(needed(10.0) <= 6 * apart);
    }
}

TEST_CASE("One cycle with stiff contact between cloths is symmetric and positive definite, beside obstacles and pins") {
    SheetSystem layers(8, two_layers(17), 0.005), banded(9, 24, 0.3);
    lay_on_each_other(17, 100.0, layers);
    banded.add_self_contacts(200, 30.0);
    for (SheetSystem* sheet : {&layers, &banded}) {
        sheet->pin_share(0.05);
        sheet->add_contacts(0.3, 0.1, 1e3);
        check_symmetric_and_definite(*sheet);
        check_float_product(*sheet);
    }
}

TEST_CASE("Filling again leaves nothing of contact between cloths, with vertices of it pinned or without it") {
    SheetSystem layers(8, two_layers(17), 0.005), without(8, two_layers(17), 0.005);
    lay_on_each_other(17, 100.0, layers);
    Multigrid multigrid(compute, layers.model.adjacency, layers.model.rest);
    multigrid.fill(layers.matrix, Multigrid::Coarser::filled);
    cycle(multigrid, layers.random_vector());
    layers.pin_share(0.2);
    for (SheetSystem* sheet : {&layers, &without}) {
        const Vec3Arrays r = sheet->random_vector();
        Multigrid once(compute, sheet->model.adjacency, sheet->model.rest);
        once.fill(sheet->matrix, Multigrid::Coarser::filled);
        multigrid.fill(sheet->matrix, Multigrid::Coarser::filled);
        CHECK(same_bits(cycle(multigrid, r), cycle(once, r)));
    }
}

TEST_CASE("The solution is that of the direct solver") {
    for (const int side : {5, 6, 17, 30}) {
        SheetSystem sheet(static_cast<unsigned>(side) + 80u, side, 0.4);
        sheet.pin_share(0.05);
        sheet.add_contacts(0.3, 0.1, 1e3);
        const Solved solved = solve(sheet, sheet.right, 1e-11);
        Vec3Arrays exact;
        exact.resize(sheet.count());
        DirectSolver direct;
        REQUIRE(direct.solve(sheet.matrix, sheet.right, exact));
        CAPTURE(side, solved.report.iterations);
        CHECK(solved.report.converged);
        CHECK(sheet.energy_norm(difference(solved.x, exact)) <= 1e-8 * sheet.energy_norm(exact));
    }
}

TEST_CASE("A random network, coarsened or not, is solved too") {
    for (const int vertices : {2, 20, 60, 300}) {
        RandomSystem system(static_cast<unsigned>(vertices) + 90u, vertices);
        system.model.rest = to_points(system.positions, vertices);
        Multigrid multigrid(compute, system.model.adjacency, system.model.rest);
        multigrid.fill(system.matrix, Multigrid::Coarser::filled);
        MultigridSpace space;
        const Eigen::VectorXd b = system.random_vector();
        Vec3Arrays x = from_dense(Eigen::VectorXd::Zero(3 * vertices));
        const SolveReport report =
            solve_multigrid(system.matrix, multigrid, from_dense(b), {.relative_residual = 1e-12}, space, x);
        const Eigen::VectorXd expected = system.solve_dense(b, Eigen::VectorXd::Zero(3 * vertices));
        CAPTURE(vertices, multigrid.levels(), report.iterations);
        CHECK(report.converged);
        CHECK((to_dense(x, vertices) - expected).norm() <= 1e-8 * expected.norm());
    }
}

TEST_CASE("Filling again leaves nothing of pins, contacts and springs that were there") {
    SheetSystem sheet(4, 21, 0.4), other(5, 21, 0.1);
    sheet.pin_share(0.1);
    sheet.add_contacts(0.2, 0.1, 1e3);
    other.pin_share(0.4);
    other.add_contacts(0.5, 0.1, 1e3);
    const Vec3Arrays r = sheet.random_vector();
    Multigrid once(compute, sheet.model.adjacency, sheet.model.rest), again(compute, sheet.model.adjacency, sheet.model.rest);
    once.fill(sheet.matrix, Multigrid::Coarser::filled);
    const Vec3Arrays expected = cycle(once, r);
    again.fill(other.matrix, Multigrid::Coarser::filled);
    cycle(again, other.random_vector());
    again.fill(sheet.matrix, Multigrid::Coarser::filled);
    CHECK(same_bits(cycle(again, r), expected));
    CHECK(same_bits(cycle(again, r), expected));
}

TEST_CASE("A sheet large enough has several levels, a tiny one only itself") {
    const SheetSystem tiny(6, 3, 0.1), large(7, 65, 0.1);
    CHECK(Multigrid(compute, tiny.model.adjacency, tiny.model.rest).levels() == 1);
    CHECK(Multigrid(compute, large.model.adjacency, large.model.rest).levels() >= 4);
}

TEST_CASE("The product in floats is that in doubles, pins and contacts included, in bands and in slices") {
    Fabric free = sheet_fabric();
    free.springs.shear = 0.0;
    for (const bool grid : {true, false}) {
        for (const auto& [columns, rows] : {std::pair{2, 5}, {17, 33}, {65, 70}, {24, 20}}) {
            TriangleMesh mesh = make_grid(1.0, 0.7, columns, rows);
            if (!grid) mesh.grid_columns = mesh.grid_rows = 0;
            SheetSystem sheet(9, cloth_model(mesh, grid ? sheet_fabric() : free), 0.2 / columns);
            sheet.pin_share(0.1);
            sheet.add_contacts(0.3, 0.1, 1e3);
            check_float_product(sheet);
        }
    }
}

TEST_CASE("Coarser levels that are kept leave cycles as symmetric and definite as those filled") {
    const SheetSystem first(1, 33, 0.05);
    SheetSystem later(2, 33, 0.5);
    later.pin_share(0.05);
    later.add_contacts(0.2, 0.1, 1e3);
    Multigrid multigrid(compute, later.model.adjacency, later.model.rest);
    multigrid.fill(first.matrix, Multigrid::Coarser::filled);
    multigrid.fill(later.matrix, Multigrid::Coarser::kept);
    check_symmetric_and_definite(later, multigrid);
    const Vec3Arrays z = cycle(multigrid, later.right);
    for (int i = 0; i < later.count(); ++i) CHECK((later.matrix.free[i] > 0.0 || z.at(i) == Vec3::Zero()));
}

}  // namespace percale::test::multigrid_test
