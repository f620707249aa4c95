#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include "collision/certificate/triangle_gap.h"
#include "collision/certificate/triangle_overlap.h"
#include "collision/geometry/time_of_impact.h"
#include "collision/geometry/triangle_distance.h"
#include "tests/support/catch.h"
#include "tests/support/laws.h"
#include "tests/support/random.h"

// FCL's narrow phase beside ours: its results for pairs of triangles and for moves, where they are reliable.

namespace percale::test::fcl_oracles_test {
namespace {

using certificate::Corners;
using FclDistance = fcl::detail::TriangleDistance<double>;
using FclImpact = fcl::detail::Intersect<double>;

constexpr int count = 100'000;

/// Kinds of pairs, of about unit size.
struct Kind {
    const char* name;
    Corners (*make)(Random& random, const Corners& other);
};

Corners any(Random& random) { return {random.point(1.0), random.point(1.0), random.point(1.0)}; }

/// Lies on the line ab, or nearly.
Corners sliver(Random& random, double height) {
    const Vec3 a = random.point(1.0), b = random.point(1.0);
    return {a, b, a + random.number(0.0, 1.0) * (b - a) + random.point(height)};
}

Corners beside(Random& random, const Corners& other, double gap) {
    const Vec3 n = (other[1] - other[0]).cross(other[2] - other[0]).normalized();
    Corners result;
    for (Vec3& corner : result) {
        const double s = random.number(-0.5, 1.5), t = random.number(-0.5, 1.5);
        corner = other[0] + s * (other[1] - other[0]) + t * (other[2] - other[0]) + gap * n;
    }
    return result;
}

const Kind kinds[] = {
    {"any two", [](Random& random, const Corners&) { return any(random); }},
    {"a metre apart",
     [](Random& random, const Corners&) {
         Corners t = any(random);
         for (Vec3& corner : t) corner += Vec3(3.0, 0.0, 0.0);
         return t;
     }},
    {"in parallel planes 1e-3 apart", [](Random& random, const Corners& other) { return beside(random, other, 1e-3); }},
    {"in parallel planes 1e-9 apart", [](Random& random, const Corners& other) { return beside(random, other, 1e-9); }},
    {"slivers of 1e-6", [](Random& random, const Corners&) { return sliver(random, 1e-6); }},
    {"without area", [](Random& random, const Corners&) { return sliver(random, 0.0); }},
};

struct Compared {
    int apart = 0;                               // pairs that do not overlap
    double ours_longer = 0.0, fcl_longer = 0.0;  // m, worst
    int not_numbers = 0;
};

Compared compare(const Kind& kind) {
    Random random(7);
    Compared result;
    for (int n = 0; n < count; ++n) {
        const Corners a = any(random), b = kind.make(random, a);
        if (certificate::classify(a, b) != certificate::Overlap::disjoint) continue;
        ++result.apart;
        Vec3 p, q;
        const double fcl = FclDistance::triDistance(a.data(), b.data(), p, q), ours = certificate::triangle_distance(a, b);
        result.ours_longer = std::max(result.ours_longer, ours - fcl);
        result.fcl_longer = std::max(result.fcl_longer, fcl - ours);
        result.not_numbers += !std::isfinite(ours) || !std::isfinite(fcl);
    }
    return result;
}

/// Four points that come near each other within the move.
MovingFour random_move(Random& random, double reach) {
    MovingFour four;
    for (int k = 0; k < 4; ++k) {
        four.from[k] = random.point(1.0);
        four.to[k] = four.from[k] + random.point(reach);
    }
    return four;
}

/// FCL's time of the first contact; 2: none.
double fcl_time(const MovingFour& four, PairShape shape) {
    double time = 2.0;
    Vec3 point;
    const auto& [p, a, b, c] = four.from;
    const auto& [p1, a1, b1, c1] = four.to;
    const bool hit = shape == PairShape::point_triangle ? FclImpact::intersect_VF(a, b, c, p, a1, b1, c1, p1, &time, &point)
                                                        : FclImpact::intersect_EE(p, a, b, c, p1, a1, b1, c1, &time, &point);
    return hit ? time : 2.0;
}

/// How far apart they are at a time, m.
double distance_at(const MovingFour& four, PairShape shape, double time) {
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k) x[k] = four.from[k] + time * (four.to[k] - four.from[k]);
    return std::sqrt(shape == PairShape::point_triangle ? closest_on_triangle(x[0], x[1], x[2], x[3]).distance_squared
                                                        : closest_on_edges(x[0], x[1], x[2], x[3]).distance_squared);
}

/// Whether they meet: the smallest distance by samples, and by thirds of the interval about the smallest of these.
bool meets(const MovingFour& four, PairShape shape) {
    constexpr int samples = 1000;
    double best = 0.0, least = distance_at(four, shape, 0.0);
    for (int n = 1; n <= samples; ++n) {
        const double time = static_cast<double>(n) / samples, distance = distance_at(four, shape, time);
        if (distance < least) std::tie(best, least) = std::pair(time, distance);
    }
    double low = std::max(0.0, best - 1.0 / samples), high = std::min(1.0, best + 1.0 / samples);
    for (int n = 0; n < 100; ++n) {
        const double third = (high - low) / 3.0;
        if (distance_at(four, shape, low + third) < distance_at(four, shape, high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return distance_at(four, shape, 0.5 * (low + high)) < 1e-12;
}

struct Moves {
    int reported = 0, right = 0, late = 0, missed_by_fcl = 0, missed = 0;
};

Moves compare_moves(PairShape shape, bool flat) {
    Random random(11);
    Moves moves;
    for (int n = 0; n < count; ++n) {
        MovingFour four = random_move(random, n % 2 == 0 ? 0.5 : 4.0);
        for (int k = 0; flat && k < 4; ++k) four.from[k].z() = four.to[k].z() = 0.0;
        if (distance_at(four, shape, 0.0) < 1e-6) continue;
        const double ours = time_of_impact_lower_bound(four, shape, 0.0, 1.0), fcl = fcl_time(four, shape);
        moves.reported += fcl <= 1.0;
        // A few of its contacts are false: the four are apart then.
        const bool right = fcl <= 1.0 && distance_at(four, shape, fcl) < 1e-6;
        moves.right += right;
        moves.late += right && ours > fcl;
        if (right || (n % 10 > 0 && ours == 1.0)) continue;  // testing all that are not clamped would take a minute
        const bool meet = meets(four, shape);
        moves.missed_by_fcl += meet && fcl > 1.0;
        moves.missed += meet && ours == 1.0;
    }
    return moves;
}

}  // namespace

TEST_CASE("Distances of triangles are FCL's, and never longer", "[law]") {
    for (const Kind& kind : kinds) {
        const Compared result = compare(kind);
        CHECK(result.apart > count / 2);
        CHECK(result.not_numbers == 0);
        const std::string name = std::string("distance of two triangles, ") + kind.name;
        check_law(name + ": longer than FCL's, m", result.ours_longer, 2e-14);
        check_law(name + ": shorter than FCL's, m", result.fcl_longer, 2e-14);
    }
}

TEST_CASE("Moves are clamped before FCL's first contact, and before those that FCL does not detect", "[law]") {
    for (const PairShape shape : {PairShape::point_triangle, PairShape::edge_edge}) {
        for (const bool flat : {false, true}) {
            const std::string name = std::string(shape == PairShape::point_triangle ? "a point and a triangle" : "two edges") +
                                     (flat ? ", all in one plane" : "");
            const Moves moves = compare_moves(shape, flat);
            std::printf(
                "FCL's first contact of %s: told in %d of %d moves, right in %d; ours later in %d of these; %d contacts that "
                "FCL lets pass, %d that we do\n",
                name.c_str(), moves.reported, count, moves.right, moves.late, moves.missed_by_fcl, moves.missed);
            CHECK(moves.right + moves.missed_by_fcl > 1000);
            CHECK((moves.right == 0) == flat);  // why it is not used
            CHECK(moves.reported - moves.right <= moves.reported / 1000);
            check_law("moves of " + name + " cut later than FCL's first contact", moves.late, 0);
            check_law("moves of " + name + " that meet and are not cut", moves.missed, 0);
        }
    }
}

}  // namespace percale::test::fcl_oracles_test
