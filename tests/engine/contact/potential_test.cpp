#include "engine/contact/potential.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"

namespace percale::test::potential_test {
namespace {

constexpr double h = 0.005, stiffness = 200.0;

}  // namespace

TEST_CASE("The contact potential starts at the thickness with value and slope zero") {
    for (const double d : {h, 1.5 * h, 1.0}) {
        const ContactPotential p = contact_potential(d, h, stiffness);
        CHECK((p.energy == 0.0 && p.slope == 0.0 && p.curvature == 0.0));
    }
    const ContactPotential below = contact_potential(h * (1.0 - 1e-9), h, stiffness);
    CHECK(below.energy < 1e-18 * stiffness);
    CHECK(below.slope < 1e-8 * stiffness * h);
}

TEST_CASE("The contact potential is twice continuously differentiable at half the thickness") {
    const ContactPotential above = contact_potential(0.5 * h * (1.0 + 1e-12), h, stiffness);
    const ContactPotential below = contact_potential(0.5 * h * (1.0 - 1e-12), h, stiffness);
    CHECK(below.energy == Approx(above.energy).epsilon(1e-11));
    CHECK(below.slope == Approx(above.slope).epsilon(1e-11));
    CHECK(below.curvature == Approx(above.curvature).epsilon(1e-11));
}

TEST_CASE("Slope and curvature are the derivatives of the contact potential") {
    for (double d = 0.01 * h; d < h; d += 0.0137 * h) {
        const double step = 1e-5 * d;
        const ContactPotential p = contact_potential(d, h, stiffness);
        const ContactPotential ahead = contact_potential(d + step, h, stiffness),
                               behind = contact_potential(d - step, h, stiffness);
        CAPTURE(d / h);
        CHECK((behind.energy - ahead.energy) / (2.0 * step) == Approx(p.slope).epsilon(1e-7).margin(1e-9));
        CHECK((behind.slope - ahead.slope) / (2.0 * step) == Approx(p.curvature).epsilon(1e-7));
        CHECK(p.slope > 0.0);
        CHECK(p.curvature > 0.0);
        CHECK(stiffness_of_curvature(p.curvature, d, h) == Approx(stiffness).epsilon(1e-14));
    }
}

TEST_CASE("The contact potential grows without bound towards the surface") {
    double energy = contact_potential(0.4 * h, h, stiffness).energy;
    for (double d = 0.4e-3 * h; d > 1e-150; d *= 1e-3) {
        const ContactPotential p = contact_potential(d, h, stiffness);
        CHECK(p.energy - energy == Approx(0.25 * stiffness * h * h * std::log(1000.0)).epsilon(1e-9));
        CHECK(p.slope == Approx(0.25 * stiffness * h * h / d));
        energy = p.energy;
    }
}

}  // namespace percale::test::potential_test
