#include "collision/geometry/time_of_impact.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::time_of_impact_test {
namespace {

std::array<Vec3, 4> at(const MovingFour& four, double time) {
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i) x[i] = four.from[i] + time * (four.to[i] - four.from[i]);
    return x;
}

double distance(const MovingFour& four, PairShape shape, double time) {
    const auto x = at(four, time);
    return shape == PairShape::point_triangle ? true_point_triangle(x[0], x[1], x[2], x[3])
                                              : true_edge_edge(x[0], x[1], x[2], x[3]);
}

/// Of the tetrahedron of the four, in the digits of long double.
long double signed_volume(const std::array<Vec3, 4>& x) {
    using Wide = Eigen::Matrix<long double, 3, 1>;
    const Wide a = x[0].cast<long double>(), b = x[1].cast<long double>() - a, c = x[2].cast<long double>() - a,
               d = x[3].cast<long double>() - a;
    return b.dot(c.cross(d));
}

/// The families in which the two features come together, and how.
enum class Family { generic, coplanar, parallel, on_edge, micro_gap, rushing };

Vec3 flat(const Vec3& x) { return {x.x(), x.y(), 0.0}; }

MovingFour rotated(MovingFour four, Random& random) {
    const Pose pose = random.pose(1.0);
    for (int i = 0; i < 4; ++i) {
        four.from[i] = transform(pose, four.from[i]);
        four.to[i] = transform(pose, four.to[i]);
    }
    return four;
}

/// A random pair that meets at time `hit`: a point of the first feature is at a point of the second one then.
MovingFour meeting(PairShape shape, Family family, double hit, Random& random) {
    MovingFour four;
    const bool in_plane = family == Family::coplanar;
    for (int i = 0; i < 4; ++i) {
        four.from[i] = random.point(1.0);
        four.to[i] = four.from[i] + random.point(1.0);
        if (in_plane) four.from[i] = flat(four.from[i]), four.to[i] = flat(four.to[i]);
    }
    if (family == Family::parallel) {
        // An edge parallel to the other one (or to the triangle's first), throughout the move.
        const Vec3 along = random.number(0.5, 2.0) * (four.from[3] - four.from[2]), way = four.to[2] - four.from[2];
        four.to[3] = four.from[3] + way;
        four.from[1] = four.from[0] + along;
        four.to[1] = four.to[0] + along;
    }
    const auto x = at(four, hit);
    double u = random.number(0.0, 1.0), v = random.number(0.0, 1.0 - u);
    if (family == Family::on_edge) v = random.index(2) == 0 ? 0.0 : 1.0 - u;
    if (family == Family::on_edge && random.index(3) == 0) u = v = 0.0;
    Vec3 target = x[1] + u * (x[2] - x[1]) + v * (x[3] - x[1]), source = x[0];
    if (shape == PairShape::edge_edge) {
        target = x[2] + (family == Family::on_edge ? std::round(u) : u) * (x[3] - x[2]);
        source = x[0] + random.number(0.0, 1.0) * (x[1] - x[0]);
    }
    const Vec3 shift = target - source;
    const int movers = shape == PairShape::point_triangle ? 1 : 2;
    for (int i = 0; i < movers; ++i) four.from[i] += shift, four.to[i] += shift;
    return rotated(four, random);
}

MovingFour random_move(PairShape shape, Family family, Random& random) {
    MovingFour four = meeting(shape, family == Family::micro_gap || family == Family::rushing ? Family::generic : family,
                              random.number(0.05, 1.3), random);
    const int movers = shape == PairShape::point_triangle ? 1 : 2;
    if (family == Family::micro_gap) {
        // Starts a micrometre to a nanometre before the meeting.
        const double hit = 1.0;
        MovingFour near = meeting(shape, Family::generic, hit, random);
        const double back = random.decades(1e-9, 1e-4);
        const auto x = at(near, hit), before = at(near, hit - back);
        near.from = before;
        for (int i = 0; i < 4; ++i) near.to[i] = x[i] + random.number(1.0, 50.0) * (x[i] - before[i]);
        return near;
    }
    if (family == Family::rushing) {
        const Vec3 way = random.point(100.0);
        for (int i = 0; i < movers; ++i) {
            const Vec3 own = four.to[i] - four.from[i], start = four.from[i] - 0.01 * random.index(90) * way;
            four.from[i] = start;
            four.to[i] = start + way + own;
        }
    }
    return four;
}

