#include "engine/contact/potential.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"

namespace percale::test::potential_test {
namespace {

constexpr double h = 0.005, stiffness = 200.0;

/// A weak contact, a strong one and their sum; and one that is subtracted.
constexpr ContactStiffness all_stiffness[] = {
    {stiffness, 0.0}, {0.0, stiffness}, {stiffness, 3.0 * stiffness}, {-stiffness, -stiffness}};

}  // namespace

TEST_CASE("The contact potential starts at the thickness with value, slope and curvature zero") {
    for (const ContactStiffness& k : all_stiffness) {
        for (const double d : {h, 1.5 * h, 1.0}) {
            const ContactPotential p = contact_potential(d, h, k);
            CHECK((p.energy == 0.0 && p.slope == 0.0 && p.curvature == 0.0));
        }
        const ContactPotential below = contact_potential(h * (1.0 - 1e-9), h, k);
        CHECK(std::abs(below.energy) < 1e-18 * stiffness);
        CHECK(std::abs(below.slope) < 1e-17 * stiffness * h);
        CHECK(std::abs(below.curvature) < 1e-8 * stiffness);
    }
}

TEST_CASE("The contact potential is twice continuously differentiable at half of the thickness") {
    for (const ContactStiffness& k : all_stiffness) {
        const ContactPotential above = contact_potential(0.5 * h * (1.0 + 1e-12), h, k);
        const ContactPotential below = contact_potential(0.5 * h * (1.0 - 1e-12), h, k);
        CHECK(below.energy == Approx(above.energy).epsilon(1e-10));
        CHECK(below.slope == Approx(above.slope).epsilon(1e-10));
        CHECK(below.curvature == Approx(above.curvature).epsilon(1e-10));
    }
}

TEST_CASE("Slope and curvature are the derivatives of the contact potential") {
    for (const ContactStiffness& k : all_stiffness) {
        for (double d = 0.01 * h; d < h; d += 0.0137 * h) {
            const double step = 1e-5 * d;
            const ContactPotential p = contact_potential(d, h, k), ahead = contact_potential(d + step, h, k),
                                   behind = contact_potential(d - step, h, k);
            CAPTURE(d / h);
            CHECK((behind.energy - ahead.energy) / (2.0 * step) == Approx(p.slope).epsilon(1e-6).margin(1e-9));
            CHECK((behind.slope - ahead.slope) / (2.0 * step) == Approx(p.curvature).epsilon(1e-5));
            CHECK(p.slope * (k.quadratic + k.quartic) > 0.0);
            CHECK(p.curvature * (k.quadratic + k.quartic) > 0.0);
        }
    }
}

TEST_CASE("The contact potential grows without bound towards the surface") {
    const ContactStiffness k{stiffness, 2.0 * stiffness};
    const double half = 0.5 * h, curvature = contact_potential(half, h, k).curvature;
    double energy = contact_potential(0.4e-3 * h, h, k).energy;
    for (double d = 0.4e-6 * h; d > 1e-150; d *= 1e-3) {
        const ContactPotential p = contact_potential(d, h, k);
        CHECK(p.energy - energy == Approx(curvature * half * half * std::log(1000.0)).epsilon(0.01));
        CHECK(p.slope == Approx(curvature * half * half / d).epsilon(0.01));
        energy = p.energy;
    }
}

TEST_CASE("The force is that of the powers of depth over thickness") {
    for (const double part : {0.01, 0.1, 0.4, 0.5}) {
        const double force = contact_potential((1.0 - part) * h, h, {stiffness, 700.0}).slope;
        CHECK(force == Approx(h * (stiffness * part * part + 700.0 * std::pow(part, 4))).epsilon(1e-12));
    }
}

TEST_CASE("The spring's potential has the spring's force down to half its length, and its derivatives") {
    for (double d = 0.01 * h; d < 1.3 * h; d += 0.0137 * h) {
        const double step = 1e-5 * d;
        const ContactPotential p = spring_potential(d, h, stiffness);
        const ContactPotential ahead = spring_potential(d + step, h, stiffness),
                               behind = spring_potential(d - step, h, stiffness);
        CHECK((behind.energy - ahead.energy) / (2.0 * step) == Approx(p.slope).epsilon(1e-7).margin(1e-9));
        CHECK((behind.slope - ahead.slope) / (2.0 * step) == Approx(p.curvature).epsilon(1e-7));
        CHECK(p.slope == Approx(d < 0.5 * h ? 0.25 * stiffness * h * h / d : stiffness * (h - d)));
    }
}

}  // namespace percale::test::potential_test
