#include "certificate/exact_orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "tests/support/catch.h"

namespace percale::test::exact_orientation_test {
using namespace percale::certificate;

namespace {

__extension__ using Wide = __int128;
using Point = std::array<std::int64_t, 3>;

int sign_of(Wide value) { return (value > 0) - (value < 0); }

Wide minor_of(const Point& a, const Point& b, const Point& c, int i, int j) {
    return Wide(b[i] - a[i]) * (c[j] - a[j]) - Wide(b[j] - a[j]) * (c[i] - a[i]);
}

int integer_orient2d(const Point& a, const Point& b, const Point& c, int axis) {
    return sign_of(minor_of(a, b, c, (axis + 1) % 3, (axis + 2) % 3));
}

/// Expanded along d: exact while the sum stays below 2^127.
int integer_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
    Wide volume = 0;
    for (int axis = 0; axis < 3; ++axis) volume += minor_of(a, b, c, (axis + 1) % 3, (axis + 2) % 3) * (d[axis] - a[axis]);
    return sign_of(volume);
}

Vec3 scaled(const Point& p, int exponent) {
    return {std::ldexp(double(p[0]), exponent), std::ldexp(double(p[1]), exponent), std::ldexp(double(p[2]), exponent)};
}

class Points {
public:
    std::int64_t number(std::int64_t range) { return std::uniform_int_distribution<std::int64_t>(-range, range)(random_); }
    Point point(std::int64_t range) { return {number(range), number(range), number(range)}; }

    /// On the plane of a, b, c but for the last bits.
    Point near_plane(const Point& a, const Point& b, const Point& c, std::int64_t nudge) {
        Point d = a;
        const std::int64_t s = number(8), t = number(8);
        for (int i = 0; i < 3; ++i) d[i] += s * (b[i] - a[i]) + t * (c[i] - a[i]) + number(nudge);
        return d;
    }

private:
    std::mt19937_64 random_{7};
};

/// A number of up to 60 bits that a double holds exactly.
std::int64_t long_number(Points& points) { return points.number((std::int64_t(1) << 52) - 1) * 128; }

bool is_odd(const std::array<int, 4>& order) {
    int inversions = 0;
    for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
    }
    return inversions % 2 != 0;
}

}  // namespace

TEST_CASE("orient3d gives the sign of the volume for every four points of a small grid") {
    for (int code = 0; code < 3 * 3 * 3 * 3 * 3 * 3 * 3 * 3 * 3; ++code) {
        Point p[3];
        for (int k = 0, rest = code; k < 9; ++k, rest /= 3) p[k / 3][k % 3] = rest % 3;
        const Point d = {1, 0, 2};
        const int expected = integer_orient3d(p[0], p[1], p[2], d);
        if (orient3d(scaled(p[0], 0), scaled(p[1], 0), scaled(p[2], 0), scaled(d, 0)) != expected) FAIL("grid code " << code);
    }
    SUCCEED();
}

TEST_CASE("orient3d agrees with integers on points that are coplanar but for the last bits, at every scale") {
    Points points;
    const int exponent = GENERATE(0, -40, 300, -700, 950);
    const std::int64_t nudge = GENERATE(0, 1, 3);
    int zeros = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const Point a = points.point(1 << 30), b = points.point(1 << 30), c = points.point(1 << 30);
        const Point d = points.near_plane(a, b, c, nudge);
        const int expected = integer_orient3d(a, b, c, d);
        zeros += expected == 0;
        if (orient3d(scaled(a, exponent), scaled(b, exponent), scaled(c, exponent), scaled(d, exponent)) != expected) {
            FAIL("trial " << trial << " exponent " << exponent << " nudge " << nudge);
        }
    }
    CHECK((zeros == 4000) == (nudge == 0));
}

TEST_CASE("orient3d is exact where not even the differences of coordinates fit a double") {
    Points points;
    int zeros = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        // c and d a last bit apart: from a or b, whose distance to them has more than 53 bits, the volume is lost in rounding.
        const std::int64_t x = long_number(points), last_bit = 128 * points.number(1), y = points.number(1 << 20);
        const std::array<Point, 4> p = {Point{points.number(9), points.number(1 << 20), points.number(1 << 20)},
                                        Point{points.number(9), points.number(1 << 20), points.number(1 << 20)}, Point{x, y, 5},
                                        Point{x + last_bit, y, 5}};
        const int expected = integer_orient3d(p[0], p[1], p[2], p[3]);
        zeros += expected == 0;
        const std::array<Vec3, 4> v = {scaled(p[0], -9), scaled(p[1], -9), scaled(p[2], -9), scaled(p[3], -9)};
        if (orient3d(v[0], v[1], v[2], v[3]) != expected) FAIL("trial " << trial);
        if (orient3d(v[1], v[0], v[2], v[3]) != -expected) FAIL("swapped trial " << trial);
        if (orient3d(v[2], v[0], v[1], v[3]) != expected) FAIL("rotated trial " << trial);
    }
    CHECK(zeros > 5000);
    CHECK(zeros < 10000);
}

