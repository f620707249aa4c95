#include "engine/linear/multigrid_solve.h"

#include <limits>

#include "engine/linear/direct_solver.h"
#include "tests/support/catch.h"
#include "tests/support/dense_system.h"
#include "tests/support/forces/sheet_system.h"

namespace percale::test::multigrid_solve_test {
namespace {

struct Solved {
    SolveReport report;
    Vec3Arrays x;
};

Solved solve(const SheetSystem& system, const Vec3Arrays& b, const Vec3Arrays& start, const SolveTarget& target) {
    Multigrid multigrid(compute, system.model.adjacency, system.model.rest);
    multigrid.fill(system.matrix, Multigrid::Coarser::filled);
    MultigridSpace space;
    Solved solved{{}, start};
    solved.report = solve_multigrid(system.matrix, multigrid, b, target, space, solved.x);
    return solved;
}

/// Random where vertices are prescribed, 0 elsewhere.
Vec3Arrays prescribed(SheetSystem& system) {
    Vec3Arrays x = system.zeros();
    for (int i = 0; i < system.count(); ++i) {
        const Vec3 value = system.random.point(1.0);
        if (system.matrix.free[i] == 0.0) x.set(i, value);
    }
    return x;
}

void touch_and_pin(SheetSystem& system) {
    system.pin_share(0.05);
    system.add_contacts(0.3, 0.1, 1e3);
}

Vec3Arrays direct_solution(const SheetSystem& system, const Vec3Arrays& b, const Vec3Arrays& start) {
    Vec3Arrays x = start;
    DirectSolver direct;
    REQUIRE(direct.solve(system.matrix, b, x));
    return x;
}

/// The answer is that of the direct solver, found within the iterations allowed.
void check_solution(SheetSystem& system, int max_iterations) {
    const Vec3Arrays start = prescribed(system);
    const Solved solved = solve(system, system.right, start, {.relative_residual = 1e-9, .max_iterations = max_iterations});
    CAPTURE(system.count(), solved.report.iterations);
    CHECK(solved.report.converged);
    CHECK(system.residual(system.right, solved.x) <= 1e-9 * system.residual(system.right, start));
    const Vec3Arrays exact = direct_solution(system, system.right, start);
    CHECK(system.energy_norm(difference(solved.x, exact)) <= 1e-5 * system.energy_norm(difference(exact, start)));
}

/// Prescribed entries have the bits they had.
void check_kept(const SheetSystem& system, const Vec3Arrays& start, const Vec3Arrays& x) {
    for (int i = 0; i < system.count(); ++i) {
        if (system.matrix.free[i] == 0.0) CHECK(x.at(i) == start.at(i));
    }
}

ClothModel several_cloths() {
    Fabric free = sheet_fabric();
    free.springs.shear = 0.0;
    ClothModel model;
    append_cloth(model, make_grid(1.0, 1.0, 20, 20), sheet_fabric(), "square");
    append_cloth(model, make_grid(0.3, 2.0, 4, 25), sheet_fabric(), "strip");
    append_cloth(model, make_sphere(0.3, 2), free, "ball");
    append_cloth(model, make_grid(0.1, 0.1, 2, 2), sheet_fabric(), "patch");
    finish_model(model);
    return model;
}

ClothModel unequal_masses(unsigned seed, ClothModel model) {
    Random random(seed);
    for (double& mass : model.mass) mass *= random.decades(1e-6, 1.0);
    return model;
}

Fabric stiff_fabric(double factor) {
    Fabric fabric = sheet_fabric();
    for (double* constant : {&fabric.springs.structural, &fabric.springs.shear, &fabric.springs.bend}) *constant *= factor;
    return fabric;
}

/// A rope of `count` vertices along an oblique line, every third link doubled.
ClothModel rope(int count) {
    std::vector<Link> links;
    for (int i = 0; i + 1 < count; ++i) {
        links.push_back({i, i + 1, 0.1, 500.0, 0.1});
        if (i % 3 == 0) links.push_back({i + 1, i, 0.12, 200.0, 0.0});
    }
    ClothModel model = linked_masses(std::vector<double>(count, 1e-3), links);
    for (int i = 0; i < count; ++i) model.rest.push_back(0.1 * i * Vec3(1.0, 2.0, -2.0) / 3.0);
    return model;
}

}  // namespace

TEST_CASE("The residual asked for is reached in double precision, prescribed entries kept") {
    for (const int side : {9, 17, 33}) {
        SheetSystem sheet(static_cast<unsigned>(side), side, 0.3);
        touch_and_pin(sheet);
        const Vec3Arrays start = prescribed(sheet);
        const double first = sheet.residual(sheet.right, start);
        int before = 0;
        for (const double target : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
            const Solved solved = solve(sheet, sheet.right, start, {.relative_residual = target});
            CAPTURE(side, target, solved.report.iterations);
            CHECK(solved.report.converged);
            CHECK(sheet.residual(sheet.right, solved.x) <= target * first * (1.0 + 1e-9));
            CHECK(solved.report.iterations >= before);
            before = solved.report.iterations;
            check_kept(sheet, start, solved.x);
        }
        CHECK(before <= 80);
    }
}

TEST_CASE("A converged solve is at the target residual, whatever limits the iterations") {
    SheetSystem sheet(1, 25, 0.3);
    touch_and_pin(sheet);
    const Vec3Arrays start = prescribed(sheet);
    const double first = sheet.residual(sheet.right, start);
    for (int most = 1; most <= 40; ++most) {
        const Solved solved = solve(sheet, sheet.right, start, {.relative_residual = 1e-8, .max_iterations = most});
        CAPTURE(most);
        CHECK(solved.report.iterations <= most);
        if (solved.report.converged) CHECK(sheet.residual(sheet.right, solved.x) <= 1e-8 * first);
    }
    const Solved cut = solve(sheet, sheet.right, start, {.relative_residual = 1e-8, .max_iterations = 3});
    CHECK(cut.report.iterations == 3);
    CHECK_FALSE(cut.report.converged);
    CHECK(sheet.residual(sheet.right, cut.x) < first);
}

TEST_CASE("The energy rule leaves an error of about its fraction of the solution") {
    for (const int side : {17, 33, 48}) {
        SheetSystem sheet(static_cast<unsigned>(side) + 20u, side, 0.2);
        sheet.add_contacts(0.2, 0.1, 10.0);
        const Vec3Arrays start = prescribed(sheet), exact = direct_solution(sheet, sheet.right, start);
        const double whole = sheet.energy_norm(difference(exact, start));
        int before = 0;
        for (const double ratio : {0.3, 0.05, 0.01, 1e-3}) {
            const Solved solved = solve(sheet, sheet.right, start, {.relative_gain = ratio});
            const double error = sheet.energy_norm(difference(solved.x, exact));
            CAPTURE(side, ratio, solved.report.iterations, error / whole);
            CHECK(solved.report.converged);
            CHECK(error <= 1.5 * ratio * whole);
            CHECK(solved.report.iterations >= before);
            before = solved.report.iterations;
            const Solved absolute = solve(sheet, sheet.right, start, {.absolute_gain = ratio * ratio * whole * whole});
            CHECK(absolute.report.converged);
            CHECK(sheet.energy_norm(difference(absolute.x, exact)) <= 1.5 * ratio * whole);
        }
    }
}

TEST_CASE("A right side of zero takes no iteration of multigrid") {
    SheetSystem sheet(2, 17, 0.3);
    const Solved solved = solve(sheet, sheet.zeros(), sheet.zeros(), {.relative_residual = 1e-6});
    CHECK(solved.report.iterations == 0);
    CHECK(solved.report.converged);
    CHECK(same_bits(solved.x, sheet.zeros()));
}

TEST_CASE("Multigrid leaves alone what is prescribed everywhere") {
    SheetSystem sheet(3, 17, 0.3);
    sheet.pin_share(1.1);
    const Vec3Arrays start = prescribed(sheet);
    const Solved solved = solve(sheet, sheet.right, start, {.relative_residual = 1e-6});
    CHECK(solved.report.converged);
    CHECK(same_bits(solved.x, start));
}

TEST_CASE("A right side that is not finite ends without an answer") {
    SheetSystem sheet(4, 17, 0.3);
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Vec3Arrays b = sheet.right;
        b.y[100] = value;
        CHECK_FALSE(solve(sheet, b, sheet.zeros(), {.relative_residual = 1e-6}).report.converged);
        CHECK_FALSE(solve(sheet, b, sheet.zeros(), {.relative_gain = 0.05}).report.converged);
    }
}

