#include <vector>

#include "engine/linear/multigrid.h"
#include "engine/linear/multigrid_solve.h"
#include "tests/support/catch.h"
#include "tests/support/forces/sheet_system.h"

namespace percale::test::multigrid_cycle_test {
namespace {

/// Constraints of three vertices, of which many share some, and of one.
void contact_by_constraints(SheetSystem& sheet, int rows) {
    sheet.add_contacts(0.1, 1.0, 1e3);
    for (int row = 0; row < rows; ++row) {
        const int first = sheet.random.index(sheet.count() / 4);
        CoupledBlock block = sheet.contacts.at(row % 100);
        block.vertex = {first, first + 1, first + 2 + sheet.random.index(200), -1};
        block.weight = {0.5, 0.3, row % 7 == 0 ? 0.0 : 0.2, 0.0};
        sheet.contacts.push_back(block);
    }
    sheet.fill();
}

struct Cycled {
    AlignedVector<float> correction, product;
    Vec3Arrays solution;
    int iterations = 0;
};

Cycled cycled(const SheetSystem& sheet, const Compute& on, const Vec3Arrays& r) {
    Multigrid multigrid(on, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    Cycled result;
    on.kernels->to_float(1.0, r.axes(), {multigrid.residual().data(), multigrid.padded()}, {0, r.slices()});
    multigrid.cycle();
    result.correction = multigrid.correction();
    result.product.resize(3 * multigrid.padded());
    multigrid.multiply(result.correction, result.product);
    MultigridSpace space;
    result.solution = sheet.zeros();
    const SolveTarget target{.relative_residual = 1e-6, .max_iterations = 200};
    result.iterations = solve_multigrid(sheet.matrix, multigrid, r, target, space, result.solution).iterations;
    return result;
}

}  // namespace

TEST_CASE("Constraints that share vertices, and outer blocks, act on each as the exact matrix does") {
    SheetSystem sheet(5, 33, 0.4);
    sheet.pin_share(0.1);
    sheet.hold_areas(5.0);
    contact_by_constraints(sheet, 700);
    Multigrid multigrid(compute, sheet.model.adjacency, sheet.model.rest);
    multigrid.fill(sheet.matrix, Multigrid::Coarser::filled);
    const Vec3Arrays x = sheet.random_vector();
    AlignedVector<float> narrow(3 * multigrid.padded()), product(3 * multigrid.padded());
    compute.kernels->to_float(1.0, x.axes(), {narrow.data(), multigrid.padded()}, {0, x.slices()});
    multigrid.multiply(narrow, product);
    AlignedVector<double> points;
    Vec3Arrays expected = x, found = sheet.zeros();
    multiply(sheet.matrix, x, points, expected);
    compute.kernels->add_float(1.0, {product.data(), multigrid.padded()}, found.axes(), {0, x.slices()});
    const Vec3Arrays error = difference(found, expected);
    CHECK(std::sqrt(dot(compute, error, error)) <= 1e-6 * std::sqrt(dot(compute, expected, expected)));
    for (int i = 0; i < sheet.count(); ++i) CHECK((sheet.matrix.free[i] > 0.0 || found.at(i) == Vec3::Zero()));
}

TEST_CASE("Cycles, products and solves have the same bits for any number of threads", "[slow]") {
    const bool itself = GENERATE(false, true);
    SheetSystem sheet(6, 97, 0.2);
    sheet.pin_share(0.02);
    if (itself) sheet.hold_areas(5.0);
    contact_by_constraints(sheet, 1500);
    if (itself) sheet.add_self_contacts(1500, 3.0);
    const Vec3Arrays r = sheet.random_vector();
    const Cycled alone = cycled(sheet, compute, r);
    CHECK(alone.iterations > 5);
    for (const int threads : {2, 3, 6}) {
        ThreadPool pool(threads);
        const Cycled shared = cycled(sheet, {.workers = &pool}, r);
        CAPTURE(threads, itself);
        CHECK(shared.correction == alone.correction);
        CHECK(shared.product == alone.product);
        CHECK(shared.iterations == alone.iterations);
        CHECK((shared.solution.x == alone.solution.x && shared.solution.y == alone.solution.y &&
               shared.solution.z == alone.solution.z));
    }
}

}  // namespace percale::test::multigrid_cycle_test
