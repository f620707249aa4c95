#include "engine/contact/coulomb.h"

#include "tests/support/catch.h"

namespace percale::test::coulomb_test {
namespace {

constexpr double limit = 2.0, threshold = 1e-4;
constexpr CoulombLaw law{limit, threshold};

}  // namespace

TEST_CASE("Friction is a spring up to the stick threshold and at its limit beyond, against the slip") {
    const Vec3 along = Vec3(3, 0, 4) / 5.0;
    for (const double ratio : {0.0, 0.1, 0.99, 1.0, 1.01, 300.0}) {
        const Vec3 slip = ratio * threshold * along;
        CAPTURE(ratio);
        CHECK((law.force(slip) + limit * std::min(ratio, 1.0) * along).norm() < 1e-12);
        CHECK(law.slides(slip.norm()) == (ratio > 1.0));
        CHECK((law.stiffness(slip.norm()) * slip + law.force(slip)).norm() < 1e-12);
        CHECK((law.anchored(slip) - std::min(ratio, 1.0) * threshold * along).norm() < 1e-16);
    }
}

TEST_CASE("The force is minus the derivative of the potential; what is not stored is limit times the way beyond the threshold") {
    for (const double slip : {0.3 * threshold, 0.9 * threshold, 1.1 * threshold, 7.0 * threshold}) {
        const double step = 1e-5 * slip;
        const double slope = (law.potential(slip + step) - law.potential(slip - step)) / (2.0 * step);
        CHECK(slope == Approx(law.force(Vec3(-slip, 0, 0)).x()).epsilon(1e-9));
        CHECK(law.potential(slip) - law.stored(slip) ==
              Approx(limit * std::max(slip - threshold, 0.0)).epsilon(1e-12).margin(1e-18));
    }
    CHECK(law.stored(threshold) == Approx(0.5 * limit * threshold));
}

}  // namespace percale::test::coulomb_test
