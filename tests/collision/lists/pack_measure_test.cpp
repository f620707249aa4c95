#include "collision/lists/pack_measure.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "collision/brute_force/brute_force_tree.h"
#include "tests/support/catch.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/trees.h"
#include "tests/support/random.h"

namespace percale::test::pack_measure_test {
namespace {

/// A random cloth triangle of some size near a point.
std::vector<Vec3> cloth_near(const Vec3& x, double size, Random& random) {
    std::vector<Vec3> cloth;
    const Vec3 centre = x + random.point(0.06);
    for (int k = 0; k < 3; ++k) cloth.push_back(centre + random.point(size));
    if (random.index(8) == 0) cloth[2] = cloth[0] + 1e-5 * (cloth[1] - cloth[0]) + random.point(1e-9);
    return cloth;
}

ContactPair pair_of(PairKind kind) {
    if (kind == PairKind::vertex_face) return {.kind = kind, .cloth = {0, -1, -1}};
    if (kind == PairKind::edge_edge) return {.kind = kind, .cloth = {0, 1, -1}};
    return {.kind = kind, .cloth = {0, 1, 2}};
}

struct Outcome {
    double excess = -1.0, slack = 0.0;
    int near = 0, constraints = 0, lost = 0, wrong_constraints = 0, skipped = 0;
};

/// Compares the answer for a pack with the exact distances of its pairs.
void compare(const ContactPair& feature, std::span<const Vec3> cloth, Obstacle& obstacle, int number, Outcome& outcome) {
    constexpr double thickness = 0.05;
    const FeaturePack& pack = obstacle.packs().packs[number];
    const PackAnswer answer = measure(feature, cloth, obstacle.placed(number, 0.0), {.near = thickness, .thickness = thickness});
    double least = 1e300;
    for (int lane = 0; lane < pack.count; ++lane) {
        ContactPair pair = feature;
        pair.feature = pack.feature[lane];
        const double distance = pair_distance(pair, cloth, obstacle, 0.0);
        least = std::min(least, distance);
        const bool near = distance < thickness, constraint = makes_contact(pair, cloth, obstacle, 0.0, thickness);
        outcome.near += near ? 1 : 0;
        outcome.constraints += constraint ? 1 : 0;
        outcome.lost += (near && (answer.near >> lane & 1U) == 0) || (constraint && (answer.contact >> lane & 1U) == 0) ? 1 : 0;
        outcome.wrong_constraints += constraint && static_cast<double>(answer.travel_to_contact) > 0.0 ? 1 : 0;
        outcome.skipped += near && (answer.contact >> lane & 1U) == 0 ? 1 : 0;
    }
    outcome.excess = std::max(outcome.excess, static_cast<double>(answer.distance_bound) - least);
    if (answer.distance_bound > -1e20F)
        outcome.slack = std::max(outcome.slack, least - static_cast<double>(answer.distance_bound));
}

Outcome compare_all(const TriangleMesh& mesh, PairKind kind, Random& random) {
    Outcome outcome;
    Obstacle obstacle(mesh, random.pose(0.2), 0.0, make_brute_force_tree);
    for (int round = 0; round < 600; ++round) {
        const Vec3 target = obstacle.at(random.index(static_cast<int>(obstacle.surface().vertices.size())), 0.0);
        const std::vector<Vec3> cloth = cloth_near(target, random.number(0.001, 0.1), random);
        for (std::size_t i = 0; i < obstacle.packs().packs.size(); ++i) {
            if (obstacle.packs().packs[i].kind == kind) compare(pair_of(kind), cloth, obstacle, static_cast<int>(i), outcome);
        }
    }
    return outcome;
}

}  // namespace

TEST_CASE("bounds of packs are below every distance, and no pair that is near or a contact is left out") {
    const PairKind kind = GENERATE(PairKind::vertex_face, PairKind::edge_edge, PairKind::face_vertex);
    const int number = GENERATE(0, 1, 2);
    Random random(50 + number);
    const TriangleMesh meshes[] = {make_sphere(0.3, 3), make_box({0.4, 0.3, 0.35}), spiky_ball(0.3, 2, 0.4, 9)};
    const Outcome outcome = compare_all(meshes[number], kind, random);
    CHECK(outcome.near > 20);
    CHECK(outcome.constraints > 0);
    CHECK(outcome.excess <= 0.0);
    CHECK(outcome.lost == 0);
    CHECK(outcome.wrong_constraints == 0);
    if (number == 0) CHECK(outcome.slack < 2e-3);
}

TEST_CASE("on a fine ball most pairs that are near are known not to be contacts") {
    const PairKind kind = GENERATE(PairKind::edge_edge, PairKind::face_vertex);
    Random random(54);
    const Outcome outcome = compare_all(make_sphere(0.3, 4), kind, random);
    CHECK(outcome.skipped > outcome.near / 2);
}

TEST_CASE("no feature of a pack becomes a contact before the cloth has moved as far as the answer states") {
    Random random(55);
    Obstacle obstacle(make_sphere(0.3, 3), {}, 0.0, make_brute_force_tree);
    constexpr double thickness = 0.05;
    int constraints = 0, reported = 0;
    for (int round = 0; round < 400; ++round) {
        const Vec3 target = obstacle.at(random.index(static_cast<int>(obstacle.surface().vertices.size())), 0.0);
        const std::vector<Vec3> cloth = cloth_near(target, 0.03, random);
        for (std::size_t i = 0; i < obstacle.packs().packs.size(); ++i) {
            const FeaturePack& pack = obstacle.packs().packs[i];
            if (pack.kind != PairKind::edge_edge) continue;
            const ContactPair feature = pair_of(pack.kind);
            const double way = static_cast<double>(
                measure(feature, cloth, obstacle.placed(static_cast<int>(i), 0.0), {.near = thickness, .thickness = thickness})
                    .travel_to_contact);
            if (!(way > 0.0)) continue;
            ++reported;
            std::vector<Vec3> moved = cloth;
            for (Vec3& x : moved) x += way * random.unit();
            for (int lane = 0; lane < pack.count; ++lane) {
                ContactPair pair = feature;
                pair.feature = pack.feature[lane];
                constraints += makes_contact(pair, moved, obstacle, 0.0, thickness) ? 1 : 0;
            }
        }
    }
    CHECK(reported > 1000);
    CHECK(constraints == 0);
}

}  // namespace percale::test::pack_measure_test
