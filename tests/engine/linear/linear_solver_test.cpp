#include "engine/linear/linear_solver.h"

#include <limits>

#include "engine/forces/pressure.h"
#include "tests/support/catch.h"
#include "tests/support/forces/sheet_system.h"

namespace percale::test::linear_solver_test {
namespace {

constexpr LinearSolver all_choices[] = {LinearSolver::automatic, LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct};

/// A solver prepared for a sheet, its pins and contacts.
struct Prepared {
    StepSolver solver;

    Prepared(const SheetSystem& sheet, LinearSolver wish) { prepare(sheet, wish); }

    void prepare(const SheetSystem& sheet, LinearSolver wish) {
        solver.set_model(compute, sheet.model, wish);
        solver.matrix.free = sheet.matrix.free;
        solver.fill(sheet.terms, sheet.contacts, sheet.blocks);
    }
    SolveReport solve(const SheetSystem& sheet, double tolerance, Vec3Arrays& x) {
        x.resize(sheet.count());
        return solver.solve(sheet.right, {.relative_residual = tolerance}, x);
    }
};

}  // namespace

TEST_CASE("Every choice solves the same system to the same answer") {
    SheetSystem sheet(1, 21, 0.4);
    sheet.pin_share(0.05);
    sheet.add_contacts(0.3, 0.1, 100.0);
    if (GENERATE(false, true)) sheet.hold_areas(10.0);
    Vec3Arrays exact;
    Prepared direct(sheet, LinearSolver::direct);
    CHECK(direct.solve(sheet, 0.0, exact).converged);
    for (const LinearSolver choice : all_choices) {
        Prepared prepared(sheet, choice);
        Vec3Arrays x;
        for (int solves = 0; solves < 3; ++solves) {
            const SolveReport report = prepared.solve(sheet, 1e-10, x);
            CAPTURE(static_cast<int>(choice), solves, report.iterations);
            CHECK(report.converged);
            CHECK(report.iterations >= 1);
            CHECK(sheet.energy_norm(difference(x, exact)) <= 1e-7 * sheet.energy_norm(exact));
            prepared.solver.fill(sheet.terms, sheet.contacts, sheet.blocks);
        }
    }
}

TEST_CASE("A choice that was asked for stays") {
    const SheetSystem sheet(2, 17, 0.3);
    for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct}) {
        Prepared prepared(sheet, choice);
        Vec3Arrays x;
        for (int solves = 0; solves < 2; ++solves) {
            prepared.solve(sheet, 1e-12, x);
            prepared.solver.fill(sheet.terms, {}, no_blocks);
            CHECK(prepared.solver.in_use() == choice);
        }
    }
}

TEST_CASE("The automatic choice begins with block Jacobi and keeps it while solves are cheap") {
    const SheetSystem sheet(3, 33, 0.3);
    Prepared prepared(sheet, LinearSolver::automatic);
    CHECK(prepared.solver.in_use() == LinearSolver::cg);
    Vec3Arrays x;
    const SolveReport report = prepared.solve(sheet, 0.5, x);
    REQUIRE(report.iterations < 20);
    CHECK(prepared.solver.in_use() == LinearSolver::cg);
}

TEST_CASE("The automatic choice changes to multigrid in the midst of a dear solve, and the next is cheaper") {
    const SheetSystem sheet(4, 33, 0.3);
    Prepared prepared(sheet, LinearSolver::automatic), jacobi(sheet, LinearSolver::cg), multigrid(sheet, LinearSolver::multigrid);
    Vec3Arrays x, by_jacobi;
    const SolveReport dear = prepared.solve(sheet, 1e-6, x), dearest = jacobi.solve(sheet, 1e-6, by_jacobi);
    CHECK(dear.converged);
    CHECK(dear.iterations < dearest.iterations);
    CHECK(sheet.energy_norm(difference(x, by_jacobi)) <= 1e-4 * sheet.energy_norm(x));
    CHECK(prepared.solver.in_use() == LinearSolver::multigrid);
    prepared.solver.fill(sheet.terms, {}, no_blocks);
    const SolveReport cheap = prepared.solve(sheet, 1e-6, x);
    CHECK(cheap.converged);
    CHECK(2 * cheap.iterations < dear.iterations);
    CHECK(cheap.iterations == multigrid.solve(sheet, 1e-6, x).iterations);
    CHECK(prepared.solver.in_use() == LinearSolver::multigrid);
}