TEST_CASE("orient3d sees the last bits that rounding takes from a difference") {
    Points points;
    int nonzero = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        // With c - a = 2 (d - a) in y and z, the volume is a.x times an area: less than half a last bit of d.x - a.x.
        const std::int64_t x = long_number(points), u = points.number(1 << 20), w = points.number(1 << 20);
        const Point a = {points.number(9), points.number(1 << 10), points.number(1 << 10)};
        const Point b = points.point(1 << 20), c = {2 * x, a[1] + 2 * u, a[2] + 2 * w}, d = {x, a[1] + u, a[2] + w};
        const int expected = integer_orient3d(a, b, c, d);
        nonzero += expected != 0;
        const Vec3 p = scaled(a, -9), q = scaled(b, -9), r = scaled(c, -9), s = scaled(d, -9);
        if (orient3d(p, q, r, s) != expected) FAIL("trial " << trial);
        if (orient3d(s, r, q, p) != expected) FAIL("reversed trial " << trial);
    }
    CHECK(nonzero > 15000);
}

TEST_CASE("the order of the points decides the sign of orient3d as it does that of a permutation") {
    Points points;
    for (int trial = 0; trial < 300; ++trial) {
        const Point a = points.point(1 << 20), b = points.point(1 << 20), c = points.point(1 << 20);
        const Point d = points.near_plane(a, b, c, 1);
        const std::array<Vec3, 4> x = {scaled(a, -20), scaled(b, -20), scaled(c, -20), scaled(d, -20)};
        const int expected = orient3d(x[0], x[1], x[2], x[3]);
        std::array<int, 4> order = {0, 1, 2, 3};
        do {
            const int sign = orient3d(x[order[0]], x[order[1]], x[order[2]], x[order[3]]);
            if (sign != (is_odd(order) ? -expected : expected)) FAIL("trial " << trial);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    SUCCEED();
}

TEST_CASE("orient2d agrees with integers along each axis, for nearly collinear points of 60 bits too") {
    Points points;
    const int axis = GENERATE(0, 1, 2);
    const int exponent = GENERATE(0, -900, 900);
    int zeros = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        Point a = points.point(1 << 24), b = points.point(1 << 24), c = a;
        const std::int64_t s = points.number(1 << 20), nudge = trial % 2;
        for (int i = 0; i < 3; ++i) c[i] += s * (b[i] - a[i]) + points.number(nudge);
        if (trial % 3 == 0) a[(axis + 1) % 3] = long_number(points);
        const int expected = integer_orient2d(a, b, c, axis);
        zeros += expected == 0;
        if (orient2d(scaled(a, exponent), scaled(b, exponent), scaled(c, exponent), axis) != expected) FAIL("trial " << trial);
        if (orient2d(scaled(b, exponent), scaled(a, exponent), scaled(c, exponent), axis) != -expected) FAIL("swap " << trial);
    }
    CHECK(zeros > 500);
    CHECK(zeros < 3000);
}

TEST_CASE("magnitudes far apart are not lost: a coordinate of 1e-180 decides beside one of 1") {
    const Vec3 a{0, 0, 0}, b{1, 0.1, 0}, c{0.3, 1, 0};
    CHECK(orient3d(a, b, c, {0.2, 0.7, 1e-180}) == 1);
    CHECK(orient3d(a, b, c, {0.2, 0.7, -1e-180}) == -1);
    CHECK(orient3d(a, b, c, {0.2, 0.7, 0.0}) == 0);
    CHECK(orient2d({0, 0, 0}, {0, 1, 1e-180}, {0, 2, 1e-180}, 0) == -1);
}

TEST_CASE("all coordinates may be as small as 1e-310 or as large as 1e300") {
    for (const double size : {1e-310, 1e-200, 1e200, 1e300}) {
        const Vec3 a{0, 0, 0}, b{size, 0, 0}, c{0, size, 0};
        CHECK(orient3d(a, b, c, {size, size, size}) == 1);
        CHECK(orient3d(a, c, b, {size, size, size}) == -1);
        CHECK(orient3d(a, b, c, {size, size, 0}) == 0);
        CHECK(orient2d(a, b, c, 2) == 1);
        CHECK(orient2d(a, b, {size / 2, 0, 7}, 2) == 0);
    }
}

TEST_CASE("collinear points have no projection axis and others have one that keeps their area") {
    Points points;
    for (int trial = 0; trial < 2000; ++trial) {
        const Point a = points.point(100), b = points.point(100);
        Point c = a;
        const std::int64_t s = points.number(20);
        for (int i = 0; i < 3; ++i) c[i] += s * (b[i] - a[i]);
        if (projection_axis(scaled(a, -7), scaled(b, -7), scaled(c, -7)) != -1) FAIL("collinear trial " << trial);
        c[trial % 3] += 1;
        const bool area = integer_orient2d(a, b, c, 0) || integer_orient2d(a, b, c, 1) || integer_orient2d(a, b, c, 2);
        const int axis = projection_axis(scaled(a, -7), scaled(b, -7), scaled(c, -7));
        if ((axis >= 0) != area) FAIL("trial " << trial);
        if (axis >= 0 && integer_orient2d(a, b, c, axis) == 0) FAIL("axis of trial " << trial);
    }
    SUCCEED();
}

}  // namespace percale::test::exact_orientation_test
