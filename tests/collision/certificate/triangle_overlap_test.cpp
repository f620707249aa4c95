#include "certificate/triangle_overlap.h"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/catch.h"

namespace percale::test::triangle_overlap_test {
using namespace percale::certificate;

namespace {

// The same question answered in integers: collect the extreme points of the common set as rationals, then look at its dimension.

__extension__ using Int = __int128;
struct Vec {
    Int x, y, z;
};
using IntTriangle = std::array<Vec, 3>;

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Int s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
bool operator==(Vec a, Vec b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
Int dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
bool is_zero(Vec a) { return a == Vec{0, 0, 0}; }
Vec normal(const IntTriangle& t) { return cross(t[1] - t[0], t[2] - t[0]); }

/// The point at / w, w > 0.
struct Rational {
    Vec at;
    Int w;
};

bool on_segment(const Rational& p, Vec a, Vec b) {
    const Vec from_a = p.at - p.w * a;
    const Int along = dot(from_a, b - a);
    return is_zero(cross(from_a, b - a)) && along >= 0 && along <= p.w * dot(b - a, b - a) && (!(a == b) || is_zero(from_a));
}

bool in_closed(const Rational& p, const IntTriangle& t) {
    const Vec n = normal(t);
    if (is_zero(n)) return on_segment(p, t[0], t[1]) || on_segment(p, t[1], t[2]) || on_segment(p, t[2], t[0]);
    if (dot(n, p.at - p.w * t[0]) != 0) return false;
    for (int i = 0; i < 3; ++i) {
        if (dot(n, cross(t[(i + 1) % 3] - t[i], p.at - p.w * t[i])) < 0) return false;
    }
    return true;
}

void add_piercing(Vec p, Vec q, const IntTriangle& t, std::vector<Rational>& points) {
    const Vec n = normal(t);
    const Int dp = dot(n, p - t[0]), dq = dot(n, q - t[0]);
    if (dp * dq >= 0) return;
    const Int w = dq - dp;
    const Rational pierced = w > 0 ? Rational{dq * p - dp * q, w} : Rational{dp * q - dq * p, -w};
    if (in_closed(pierced, t)) points.push_back(pierced);
}

void add_edge_crossing(Vec p, Vec q, Vec r, Vec s, std::vector<Rational>& points) {
    const Vec u = q - p, v = s - r, n = cross(u, v);
    const Int w = dot(n, n);
    if (w == 0 || dot(r - p, n) != 0) return;
    const Int along_u = dot(cross(r - p, v), n), along_v = dot(cross(r - p, u), n);
    if (along_u >= 0 && along_u <= w && along_v >= 0 && along_v <= w) points.push_back({w * p + along_u * u, w});
}

std::vector<Rational> extreme_points(const IntTriangle& a, const IntTriangle& b) {
    std::vector<Rational> points;
    for (int i = 0; i < 3; ++i) {
        if (in_closed({a[i], 1}, b)) points.push_back({a[i], 1});
        if (in_closed({b[i], 1}, a)) points.push_back({b[i], 1});
        add_piercing(a[i], a[(i + 1) % 3], b, points);
        add_piercing(b[i], b[(i + 1) % 3], a, points);
        for (int j = 0; j < 3; ++j) add_edge_crossing(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], points);
    }
    return points;
}

Vec difference(const Rational& a, const Rational& b) { return b.w * a.at - a.w * b.at; }

/// -1 for nothing, 0 for a point, 1 for a segment, 2 for an area.
int dimension(const std::vector<Rational>& points) {
    if (points.empty()) return -1;
    Vec along{0, 0, 0};
    int result = 0;
    for (const Rational& p : points) {
        const Vec away = difference(p, points[0]);
        if (is_zero(away)) continue;
        if (result == 0) along = away, result = 1;
        if (!is_zero(cross(away, along))) result = 2;
    }
    return result;
}

bool straddles(const IntTriangle& a, const IntTriangle& b) {
    const Vec n = normal(b);
    bool above = false, below = false;
    for (const Vec p : a) above |= dot(n, p - b[0]) > 0, below |= dot(n, p - b[0]) < 0;
    return above && below;
}

Overlap brute_force(const IntTriangle& a, const IntTriangle& b) {
    const int size = dimension(extreme_points(a, b));
    if (size < 0) return Overlap::disjoint;
    if (size == 2) return Overlap::crossing;
    return size == 1 && straddles(a, b) && straddles(b, a) ? Overlap::crossing : Overlap::touching;
}

Vec3 real(Vec v, int exponent = 0) {
    return {std::ldexp(double(v.x), exponent), std::ldexp(double(v.y), exponent), std::ldexp(double(v.z), exponent)};
}

Corners real(const IntTriangle& t, int exponent = 0) {
    return {real(t[0], exponent), real(t[1], exponent), real(t[2], exponent)};
}

Corners turned(const Corners& t, int by) { return {t[by % 3], t[(by + 1) % 3], t[(by + 2) % 3]}; }
Corners reversed(const Corners& t) { return {t[0], t[2], t[1]}; }

struct Counts {
    int disjoint = 0, touching = 0, crossing = 0;
    void add(Overlap o) { ++(o == Overlap::disjoint ? disjoint : o == Overlap::touching ? touching : crossing); }
};

class RandomTriangles {
public:
    IntTriangle next(int size) {
        std::uniform_int_distribution<int> number(0, size);
        IntTriangle t;
        for (Vec& v : t) v = {number(random_), number(random_), number(random_)};
        return t;
    }

private:
    std::mt19937 random_{11};
};

const Corners floor_triangle = {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};

}  // namespace

TEST_CASE("every pair of triangles on a 2 x 2 x 3 grid, degenerate ones included, is classified as in rational arithmetic") {
    std::vector<Vec> grid;
    for (Int i = 0; i < 12; ++i) grid.push_back({i % 2, i / 2 % 2, i / 4});
    std::vector<IntTriangle> triangles;
    for (int i = 0; i < 12; ++i) {
        for (int j = i; j < 12; ++j) {
            for (int k = j; k < 12; ++k) triangles.push_back({grid[i], grid[j], grid[k]});
        }
    }
    Counts counts;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::size_t j = i; j < triangles.size(); ++j) {
            const Overlap found = classify(real(triangles[i]), real(triangles[j]));
            counts.add(found);
            if (found != brute_force(triangles[i], triangles[j])) FAIL("pair " << i << ", " << j << " differs");
        }
    }
    CHECK(counts.disjoint > 1000);
    CHECK(counts.touching > 1000);
    CHECK(counts.crossing > 1000);
}

