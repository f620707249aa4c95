#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "scenes/stress/stress.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::stress_matrix_test {

TEST_CASE("The default matrix has 2000 cells or more and covers every range that it is said to cover") {
    const std::vector<StressCell> cells = stress_matrix();
    CHECK(cells.size() >= 2000);
    CHECK(cells[1234].number == 1234);
    const auto spans = [&](auto value, double lowest, double highest) {
        const auto [least, most] =
            std::minmax_element(cells.begin(), cells.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
        CHECK(value(*least) == Approx(lowest));
        CHECK(value(*most) == Approx(highest));
    };
    spans([](const StressCell& cell) { return cell.time_step; }, 1e-4, 1.0);
    spans([](const StressCell& cell) { return cell.stiffness; }, 1.0, 1e8);
    spans([](const StressCell& cell) { return cell.mass_ratio; }, 1.0, 1e6);
    spans([](const StressCell& cell) { return cell.damping_ratio; }, 0.0, 10.0);
    spans([](const StressCell& cell) { return cell.aspect; }, 1.0, 1e6);
}

TEST_CASE("No cell of the default matrix is made twice") {
    std::set<std::tuple<Scheme, double, double, double, double, StressMesh, double, StressStart, StressContact>> made;
    const std::vector<StressCell> cells = stress_matrix();
    for (const StressCell& cell : cells)
        made.emplace(cell.scheme, cell.time_step, cell.stiffness, cell.mass_ratio, cell.damping_ratio, cell.mesh, cell.aspect,
                     cell.start, cell.contact);
    CHECK(made.size() == cells.size());
}

TEST_CASE("All nine schemes have the same sweeps, and contact those that take it") {
    std::set<std::string> sweeps[9];
    for (const StressCell& cell : stress_matrix()) {
        sweeps[static_cast<int>(cell.scheme)].insert(cell.sweep);
        if (cell.contact == StressContact::projection) CHECK(cell.scheme == Scheme::backward_euler);
        if (cell.contact != StressContact::none) CHECK((cell.scheme == Scheme::backward_euler || cell.scheme == Scheme::tr_bdf2));
    }
    const std::set<std::string> all = {"base", "mass ratio", "damping", "mesh", "start", "contact"};
    for (int scheme = 0; scheme < 9; ++scheme) {
        std::set<std::string> expected = all;
        if (scheme != static_cast<int>(Scheme::backward_euler) && scheme != static_cast<int>(Scheme::tr_bdf2))
            expected.erase("contact");
        CHECK(sweeps[scheme] == expected);
    }
}

}  // namespace percale::scenes::test::stress_matrix_test