struct Outcome {
    int moves = 0, cut = 0, below = 0, early = 0, loose = 0;
};

/// Samples one move: no distance is below the floor before the returned time, and the clamp is not earlier than promised.
void check_move(const MovingFour& four, PairShape shape, double share, Outcome& outcome) {
    const double start = distance(four, shape, 0.0);
    if (start < 1e-12) return;
    const double floor = share * start;
    const double safe = time_of_impact_lower_bound(four, shape, floor, 1.0);
    ++outcome.moves;
    constexpr int samples = 64;
    for (int k = 0; k <= samples; ++k) {
        outcome.below += distance(four, shape, safe * k / samples) < floor - 1e-15 ? 1 : 0;
    }
    if (safe == 1.0) return;
    ++outcome.cut;
    const bool more_left = distance(four, shape, safe) - floor > 0.1 * (start - floor) + 1e-12;
    outcome.early += more_left ? 1 : 0;
    outcome.loose += more_left && start > 1e-3 && share <= 0.9 ? 1 : 0;
}

}  // namespace

TEST_CASE(
    "before the returned time no sample of thousands of moves is below the floor, and a clamp leaves a tenth of the clearance") {
    const auto [family, name] = GENERATE(table<Family, std::string>({{Family::generic, "generic"},
                                                                     {Family::coplanar, "coplanar"},
                                                                     {Family::parallel, "parallel"},
                                                                     {Family::on_edge, "on edge"},
                                                                     {Family::micro_gap, "micro gap"},
                                                                     {Family::rushing, "rushing"}}));
    const PairShape shape = GENERATE(PairShape::point_triangle, PairShape::edge_edge);
    INFO(name << (shape == PairShape::edge_edge ? ", edge-edge" : ", point-triangle"));
    Random random(40 + static_cast<int>(family));
    Outcome outcome;
    for (int i = 0; i < 1500; ++i) {
        const double share = i % 3 == 0 ? 0.999 : random.number(0.1, 0.9);
        check_move(random_move(shape, family, random), shape, share, outcome);
    }
    CHECK(outcome.moves > 1000);
    CHECK(outcome.cut > 300);
    CHECK(outcome.below == 0);
    CHECK(outcome.loose == 0);
    // A clearance that is tiny against the displacement takes more advances than are allowed: the clamp is then earlier, never
    // later.
    CHECK(outcome.early < outcome.cut / 20 + 5);
}

TEST_CASE("a move made to hit is clamped before the hit, in every family") {
    const Family family = GENERATE(Family::generic, Family::coplanar, Family::parallel, Family::on_edge);
    const PairShape shape = GENERATE(PairShape::point_triangle, PairShape::edge_edge);
    Random random(60 + static_cast<int>(family));
    int missed = 0, late = 0;
    for (int i = 0; i < 4000; ++i) {
        const double hit = random.number(0.05, 1.0);
        const MovingFour four = meeting(shape, family, hit, random);
        const double start = distance(four, shape, 0.0);
        if (start < 1e-9) continue;
        const double safe = time_of_impact_lower_bound(four, shape, 0.2 * start, 1.0);
        missed += safe == 1.0 ? 1 : 0;
        late += safe >= hit ? 1 : 0;
    }
    CHECK(missed == 0);
    CHECK(late == 0);
}

TEST_CASE(
    "the clamp comes shortly before the distance falls below the floor: most of the move until then is allowed, never nothing") {
    const PairShape shape = GENERATE(PairShape::point_triangle, PairShape::edge_edge);
    Random random(71);
    double ratio = 0.0, least = 1.0;
    int count = 0;
    for (int i = 0; i < 400; ++i) {
        const MovingFour four = meeting(shape, Family::generic, random.number(0.2, 1.0), random);
        const double start = distance(four, shape, 0.0), floor = 0.2 * start;
        if (start < 1e-2) continue;
        double dip = 0.0;
        while (distance(four, shape, dip) > floor) dip += 1.0 / 1024;
        const double share = time_of_impact_lower_bound(four, shape, floor, 1.0) / dip;
        ratio += share;
        least = std::min(least, share);
        ++count;
    }
    CHECK(count > 300);
    CHECK(ratio / count > 0.85);
    CHECK(least > 0.15);
}

