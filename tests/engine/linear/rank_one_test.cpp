#include "engine/linear/rank_one.h"

#include "engine/linear/linear_solver.h"
#include "tests/support/catch.h"
#include "tests/support/forces/sheet_system.h"

namespace percale::test {
namespace {

std::vector<RankOne> random_blocks(SheetSystem& sheet, const std::vector<double>& factors) {
    std::vector<RankOne> blocks;
    for (const double factor : factors) {
        RankOne block{.factor = factor, .gradient = sheet.zeros()};
        for (int i = 0; i < sheet.count(); ++i) block.gradient.set(i, sheet.random.point(1.0));
        blocks.push_back(std::move(block));
    }
    return blocks;
}

/// b - (A + sum c g g^T) x
Vectors what_is_left(const SheetSystem& sheet, std::span<const RankOne> blocks, const Vectors& x) {
    AlignedVector<double> points;
    Vectors left = sheet.right, product = sheet.zeros();
    multiply(sheet.matrix, x, points, product);
    add_rank_one(compute, blocks, x, product);
    add_scaled(left, -1.0, product);
    filter(sheet.matrix, left);
    return left;
}

double norm(const Vectors& x) { return std::sqrt(dot(compute, x, x)); }

/// Solves until nothing is left: answers for the blocks are known to rank_one_residual only, so each go leaves a share.
void check_refined(const SheetSystem& sheet, std::span<const RankOne> blocks, LinearSolver choice) {
    StepSolver solver;
    solver.set_model(compute, sheet.model, choice);
    solver.matrix.free = sheet.matrix.free;
    solver.fill(sheet.terms, {}, blocks);
    Vectors x = sheet.zeros();
    Vectors left = what_is_left(sheet, blocks, x);
    const double start = norm(left);
    for (int go = 0; go < 6 && norm(left) > 1e-8 * start; ++go) {
        const double before = norm(left);
        Vectors more = sheet.zeros();
        CHECK(solver.solve(left, {.relative_residual = 1e-10}, more).converged);
        add_scaled(x, 1.0, more);
        left = what_is_left(sheet, blocks, x);
        CHECK(norm(left) <= 0.1 * before);
    }
    CHECK(norm(left) <= 1e-8 * start);
}

}  // namespace

TEST_CASE("Every solver takes blocks of rank one, from none to many times stiffer than all springs, pins among their vertices") {
    for (const std::vector<double>& factors : {std::vector<double>{1e-3}, {1e5}, {1e-2, 1e4, 0.0}, {1e5, 1e4}}) {
        for (const LinearSolver choice : {LinearSolver::cg, LinearSolver::multigrid, LinearSolver::direct}) {
            SheetSystem sheet(3, 15, 0.3);
            sheet.pin_share(0.1);
            CAPTURE(factors.size(), factors[0], static_cast<int>(choice));
            check_refined(sheet, random_blocks(sheet, factors), choice);
        }
    }
}

TEST_CASE("However little exact the answers are, a stiff block lets nothing through") {
    SheetSystem sheet(4, 15, 0.3);
    const std::vector<RankOne> blocks = random_blocks(sheet, {1e9});
    StepSolver solver;
    solver.set_model(compute, sheet.model, LinearSolver::cg);
    solver.matrix.free = sheet.matrix.free;
    solver.fill(sheet.terms, {});
    Vectors soft = sheet.zeros(), stiff = sheet.zeros();
    solver.solve(sheet.right, {.relative_residual = 1e-3}, soft);
    solver.fill(sheet.terms, {}, blocks);
    solver.solve(sheet.right, {.relative_residual = 1e-3}, stiff);
    const double open = dot(compute, blocks[0].gradient, soft), shut = dot(compute, blocks[0].gradient, stiff);
    CHECK(std::abs(shut) <= 1e-6 * std::abs(open));
}

}  // namespace percale::test
