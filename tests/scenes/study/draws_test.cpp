#include "scenes/study/draws.h"

#include <cmath>

#include "tests/support/catch.h"

namespace percale::scenes::test::draws_test {

TEST_CASE("a seed gives the same numbers everywhere: the engine's 10,000th is in the standard, fractions are its upper bits") {
    std::mt19937_64 engine;  // seed 5489; its 10,000th value is in the C++ standard
    for (int i = 1; i < 10000; ++i) engine();
    CHECK(engine() == 9981545732273789042ull);
    std::mt19937_64 same(7);
    Draws draws(7);
    for (int i = 0; i < 100; ++i) CHECK(draws.share() == static_cast<double>(same() >> 11) * 0x1p-53);
}

TEST_CASE("uniform numbers fill their range evenly, logarithmic ones their decades") {
    Draws draws(1);
    int below = 0, first_decade = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const double x = draws.uniform(2.0, 6.0), y = draws.log_uniform(0.01, 10.0);
        CHECK((x >= 2.0 && x < 6.0 && y >= 0.01 && y <= 10.0));
        below += x < 3.0 ? 1 : 0;
        first_decade += y < 0.1 ? 1 : 0;
    }
    // Four standard deviations of the counts.
    CHECK(std::abs(below - count / 4.0) < 4.0 * std::sqrt(count * 0.25 * 0.75));
    CHECK(std::abs(first_decade - count / 3.0) < 4.0 * std::sqrt(count / 3.0 * 2.0 / 3.0));
}

TEST_CASE("normal numbers have their mean and deviation, and two thirds lie within one") {
    Draws draws(3);
    double sum = 0.0, squares = 0.0;
    int within = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const double x = draws.normal(5.0, 2.0);
        sum += x;
        squares += (x - 5.0) * (x - 5.0);
        within += std::abs(x - 5.0) < 2.0 ? 1 : 0;
    }
    CHECK(sum / count == Approx(5.0).margin(4.0 * 2.0 / std::sqrt(count)));
    CHECK(std::sqrt(squares / count) == Approx(2.0).epsilon(0.03));
    CHECK(within / static_cast<double>(count) == Approx(0.6827).margin(0.014));
}

}  // namespace percale::scenes::test::draws_test