TEST_CASE("The automatic choice factorises small cloth of moduli with slivers, and no other") {
    const auto strip = [](double height, const Fabric& fabric) {
        return cloth_model(
            {.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, height}, {0.5, 0, -0.5}}, .triangles = {{0, 2, 1}, {0, 1, 3}}}, fabric);
    };
    const Fabric moduli{.springs = {.structural = 0.0}, .stretch_stiffness = std::array{100.0, 100.0}};
    const ClothModel sliver = strip(0.005, moduli), even = strip(0.02, moduli), springs = strip(0.005, free_fabric());
    StepSolver solver;
    const auto begins_with = [&](const ClothModel& model) {
        solver.set_model(compute, model, LinearSolver::automatic);
        return solver.in_use();
    };
    CHECK(begins_with(springs) == LinearSolver::cg);
    CHECK(begins_with(sliver) == LinearSolver::direct);
    CHECK(begins_with(even) == LinearSolver::cg);
    solver.begin_with(LinearSolver::direct);  // the solver of the model before
    CHECK(begins_with(even) == LinearSolver::cg);
    CHECK(begins_with(sliver) == LinearSolver::direct);
}

TEST_CASE("Another model starts anew") {
    const SheetSystem sheet(5, 33, 0.3), other(6, 9, 0.3);
    Prepared prepared(sheet, LinearSolver::automatic), fresh(other, LinearSolver::automatic);
    Vec3Arrays x, expected;
    prepared.solve(sheet, 1e-6, x);
    REQUIRE(prepared.solver.in_use() == LinearSolver::multigrid);
    CHECK(prepared.solver.is_for(sheet.model));
    CHECK_FALSE(prepared.solver.is_for(other.model));
    prepared.prepare(other, LinearSolver::automatic);
    CHECK(prepared.solver.is_for(other.model));
    CHECK(prepared.solver.in_use() == LinearSolver::cg);
    CHECK(prepared.solve(other, 1e-8, x).iterations == fresh.solve(other, 1e-8, expected).iterations);
    CHECK(same_bits(x, expected));
    prepared.solver.forget_model();
    CHECK_FALSE(prepared.solver.is_for(other.model));
}

TEST_CASE("A solver that was asked for serves one model after the other") {
    const SheetSystem sheet(8, 21, 0.3), other(9, 21, 0.3);
    for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct}) {
        Prepared prepared(sheet, choice), fresh(other, choice);
        Vec3Arrays x, expected;
        prepared.solve(sheet, 1e-8, x);
        prepared.prepare(other, choice);
        prepared.solve(other, 1e-8, x);
        fresh.solve(other, 1e-8, expected);
        CHECK(same_bits(x, expected));
    }
    Prepared prepared(sheet, LinearSolver::multigrid);
    const SheetSystem larger(10, 33, 0.3);
    Vec3Arrays x;
    prepared.solve(sheet, 1e-8, x);
    prepared.prepare(larger, LinearSolver::multigrid);
    CHECK(prepared.solve(larger, 1e-8, x).converged);
    CHECK(larger.residual(larger.right, x) <= 1e-6);
}

TEST_CASE("The estimate is near the solution with multigrid and refused without") {
    SheetSystem sheet(7, 25, 0.3);
    Vec3Arrays b = sheet.right, exact, estimate;
    filter(sheet.matrix, b);
    Prepared multigrid(sheet, LinearSolver::multigrid), jacobi(sheet, LinearSolver::cg);
    multigrid.solve(sheet, 1e-10, exact);
    REQUIRE(multigrid.solver.estimate(b, estimate));
    CHECK(sheet.energy_norm(difference(estimate, exact)) <= 0.6 * sheet.energy_norm(exact));
    CHECK_FALSE(jacobi.solver.estimate(b, estimate));
    Vec3Arrays zero;
    zero.resize(sheet.count());
    CHECK_FALSE(multigrid.solver.estimate(zero, estimate));
}

