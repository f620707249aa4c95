#include "data/generators/mannequin_parts.h"

#include <random>

#include "tests/support/catch.h"

namespace percale::scenes::test::mannequin_parts_test {
namespace {

/// Distance to the hull of two spheres: the minimum over the spheres between, which grow evenly from the first to the second.
double swept_distance(const BodyPart& part, const Vec3& point) {
    double least = 1e9;
    for (int k = 0; k <= 20000; ++k) {
        const double s = k / 20000.0, radius = part.radius_from + s * (part.radius_to - part.radius_from);
        least = std::min(least, (point - part.from - s * part.length * part.axis).norm() - radius);
    }
    return least;
}

std::vector<BodyPart> all_parts() {
    std::vector<BodyPart> parts;
    for (const auto list : {head_parts(), trunk_parts(), arm_parts(), leg_parts()})
        for (const BodyPart& part : list) parts.push_back(part);
    return parts;
}

}  // namespace

TEST_CASE("parts have unit axes, spheres none of which holds the other, and end where they say") {
    for (const BodyPart& part : all_parts()) {
        CHECK(part.axis.norm() == Approx(1.0).margin(1e-14));
        CHECK(std::abs(part.radius_from - part.radius_to) < part.length);
        CHECK(part.sine * part.sine + part.cosine * part.cosine == Approx(1.0).margin(1e-14));
        CHECK((part.to() - part.from).norm() == Approx(part.length).margin(1e-14));
        CHECK(part.blend >= 0.0);
    }
}

TEST_CASE("the distance to a part is that to the spheres that sweep it") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> offset(-0.3, 0.3);
    for (const BodyPart& part : all_parts()) {
        const Vec3 x = part.from + Vec3(offset(random), offset(random), offset(random));
        CHECK(parts_distance(std::span(&part, 1), x) == Approx(swept_distance(part, x)).margin(1e-7));
    }
}

TEST_CASE(
    "the smooth minimum is the minimum where its arguments differ by the blend, and below it by a sixth where they are equal") {
    CHECK(smooth_minimum(1.0, 2.0, 0.5) == 1.0);
    CHECK(smooth_minimum(1.0, 1.5, 0.5) == 1.0);
    CHECK(smooth_minimum(1.0, 1.0, 0.6) == Approx(0.9).margin(1e-15));
    CHECK(smooth_minimum(1.0, 1.2, 0.6) == smooth_minimum(1.2, 1.0, 0.6));
    CHECK(smooth_minimum(3.0, 2.0, 0.0) == 2.0);
}

TEST_CASE("joined parts are no farther than each of them, and both sides are the same") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int k = 0; k < 500; ++k) {
        const Vec3 x(1.4 * share(random) - 0.7, 1.9 * share(random), 0.6 * share(random) - 0.3), image(-x[0], x[1], x[2]);
        for (const BodyPart& part : arm_parts())
            REQUIRE(parts_distance(arm_parts(), x) <= parts_distance(std::span(&part, 1), x) + 1e-15);
        REQUIRE(both_sides_distance(leg_parts(), x, 0.02) == both_sides_distance(leg_parts(), image, 0.02));
        REQUIRE(core_distance(x) == core_distance(image));
    }
    CHECK(core_distance({0.0, 1.2, 0.0}) < 0.0);
    CHECK(core_distance({0.45, 1.1, 0.0}) > 0.2);  // the arm is no part of it
}

}  // namespace percale::scenes::test::mannequin_parts_test