TEST_CASE("a point falling straight onto a triangle falls to a tenth of its clearance") {
    const double height = GENERATE(1e-8, 1e-3, 1.0, 100.0);
    MovingFour four{.from = {Vec3(0.2, 0.2, height), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, .to = {}};
    four.to = four.from;
    four.to[0].z() = -height;
    const double floor = 0.2 * height, hit = 0.4;
    const double safe = time_of_impact_lower_bound(four, PairShape::point_triangle, floor, 1.0);
    CHECK(safe < hit);
    CHECK(safe >= 0.9 * hit * (1.0 - 1e-6));
}

TEST_CASE("features that never come near keep their whole time, whatever their common motion") {
    Random random(80);
    for (int i = 0; i < 500; ++i) {
        const PairShape shape = i % 2 == 0 ? PairShape::point_triangle : PairShape::edge_edge;
        MovingFour four;
        const Vec3 common = random.point(1000.0);
        for (int k = 0; k < 4; ++k) four.from[k] = random.point(1.0), four.to[k] = four.from[k] + common;
        const double start = distance(four, shape, 0.0), latest = random.number(0.01, 1.0);
        if (start < 1e-6) continue;
        CHECK(time_of_impact_lower_bound(four, shape, 0.5 * start, latest) == latest);
        four.to = four.from;
        CHECK(time_of_impact_lower_bound(four, shape, 0.999 * start, latest) == latest);
        // Moving apart along the line between the closest features' centres.
        const Vec3 away = (four.from[0] - (four.from[1] + four.from[2] + four.from[3]) / 3.0).normalized();
        if (shape == PairShape::point_triangle) {
            four.to[0] += 0.4 * start * away;
            CHECK(time_of_impact_lower_bound(four, shape, 0.1 * start, latest) == latest);
        }
    }
}

TEST_CASE("features pressed together call after call stop before rounding decides on which side they are") {
    const PairShape shape = GENERATE(PairShape::point_triangle, PairShape::edge_edge);
    Random random(90);
    for (int i = 0; i < 200; ++i) {
        // The first feature goes straight through the second.
        MovingFour four{.from = at(meeting(shape, Family::generic, 0.5, random), 0.5), .to = {}};
        const Vec3 push = random.point(1.0);
        const int movers = shape == PairShape::point_triangle ? 1 : 2;
        for (int k = 0; k < movers; ++k) four.from[k] -= 0.5 * push;
        const bool side = signed_volume(four.from) > 0.0L;
        double safe = 1.0, apart = distance(four, shape, 0.0);
        for (int call = 0; call < 60; ++call) {
            four.to = four.from;
            for (int k = 0; k < movers; ++k) four.to[k] += push;
            safe = time_of_impact_lower_bound(four, shape, clamped_distance(four, apart, 1e-30), 1.0);
            four.from = at(four, safe);
            apart = distance(four, shape, 0.0);
        }
        CHECK(safe < 1e-12);
        CHECK(apart < 1e-12);
        CHECK((signed_volume(four.from) > 0.0L) == side);
    }
}

TEST_CASE("a start at or below the floor allows no time at all, an earlier limit is kept") {
    const MovingFour four{.from = {Vec3(0.2, 0.2, 1.0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
                          .to = {Vec3(0.2, 0.2, -1.0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}};
    CHECK(time_of_impact_lower_bound(four, PairShape::point_triangle, 1.0, 1.0) == 0.0);
    CHECK(time_of_impact_lower_bound(four, PairShape::point_triangle, 2.0, 1.0) == 0.0);
    CHECK(time_of_impact_lower_bound(four, PairShape::point_triangle, 0.2, 0.25) == 0.25);
    CHECK(time_of_impact_lower_bound(four, PairShape::point_triangle, 0.2, 0.0) == 0.0);
    CHECK(time_of_impact_lower_bound(four, PairShape::point_triangle, 0.2, 0.39) <= 0.39);
}

}  // namespace percale::test::time_of_impact_test