TEST_CASE("The estimate of what a step would gain is within a factor of three") {
    for (const int side : {17, 33, 65}) {
        for (const double ratio : {0.0, 0.3}) {
            SheetSystem sheet(static_cast<unsigned>(side) + 30u, side, 0.3);
            sheet.pin_share(0.1 * ratio);
            sheet.add_contacts(ratio, 0.1, 1e3);
            Prepared prepared(sheet, LinearSolver::multigrid);
            Vec3Arrays smooth = sheet.right;
            filter(sheet.matrix, smooth);
            for (const Vec3Arrays& r : {smooth, sheet.random_vector()}) {
                Vec3Arrays exact, z;
                exact.resize(sheet.count());
                REQUIRE(prepared.solver.solve(r, {.relative_residual = 1e-9}, exact).converged);
                REQUIRE(prepared.solver.estimate(r, z));
                const double decrement = dot(compute, r, exact), estimate = dot(compute, r, z);
                CAPTURE(side, ratio, estimate / decrement);
                CHECK(estimate <= 3.0 * decrement);
                CHECK(decrement <= 3.0 * estimate);
            }
        }
    }
}

TEST_CASE("Scaling the residual scales its estimate, however large or small, and what was there is replaced") {
    const SheetSystem sheet(11, 17, 0.3);
    Prepared prepared(sheet, LinearSolver::multigrid);
    Vec3Arrays r = sheet.right, z, scaled_z = sheet.right;
    filter(sheet.matrix, r);
    REQUIRE(prepared.solver.estimate(r, z));
    for (const double factor : {0x1p-200, 0x1p-60, 0x1p60, 0x1p200}) {
        Vec3Arrays scaled;
        scaled.resize(sheet.count());
        add_scaled(scaled, factor, r);
        REQUIRE(prepared.solver.estimate(scaled, scaled_z));
        for (int i = 0; i < sheet.count(); ++i) CHECK((scaled_z.at(i) / factor - z.at(i)).norm() <= 1e-12 * z.at(i).norm());
    }
}

TEST_CASE("Nothing is estimated of a residual that is not finite") {
    const SheetSystem sheet(12, 17, 0.3);
    Prepared prepared(sheet, LinearSolver::multigrid);
    Vec3Arrays r = sheet.right, z;
    r.x[20] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(prepared.solver.estimate(r, z));
    r.x[20] = 1e200;
    CHECK_FALSE(prepared.solver.estimate(r, z));
}

TEST_CASE("With coarser levels kept from another state the answer is the same") {
    for (const int side : {17, 33, 48}) {
        const SheetSystem first(1, side, 0.05);
        SheetSystem later(2, side, 0.5, Vec3(1.1, 1.0, 0.8));
        later.add_contacts(0.3, 0.1, 1e3);
        Prepared kept(first, LinearSolver::multigrid), fresh(later, LinearSolver::multigrid);
        Vec3Arrays x, expected;
        kept.solve(first, 1e-6, x);
        fresh.solve(later, 1e-10, expected);
        for (int solves = 0; solves < 4; ++solves) {
            kept.solver.fill(later.terms, later.contacts, no_blocks);
            const SolveReport report = kept.solve(later, 1e-10, x);
            CAPTURE(side, solves, report.iterations);
            CHECK(report.converged);
            CHECK(later.residual(later.right, x) <= 1.001e-10 * later.residual(later.right, later.zeros()));
            CHECK(later.energy_norm(difference(x, expected)) <= 1e-6 * later.energy_norm(expected));
        }
    }
}

TEST_CASE("A new part of a step starts with coarser levels of its own matrix") {
    const SheetSystem first(1, 33, 0.05), later(2, 33, 0.5, Vec3(1.1, 1.0, 0.8));
    Prepared reused(first, LinearSolver::multigrid), fresh(later, LinearSolver::multigrid);
    Vec3Arrays x, expected;
    reused.solve(first, 1e-6, x);
    reused.solver.start_stage();
    reused.solver.fill(later.terms, later.contacts, no_blocks);
    CHECK(reused.solve(later, 1e-6, x).iterations == fresh.solve(later, 1e-6, expected).iterations);
    CHECK(same_bits(x, expected));
}

namespace {

/// A ball of gas that presses it out, stretched by a tenth, and the gas in the matrix.
struct FilledBall {
    SheetSystem system;
    Vec3Arrays positions;
    Forces forces;

    FilledBall() : system(5, filled_model(), 0.0, 1.1 * Vec3::Ones()) {
        std::vector<Vec3> places = system.model.rest;
        for (Vec3& x : places) x *= 1.1;
        positions = to_vec3_arrays(places);
        forces.total.resize(system.count());
        pressure_term().add({.compute = &compute,
                             .model = &system.model,
                             .positions = &positions,
                             .velocities = &positions,
                             .dt = SheetSystem::dt,
                             .with_matrix = true},
                            forces);
        system.pin_share(0.1);
        set_blocks({}, forces.blocks, system.matrix);
    }