TEST_CASE(
    "random triangles on small grids are classified as in rational arithmetic, whatever the order of arguments and corners") {
    const int size = GENERATE(2, 3, 4, 30);
    RandomTriangles triangles;
    Counts counts;
    for (int trial = 0; trial < 8000; ++trial) {
        const IntTriangle a = triangles.next(size), b = triangles.next(size);
        const Overlap expected = brute_force(a, b);
        counts.add(expected);
        const Corners x = real(a), y = real(b);
        const bool same = classify(x, y) == expected && classify(y, x) == expected &&
                          classify(turned(x, trial), turned(y, trial / 3)) == expected &&
                          classify(reversed(x), turned(y, 1)) == expected && classify(x, reversed(y)) == expected;
        if (!same) FAIL("trial " << trial << " of size " << size);
    }
    CHECK(counts.disjoint > 500);
    CHECK(counts.crossing > 500);
    CHECK(counts.touching > (size < 30 ? 500 : 0));
}

TEST_CASE("the class does not change under scaling by powers of two and a shift that keeps the coordinates exact") {
    RandomTriangles triangles;
    const int exponent = GENERATE(-300, -20, 200);
    for (int trial = 0; trial < 5000; ++trial) {
        IntTriangle a = triangles.next(4), b = triangles.next(4);
        const Overlap expected = classify(real(a), real(b));
        const Vec shift = {1234567, -7654321, 33333333};
        for (int i = 0; i < 3; ++i) a[i] = a[i] + shift, b[i] = b[i] + shift;
        if (classify(real(a, exponent), real(b, exponent)) != expected) FAIL("trial " << trial);
    }
    SUCCEED();
}

