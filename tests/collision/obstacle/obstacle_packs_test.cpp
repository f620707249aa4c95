#include "collision/obstacle/obstacle_packs.h"

#include <cmath>
#include <set>

#include "collision/brute_force/brute_force_tree.h"
#include "collision/obstacle/obstacle.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/trees.h"
#include "tests/support/random.h"

namespace percale::test::obstacle_packs_test {
namespace {

TriangleMesh some_mesh(int number) {
    if (number == 0) return make_sphere(0.3, 2);
    if (number == 1) return make_box({0.4, 0.3, 0.35});
    return spiky_ball(0.3, 2, 0.4, 9);
}

std::vector<int> vertices_of(const ObstacleSurface& surface, const FeaturePack& pack, int lane) {
    const int feature = pack.feature[lane];
    if (pack.kind == PairKind::face_vertex) return {feature};
    if (pack.kind == PairKind::edge_edge) return {surface.edges[feature].vertex.begin(), surface.edges[feature].vertex.end()};
    return {surface.triangles[feature].begin(), surface.triangles[feature].end()};
}

/// How well boxes, planes and lanes fit the vertices.
struct Fit {
    bool inside = true;
    double above = -1.0, off = 0.0;  // m
};

void check_lane(Obstacle& obstacle, int number, int lane, double fraction, Fit& fit) {
    const ObstaclePacks& packs = obstacle.packs();
    const PlacedPack& placed = obstacle.placed(number, fraction);
    const std::vector<int> vertices = vertices_of(obstacle.surface(), packs.packs[number], lane);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Vec3 x = obstacle.at(vertices[k], fraction);
        Box slightly_larger = obstacle.hull(static_cast<int>(number)).box();
        slightly_larger.grow(1e-15);
        fit.inside = fit.inside && slightly_larger.contains(x) && obstacle.whole_box().overlaps(slightly_larger);
        fit.above = std::max(fit.above, obstacle.hull(number).normal.dot(x) - obstacle.hull(number).offset);
        for (int axis = 0; axis < 3; ++axis) {
            const double value = static_cast<double>(placed.lanes.at[3 * k + axis][lane]);
            fit.off = std::max(fit.off, std::abs(value + placed.centre[axis] - x[axis]));
        }
    }
}

}  // namespace

TEST_CASE("every face and every edge and vertex that can be touched is in one pack, at its stated place") {
    const ObstacleSurface surface = [] {
        const TriangleMesh mesh = some_mesh(GENERATE(0, 1, 2));
        return make_surface(mesh.vertices, mesh.triangles);
    }();
    const ObstaclePacks packs = make_packs(surface);
    std::set<std::pair<int, int>> found;
    for (std::size_t number = 0; number < packs.packs.size(); ++number) {
        const FeaturePack& pack = packs.packs[number];
        const int kind = static_cast<int>(pack.kind);
        for (int lane = 0; lane < pack.count; ++lane) {
            CHECK(found.insert({kind, pack.feature[lane]}).second);
            CHECK(packs.place_of[kind][pack.feature[lane]] == pack_lanes * static_cast<int>(number) + lane);
        }
    }
    std::size_t expected = surface.triangles.size();
    for (const SurfaceEdge& edge : surface.edges) expected += edge.can_touch ? 1 : 0;
    for (const bool touchable : surface.vertex_can_touch) expected += touchable ? 1 : 0;
    CHECK(found.size() == expected);
}

TEST_CASE("boxes and planes hold their packs during the whole step, and placed points are where the vertices are") {
    Random random(41);
    const int number = GENERATE(0, 1, 2);
    for (int round = 0; round < 10; ++round) {
        Obstacle obstacle(some_mesh(number), random.pose(0.5), 0.0, make_brute_force_tree);
        const Pose end = random.pose(0.5);
        const Pose start = round % 2 == 0 ? end : random.pose(0.5);
        obstacle.move(start, end);
        Fit fit;
        const double fraction = random.number(0.0, 1.0);
        for (std::size_t i = 0; i < obstacle.packs().packs.size(); ++i) {
            for (int lane = 0; lane < pack_lanes; ++lane) check_lane(obstacle, static_cast<int>(i), lane, fraction, fit);
        }
        CHECK(fit.inside);
        CHECK(fit.above < 1e-15);
        CHECK(fit.off < 1e-7);
    }
}