    /// The motion of prescribed vertices, 0 at the others.
    Vec3Arrays moving_pins() const {
        Random own(8);
        Vec3Arrays x = system.zeros();
        for (int i = 0; i < system.count(); ++i) {
            if (system.matrix.free[i] == 0.0) x.set(i, own.point(0.1));
        }
        return x;
    }

    static ClothModel filled_model() {
        Fabric fabric = free_fabric();
        fabric.gas_volume = 0.0443;  // some 200 Pa above the air
        return cloth_model(make_sphere(0.2, 3), fabric);
    }
};

}  // namespace

TEST_CASE("Every choice takes gas into account, beside pins that move") {
    FilledBall ball;
    const Vec3Arrays pins = ball.moving_pins();
    const double before = ball.system.residual(ball.system.right, pins);
    for (const LinearSolver choice : all_choices) {
        StepSolver solver;
        solver.set_model(compute, ball.system.model, choice);
        solver.matrix.free = ball.system.matrix.free;
        for (int solves = 0; solves < 2; ++solves) {
            solver.fill(ball.system.terms, {}, ball.forces.blocks);
            Vec3Arrays x = pins;
            const SolveReport report = solver.solve(ball.system.right, {.relative_residual = 1e-8}, x);
            CAPTURE(static_cast<int>(choice), report.iterations);
            CHECK(report.converged);
            CHECK(ball.system.residual(ball.system.right, x) <= 2e-8 * before);
        }
    }
}

TEST_CASE("A wide outer block costs no iterations, however stiff it is") {
    FilledBall ball;
    ball.forces.blocks.loads.clear();
    for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct}) {
        std::vector<int> iterations;
        for (const double factor : {0.0, 1.0, 1e3}) {
            const OuterBlocks::Block from = ball.forces.blocks.outer[0];
            ForceBlocks blocks;
            const OuterBlocks::NewBlock to = blocks.outer.add(static_cast<int>(from.vertex.size()));
            std::ranges::copy(from.vertex, to.vertex.begin());
            std::ranges::transform(from.gradient, to.gradient.begin(), [=](const Vec3& g) { return Vec3(factor * g); });
            StepSolver solver;
            solver.set_model(compute, ball.system.model, choice);
            solver.matrix.free = ball.system.matrix.free;
            solver.fill(ball.system.terms, {}, blocks);
            Vec3Arrays x = ball.system.zeros();
            iterations.push_back(solver.solve(ball.system.right, {.relative_residual = 1e-6}, x).iterations);
        }
        CAPTURE(static_cast<int>(choice), iterations);
        CHECK(iterations[1] <= iterations[0] + 3);
        CHECK(iterations[2] <= iterations[0] + 3);
    }
}

TEST_CASE("Multigrid sees local outer blocks on all its levels: it needs a tenth of block Jacobi's iterations, as without them") {
    for (const double factor : {0.0, 1.0, 10.0}) {
        SheetSystem sheet(3, 33, 0.3);
        if (factor > 0.0) sheet.hold_areas(factor);
        std::vector<int> iterations;
        for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid}) {
            Prepared prepared(sheet, choice);
            Vec3Arrays x;
            const SolveReport report = prepared.solve(sheet, 1e-6, x);
            CHECK(report.converged);
            iterations.push_back(report.iterations);
        }
        CAPTURE(factor, iterations);
        CHECK(10 * iterations[1] < iterations[0]);
    }
}

TEST_CASE("Where loads leave no positive definite matrix, the answer still leads downhill") {
    FilledBall ball;
    for (LoadTriangle& load : ball.forces.blocks.loads) {  // far beyond what tension holds
        load.first *= 1e5;
        load.second *= 1e5;
    }
    for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct}) {
        StepSolver solver;
        solver.set_model(compute, ball.system.model, choice);
        solver.matrix.free = ball.system.matrix.free;
        solver.fill(ball.system.terms, {}, ball.forces.blocks);
        Vec3Arrays x = ball.system.zeros();
        CHECK_FALSE(solver.solve(ball.system.right, {.relative_residual = 1e-8}, x).converged);
        CHECK(dot(compute, ball.system.right, x) > 0.0);
    }
}

}  // namespace percale::test::linear_solver_test