TEST_CASE("Large and small right sides are solved alike") {
    SheetSystem sheet(5, 17, 0.3);
    const Solved plain = solve(sheet, sheet.right, sheet.zeros(), {.relative_residual = 1e-8});
    for (const double factor : {0x1p-200, 0x1p-30, 0x1p30, 0x1p200}) {
        Vec3Arrays b = sheet.zeros();
        add_scaled(b, factor, sheet.right);
        const Solved solved = solve(sheet, b, sheet.zeros(), {.relative_residual = 1e-8});
        Vec3Arrays scaled = sheet.zeros();
        add_scaled(scaled, 1.0 / factor, solved.x);
        CHECK(solved.report.converged);
        CHECK(solved.report.iterations == plain.report.iterations);
        CHECK(sheet.energy_norm(difference(scaled, plain.x)) <= 1e-12 * sheet.energy_norm(plain.x));
    }
}

TEST_CASE("Clothes of a few vertices are solved, free, pinned and in contact") {
    for (int count = 1; count <= 40; ++count) {
        SheetSystem system(static_cast<unsigned>(count), rope(count), 0.03);
        check_solution(system, 200);
        system.add_contacts(0.5, 0.1, 1e3);
        check_solution(system, 200);
        system.pin_share(0.2);
        check_solution(system, 200);
    }
}

