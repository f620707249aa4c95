#include <cstdio>

#include "scenes/stress/stress_report.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::validation_stress_test {

TEST_CASE("Backward Euler and TR-BDF2 stand the default matrix of percale stress, and no scheme fails silently") {
    const StressRun run = stress_cells(stress_matrix(), 16, {});
    std::printf("%s%s", stress_summary(run).c_str(), stress_failures(run, 20).c_str());
    CHECK(run.rows.size() >= 2000);
    CHECK(run.failures() == 0);
    for (const StressRow& row : run.rows) {
        CHECK(row.figures.finite);
        CHECK(row.figures.pins_kept);
        const bool euler = row.cell.scheme == Scheme::backward_euler;
        if (euler || row.cell.scheme == Scheme::tr_bdf2) CHECK(row.verdict == StressVerdict::stable);
        if (euler) CHECK(row.figures.gain < 1e-9);
    }
}

}  // namespace percale::scenes::test::validation_stress_test
