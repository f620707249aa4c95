#include <set>

#include "collision/self/self_contact_lists.h"
#include "tests/support/catch.h"
#include "tests/support/collision/cloths.h"
#include "tests/support/collision/steps.h"

namespace percale::test::self_list_maker_test {
namespace {

/// m, thickness of a vertex and a triangle of two cloths.
double thickness_of(const Cloths& cloths, const ClothPairs& said, int vertex, int other) {
    const double mean = 0.5 * (cloths.thickness[vertex] + cloths.thickness[other]);
    return said.of(cloths.cloth[vertex], cloths.cloth[other]).thickness.value_or(mean);
}

/// Vertices and triangles of two cloths that are in lists; checks the thickness of each.
std::set<std::array<int, 2>> listed_between(SelfContactLists& lists, const Cloths& cloths, const ClothPairs& said) {
    std::set<std::array<int, 2>> listed;
    lists.for_each([&](const SelfList& list) {
        for (const SelfPair& pair : list.pairs) {
            if (cloths.cloth[pair.vertex[0]] == cloths.cloth[pair.vertex[3]]) continue;
            CHECK(said.of(cloths.cloth[pair.vertex[0]], cloths.cloth[pair.vertex[3]]).contact);
            CHECK(pair.thickness == Approx(thickness_of(cloths, said, pair.vertex[0], pair.vertex[3])).epsilon(1e-12));
            if (pair.shape == PairShape::point_triangle) listed.insert(pair.feature);
        }
    });
    return listed;
}

}  // namespace

TEST_CASE("features of one cloth have the thickness or half of their distance at rest, but never less than a hundredth") {
    const double h = 0.05;
    Cloths cloths;
    // Two sheets of one cloth, side by side, a hundred thousandth apart.
    cloths.add(joined(make_grid(0.6, 0.6, 7, 7), moved(make_grid(0.6, 0.6, 7, 7), {0.60001, 0, 0})), h);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    Random random(5);
    std::vector<Vec3> to = cloths.mesh.vertices;
    for (Vec3& x : to) x += random.point(0.1);
    lists.begin_step(cloths.mesh.vertices, to);
    int least = 0, most = 0, between = 0;
    lists.for_each([&](const SelfList& list) {
        for (const SelfPair& pair : list.pairs) {
            const double at_rest = 0.5 * self_distance(pair, cloths.mesh.vertices);
            CHECK(pair.thickness == Approx(std::min(h, std::max(at_rest, 0.01 * h))).epsilon(1e-12));
            least += at_rest < 0.01 * h;
            most += at_rest > h;
            between += at_rest > 0.01 * h && at_rest < h;
        }
    });
    CHECK(least > 6);
    CHECK(between > 100);
    CHECK(most > 100);
}

TEST_CASE("lists hold every pair of cloths of several thicknesses, or of one that is set, and none of cloths that do not meet") {
    Random random(GENERATE(31U, 32U));
    Cloths cloths;
    const std::array thicknesses{0.05, 0.02, 0.03};
    for (int n = 0; n < 3; ++n) {
        TriangleMesh sheet = moved(make_grid(0.6, 0.6, 7, 7), {0.03 * n, 0.05 * n, 0});
        for (Vec3& x : sheet.vertices) x += random.point(0.01);
        cloths.add(sheet, thicknesses[n]);
    }
    ClothPairs said;
    said.set(0, 2, {.thickness = 0.12});
    said.set(0, 1, {.contact = false});
    SelfContact contact = cloths.self_contact();
    contact.pairs = said;
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, contact);
    std::vector<Vec3> x = cloths.mesh.vertices;
    int near = 0;
    for (int step = 0; step < 6; ++step) {
        std::vector<Vec3> to = x;
        for (Vec3& point : to) point += random.point(0.04);
        lists.begin_step(x, to);
        const std::vector<Vec3> here = between(x, to, random.number(0.0, 1.0));
        lists.cover(here, here);
        const auto listed = listed_between(lists, cloths, said);
        const auto check = [&](int v, int t) {
            const Triangle& face = lists.surface().triangles[t];
            const int a = cloths.cloth[v], b = cloths.cloth[face[2]];
            if (a == b || !said.of(a, b).contact) return;
            const SelfPair pair{.vertex = {v, face[0], face[1], face[2]}, .feature = {v, t}};
            if (self_distance(pair, here) >= thickness_of(cloths, said, v, face[2])) return;
            ++near;
            CHECK(listed.contains({v, t}));
        };
        for (int v = 0; v < static_cast<int>(x.size()); ++v) {
            for (int t = 0; t < static_cast<int>(cloths.mesh.triangles.size()); ++t) check(v, t);
        }
        x = here;
    }
    CHECK(near > 1000);
}

}  // namespace percale::test::self_list_maker_test
