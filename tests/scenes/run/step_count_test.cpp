#include "scenes/run/step_count.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::step_count_test {

TEST_CASE("a duration that is a multiple of the step up to rounding takes only full steps") {
    CHECK(count_steps(2.0, 1.0 / 60.0).steps == 120);
    CHECK(count_steps(2.0, 0.016666666666666666).last_dt == 0.016666666666666666);
    CHECK(count_steps(0.3, 0.1).steps == 3);
    CHECK(count_steps(0.3, 0.1).last_dt == 0.1);
    CHECK(count_steps(1e4, 1e-3).steps == 10000000);
}

TEST_CASE("a remainder that is no step of its own makes the last step longer") {
    CHECK(count_steps(1.0, 0.016666666).steps == 60);
    CHECK(count_steps(1.0, 0.016666666).last_dt == Approx(0.016666666 + 4e-8).epsilon(1e-12));
    CHECK(count_steps(3.0005, 1.0).steps == 4);
}

TEST_CASE("otherwise the last step is what is left") {
    CHECK(count_steps(1.0, 0.3).steps == 4);
    CHECK(count_steps(1.0, 0.3).last_dt == Approx(0.1));
    CHECK(count_steps(0.004, 0.01).steps == 1);
    CHECK(count_steps(0.004, 0.01).last_dt == Approx(0.004));
}

}  // namespace percale::scenes::test::step_count_test
