#include "engine/contact/contact_stiffness.h"

#include <cmath>

#include "tests/support/catch.h"

namespace percale::test::contact_stiffness_test {

TEST_CASE("A pile of twenty sheets rests on a floor at more than three quarters of the thickness") {
    const double weight = 1e-3;
    for (const double h : {0.0005, 0.002, 0.01}) {
        const ContactStiffness k = contact_stiffness({.weight = weight}, h);
        CHECK(contact_potential(0.75 * h, h, k).slope > 20.0 * weight);
        CHECK(contact_potential(h * (1.0 - std::sqrt(20.0 / 1500.0)), h, k).slope == Approx(20.0 * weight));
    }
}

TEST_CASE("Cloth stretched over a body rests at half the thickness or more if its edges are as short as the header says") {
    const double h = 0.002, e = 0.3;
    for (const double radius : {0.02, 0.05, 0.3}) {
        for (const double modulus : {30.0, 3000.0}) {
            const double length = radius / (4.0 * e), load = e * modulus / radius * length * length;
            CHECK(contact_potential(0.499 * h, h, contact_stiffness({0.0, modulus, length}, h)).slope > load);
            CHECK(contact_potential(0.501 * h, h, contact_stiffness({0.0, modulus, length}, h)).slope < load);
        }
    }
}

TEST_CASE("Cloth stretched over a square edge comes no closer than the header says") {
    for (const double length : {0.001, 0.01, 0.1}) {
        for (const double e : {0.1, 0.3, 1.0}) {
            const double h = 0.002, load = std::sqrt(2.0) * e * 500.0 * length;
            CHECK(contact_potential(h / (1.5 + 2.9 * e), h, contact_stiffness({0.0, 500.0, length}, h)).slope > load);
        }
    }
}

TEST_CASE("Two sides in series give way as both springs do") {
    const ContactStiffness first{.quadratic = 3.0, .quartic = 10.0}, second{.quadratic = 6.0, .quartic = 40.0};
    CHECK(in_series(first, second).quadratic == Approx(2.0));
    CHECK(in_series(first, second).quartic == Approx(8.0));
    CHECK(in_series({}, {}).quadratic == 0.0);
}

}  // namespace percale::test::contact_stiffness_test
