#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "collision/certificate/triangle_gap.h"
#include "collision/certificate/triangle_overlap.h"
#include "tests/support/catch.h"
#include "tests/support/laws.h"
#include "tests/support/random.h"

// Bullet's distance of two triangles (GJK in double precision, no margins) beside ours.

namespace percale::test::bullet_oracles_test {
namespace {

using certificate::Corners;

btVector3 to_bullet(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Below 0 where GJK gives up or takes them for overlapping.
double bullet_distance(const Corners& a, const Corners& b) {
    btTriangleShape first(to_bullet(a[0]), to_bullet(a[1]), to_bullet(a[2]));
    btTriangleShape second(to_bullet(b[0]), to_bullet(b[1]), to_bullet(b[2]));
    first.setMargin(0.0);
    second.setMargin(0.0);
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&first, &second, &simplex, nullptr);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    return result.m_hasResult ? result.m_distance : -1.0;
}

struct Compared {
    int apart = 0, given_up = 0, not_numbers = 0;
    double ours_longer = 0.0, bullet_longer = 0.0;  // m
};

/// Triangles of about `size`, `gap` apart along z, and with `flat` in planes across it.
Compared compare(double gap, bool flat) {
    Random random(3);
    Compared result;
    for (int n = 0; n < 100'000; ++n) {
        Corners a, b;
        for (int k = 0; k < 3; ++k) {
            a[k] = random.point(1.0);
            b[k] = random.point(1.0);
            if (flat) a[k].z() = b[k].z() = 0.0;
            b[k].z() += gap;
        }
        if (certificate::classify(a, b) != certificate::Overlap::disjoint) continue;
        ++result.apart;
        const double bullet = bullet_distance(a, b), ours = certificate::triangle_distance(a, b);
        result.not_numbers += !std::isfinite(ours) || !std::isfinite(bullet);
        if (bullet <= 0.0) {
            ++result.given_up;
            continue;
        }
        result.ours_longer = std::max(result.ours_longer, ours - bullet);
        result.bullet_longer = std::max(result.bullet_longer, bullet - ours);
    }
    return result;
}

}  // namespace

TEST_CASE("Distances of triangles are Bullet's, and never longer", "[law]") {
    for (const auto& [gap, flat] :
         {std::pair(0.0, false), {3.0, false}, {1e-1, true}, {1e-3, true}, {1e-6, true}, {1e-9, true}}) {
        const Compared result = compare(gap, flat);
        const std::string name =
            "distance of two triangles, " + std::string(flat ? "parallel, " : "any, ") + figure(gap) + " m apart: ";
        CHECK(result.apart > 50'000);
        CHECK(result.given_up == 0);
        CHECK(result.not_numbers == 0);
        check_law(name + "longer than Bullet's, m", result.ours_longer, 2e-14);
        check_law(name + "shorter than Bullet's, m", result.bullet_longer, 2e-14);
    }
}

}  // namespace percale::test::bullet_oracles_test
