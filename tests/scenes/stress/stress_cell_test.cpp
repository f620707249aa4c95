#include "scenes/stress/stress_cell.h"

#include <cmath>

#include "percale/error.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::stress_cell_test {

namespace {

double mass_of(const StressCase& made, std::size_t cloth) {
    double sum = 0.0;
    for (const double mass : made.simulation.masses(made.cloths[cloth])) sum += mass;
    return sum;
}

std::vector<Vec3> places(const StressCell& cell) {
    const StressCase made = make_case(cell);
    const std::span<const Vec3> positions = made.simulation.positions(made.cloths[0]);
    return {positions.begin(), positions.end()};
}

}  // namespace

TEST_CASE("A cell's cloths weigh as its mass ratio says, and their geometric mean stays") {
    for (const double ratio : {1e2, 1e6}) {
        const StressCase made = make_case({.mass_ratio = ratio});
        REQUIRE(made.cloths.size() == 2);
        CHECK(mass_of(made, 1) / mass_of(made, 0) == Approx(ratio));
        CHECK(std::sqrt(mass_of(made, 0) * mass_of(made, 1)) == Approx(0.2 * 0.16));
    }
    CHECK(make_case({}).cloths.size() == 1);
}

TEST_CASE("Every mesh of the matrix is a cloth, and slivers are as thin as asked for") {
    for (const StressMesh mesh : {StressMesh::grid, StressMesh::sliver, StressMesh::random})
        CHECK(places({.mesh = mesh, .aspect = 1e6}).size() == 25);
    const std::vector<Vec3> rest = places({.mesh = StressMesh::sliver, .aspect = 1e4, .start = StressStart::hang});
    CHECK(std::abs(rest[15].z() - rest[10].z()) == Approx(0.1 / 1e4));
    CHECK(places({.mesh = StressMesh::random}) == places({.mesh = StressMesh::random}));
}

TEST_CASE("Starts are as hard as their names say, and corners stay where they are held") {
    const std::vector<Vec3> rest = places({.start = StressStart::hang});
    for (const StressStart start : {StressStart::thrown, StressStart::crumpled, StressStart::point}) {
        const std::vector<Vec3> now = places({.start = start});
        for (const int corner : {0, 4}) CHECK(now[corner] == rest[corner]);
        const double apart = (now[12] - now[13]).norm();
        if (start == StressStart::point) CHECK(apart == 0.0);
        if (start == StressStart::crumpled) CHECK(apart < 0.07);
        if (start == StressStart::thrown) CHECK((now[12] - rest[12]).norm() < 0.035);
        CHECK(now[12] != rest[12]);
    }
}

TEST_CASE("The largest frequency of a cell is that of its cloth, and grows with the root of the stiffness") {
    const double square = largest_square({.stiffness = 1e3});
    CHECK(largest_square({.stiffness = 1e5}) == Approx(1e2 * square).epsilon(1e-9));
    // Four structural and four diagonal neighbours: at most 2 (4 k + 4 k/2 + ...)/m for the lightest mass that has so many.
    CHECK(square > 4.0 * 1e3 / 0.002);
    CHECK(square < 16.0 * 1e3 / 0.0005);
}

TEST_CASE("Contact in a form that the scheme does not take is refused") {
    CHECK_THROWS_AS(make_case({.scheme = Scheme::rk4, .contact = StressContact::penalty}), SceneError);
    CHECK_THROWS_AS(make_case({.scheme = Scheme::tr_bdf2, .contact = StressContact::projection}), SceneError);
}

}  // namespace percale::scenes::test::stress_cell_test