TEST_CASE("a needle through a face crosses it, one that ends on it touches, one that ends a last bit above does not") {
    const auto needle = [](double tip) { return Corners{Vec3{1, 1, tip}, Vec3{1, 1, 2}, Vec3{1.5, 1, 2}}; };
    CHECK(classify(needle(-1e-300), floor_triangle) == Overlap::crossing);
    CHECK(classify(needle(0.0), floor_triangle) == Overlap::touching);
    CHECK(classify(needle(1e-300), floor_triangle) == Overlap::disjoint);
}

TEST_CASE("a wall that stands on a floor touches it, one sunk into it crosses it") {
    const auto wall = [](double foot) { return Corners{Vec3{1, 1, foot}, Vec3{2, 1, foot}, Vec3{1, 1, 3}}; };
    CHECK(classify(wall(0.0), floor_triangle) == Overlap::touching);
    CHECK(classify(wall(-0.5), floor_triangle) == Overlap::crossing);
    CHECK(classify(wall(0.5), floor_triangle) == Overlap::disjoint);
}

TEST_CASE(
    "an edge that passes exactly through another edge touches, and crosses the triangle behind that edge once it moves in") {
    const auto blade = [](double y) { return Corners{Vec3{1, y, -1}, Vec3{1, y, 1}, Vec3{1, y - 3, 0.25}}; };
    CHECK(classify(blade(0.0), floor_triangle) == Overlap::touching);
    CHECK(classify(blade(1e-200), floor_triangle) == Overlap::crossing);
    CHECK(classify(blade(-1e-200), floor_triangle) == Overlap::disjoint);
}

TEST_CASE("coplanar triangles cross where they share an area and touch along a common edge") {
    const Corners neighbour = {Vec3{4, 0, 0}, Vec3{4, 4, 0}, Vec3{0, 4, 0}};
    CHECK(classify(neighbour, floor_triangle) == Overlap::touching);
    CHECK(classify(floor_triangle, floor_triangle) == Overlap::crossing);
    const Corners inner = {Vec3{1, 1, 0}, Vec3{1.5, 1, 0}, Vec3{1, 1.5, 0}};
    CHECK(classify(inner, floor_triangle) == Overlap::crossing);
    CHECK(classify(floor_triangle, inner) == Overlap::crossing);
}

TEST_CASE("triangles without area never cross but touch where they share a point") {
    const Corners needle = {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{1, 1, 0.5}},
                  point = {Vec3{1, 1, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 0}};
    CHECK(classify(needle, floor_triangle) == Overlap::touching);
    CHECK(classify(floor_triangle, needle) == Overlap::touching);
    CHECK(classify(point, floor_triangle) == Overlap::touching);
    CHECK(classify(point, needle) == Overlap::touching);
    CHECK(classify(point, point) == Overlap::touching);
    const Corners away = {Vec3{5, 5, -1}, Vec3{5, 5, 1}, Vec3{5, 5, 0}};
    CHECK(classify(away, floor_triangle) == Overlap::disjoint);
    CHECK(classify(away, needle) == Overlap::disjoint);
}

TEST_CASE("a point lies on a triangle exactly where it does in rational arithmetic") {
    RandomTriangles triangles;
    int on = 0;
    for (int trial = 0; trial < 30000; ++trial) {
        const IntTriangle t = triangles.next(3);
        const Vec p = triangles.next(3)[0];
        const bool expected = in_closed({p, 1}, t);
        on += expected;
        if (lies_on(real(p, -3), real(t, -3)) != expected) FAIL("trial " << trial);
    }
    CHECK(on > 500);
}

}  // namespace percale::test::triangle_overlap_test