TEST_CASE("Small sheets of any shape are solved") {
    for (int columns = 2; columns <= 7; ++columns) {
        for (int rows = 2; rows <= 6; ++rows) {
            SheetSystem system(static_cast<unsigned>(columns), cloth_model(make_grid(0.3, 0.5, columns, rows), sheet_fabric()),
                               0.02);
            touch_and_pin(system);
            check_solution(system, 200);
        }
    }
}

TEST_CASE("Several separate clothes are solved together") {
    SheetSystem system(6, several_cloths(), 0.01);
    check_solution(system, 100);
    touch_and_pin(system);
    check_solution(system, 200);
}

TEST_CASE("Masses a million times apart are solved") {
    for (const int side : {9, 21, 33}) {
        const ClothModel sheet = cloth_model(make_grid(1.0, 1.0, side, side), sheet_fabric());
        SheetSystem system(static_cast<unsigned>(side), unequal_masses(static_cast<unsigned>(side), sheet), 0.2 / (side - 1));
        check_solution(system, 200);
        touch_and_pin(system);
        check_solution(system, 400);
    }
}

TEST_CASE("Springs as stiff as dt^2 k/m = 1e6 are solved") {
    for (const double factor : {1e-3, 1.0, 100.0, 3000.0}) {
        const ClothModel sheet = cloth_model(make_grid(1.0, 1.0, 17, 17), stiff_fabric(factor));
        SheetSystem system(7, sheet, 0.1 / 16.0);
        CAPTURE(factor, SheetSystem::dt * SheetSystem::dt * 1000.0 * factor / sheet.mass[40]);
        check_solution(system, 200);
        system.matrix.free[0] = system.matrix.free[16] = 0.0;
        system.fill();
        check_solution(system, 200);
    }
}

TEST_CASE("A second solve in the same work space has the same bits, whatever was solved between") {
    SheetSystem sheet(8, 21, 0.3), small(9, 5, 0.3), free(10, several_cloths(), 0.01);
    MultigridSpace space;
    const auto run = [&](const SheetSystem& system) {
        Multigrid multigrid(compute, system.model.adjacency, system.model.rest);
        multigrid.fill(system.matrix, Multigrid::Coarser::filled);
        Vec3Arrays x = system.zeros();
        CHECK(solve_multigrid(system.matrix, multigrid, system.right, {.relative_residual = 1e-7}, space, x).converged);
        return x;
    };
    const Vec3Arrays first = run(sheet);
    for (const SheetSystem* between : {&small, &free}) {
        run(*between);
        CHECK(same_bits(run(sheet), first));
    }
}

TEST_CASE("A net limit keeps both solvers going until the sum of the residuals is below it, too") {
    SheetSystem system(91, 17, 0.3);
    system.matrix.free.assign(system.matrix.free.size(), 1.0);
    system.add_contacts(0.3, 10.0, 1e4);
    const auto net_of = [&](const Vec3Arrays& x) {
        Vec3Arrays r = system.right;
        AlignedVector<double> space;
        set_residual(system.matrix, system.right, x, space, r);
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < system.count(); ++i) sum += r.at(i);
        return sum.norm();
    };
    const double start = net_of(system.zeros());
    for (const bool multigrid : {false, true}) {
        const auto solved = [&](std::span<const NetLimit> net) {
            const SolveTarget target{.relative_residual = 1e-10, .relative_gain = 0.5, .net = net};
            if (multigrid) return solve(system, system.right, system.zeros(), target);
            SolveSpace space;
            Solved result{{}, system.zeros()};
            result.report = solve_cg(system.matrix, system.right, target, space, result.x);
            return result;
        };
        CAPTURE(multigrid);
        const Solved loose = solved({});
        const std::vector<NetLimit> limit = {{0, system.count(), 0.1 * net_of(loose.x)}};
        const Solved kept = solved(limit);
        CHECK(loose.report.converged);
        CHECK(kept.report.converged);
        CHECK(kept.report.iterations > loose.report.iterations);
        CHECK(net_of(kept.x) <= limit[0].max_momentum + 1e-5 * start);
    }
}

}  // namespace percale::test::multigrid_solve_test