TEST_CASE("hulls, motions and placed packs that were computed in one step are computed again for the next") {
    Random random(43);
    Obstacle obstacle(some_mesh(1), {}, 0.0, make_brute_force_tree);
    Pose start = random.pose(0.5);
    for (int step = 0; step < 5; ++step) {
        const Pose end = step == 3 ? start : random.pose(0.5);
        obstacle.move(start, end);
        Fit fit;
        double beyond = -1.0;  // m, of the spread
        for (std::size_t i = 0; i < obstacle.packs().packs.size(); i += step + 1) {
            const int number = static_cast<int>(i);
            for (int lane = 0; lane < pack_lanes; ++lane) check_lane(obstacle, number, lane, 0.5, fit);
            const PatchMotion& motion = obstacle.motion_of(obstacle.packs().patch_of_pack[i]);
            for (const int vertex : vertices_of(obstacle.surface(), obstacle.packs().packs[i], 0)) {
                beyond = std::max(beyond, (obstacle.displacement(vertex) - motion.mean).norm() - motion.spread);
            }
        }
        CHECK(fit.inside);
        CHECK(fit.above < 1e-15);
        CHECK(fit.off < 1e-7);
        CHECK(beyond < 1e-15);
        start = end;
    }
}

TEST_CASE("the box of a hull is larger than its pack by no more than single precision makes it, far from the origin too") {
    Obstacle obstacle(some_mesh(0), {.translation = Vec3(1000.0, -3.0, 0.2)}, 0.0, make_brute_force_tree);
    const ObstaclePacks& packs = obstacle.packs();
    for (std::size_t number = 0; number < packs.packs.size(); ++number) {
        Box exact;
        for (int lane = 0; lane < packs.packs[number].count; ++lane) {
            for (const int v : vertices_of(obstacle.surface(), packs.packs[number], lane)) exact.add(obstacle.at(v, 0.0));
        }
        const Box box = obstacle.hull(static_cast<int>(number)).box();
        for (int axis = 0; axis < 3; ++axis) {
            const double most = 1.2e-7 * std::max(std::abs(exact.low[axis]), std::abs(exact.high[axis]));
            CHECK(box.low[axis] <= exact.low[axis]);
            CHECK(box.high[axis] >= exact.high[axis]);
            CHECK(box.low[axis] >= exact.low[axis] - most);
            CHECK(box.high[axis] <= exact.high[axis] + most);
        }
    }
}

TEST_CASE("the gap between two boxes is that of their nearest sides, edges or corners") {
    Box unit, other;
    unit.add(Vec3(0, 0, 0));
    unit.add(Vec3(1, 1, 1));
    const auto gap_to = [&](const Vec3& low, const Vec3& high) {
        other = {low, high};
        CHECK(other.gap(unit) == unit.gap(other));
        return unit.gap(other);
    };
    CHECK(gap_to(Vec3(0.5, 0.5, 0.5), Vec3(2, 2, 2)) == 0.0);
    CHECK(gap_to(Vec3(3, 0.5, 0.5), Vec3(4, 2, 2)) == 2.0);
    CHECK(gap_to(Vec3(4, 5, 0.5), Vec3(5, 6, 2)) == 5.0);
    CHECK(gap_to(Vec3(-4, -3, 3), Vec3(-3, -2, 4)) == Approx(std::sqrt(9.0 + 4.0 + 4.0)));
}

TEST_CASE("every direction in which a vertex faces the viewer is in its cone") {
    Random random(42);
    const int number = GENERATE(0, 1, 2);
    Obstacle obstacle(some_mesh(number), {}, 0.0, make_brute_force_tree);
    const ObstacleSurface& surface = obstacle.surface();
    int facing = 0, outside = 0, cones = 0;
    const auto at = [&](int vertex) { return obstacle.at(vertex, 0.0); };
    for (std::size_t vertex = 0; vertex < surface.vertices.size(); ++vertex) {
        const int place = obstacle.packs().place_of[2][vertex];
        if (place < 0) continue;
        const PackLanes& lanes = obstacle.placed(place / pack_lanes, 0.0).lanes;
        const int lane = place % pack_lanes;
        const Vec3 axis(static_cast<double>(lanes.at[3][lane]), static_cast<double>(lanes.at[4][lane]),
                        static_cast<double>(lanes.at[5][lane]));
        const double cosine = static_cast<double>(lanes.at[6][lane]);
        cones += cosine > -1.0 ? 1 : 0;
        for (int k = 0; k < 200; ++k) {
            const double spread = random.number(0.0, 2.0);
            const Vec3 direction = (axis + spread * random.unit()).normalized();
            if (!vertex_faces(surface, static_cast<int>(vertex), direction, at)) continue;
            ++facing;
            outside += axis.dot(direction) < cosine - 1e-6 ? 1 : 0;
        }
    }
    CHECK(facing > 100);
    CHECK(outside == 0);
    CHECK((number == 1 || cones > 50));
}

}  // namespace percale::test::obstacle_packs_test
