#include "collision/self/near_cloths.h"

#include <numeric>
#include <set>

#include "collision/geometry/disjoint_sets.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::test::near_cloths_test {
namespace {

constexpr int points_each = 4;

std::vector<NearCloths::Cloth> random_cloths(int count, Random& random) {
    std::vector<NearCloths::Cloth> cloths(static_cast<std::size_t>(count));
    int next = 0;
    for (NearCloths::Cloth& cloth : cloths) {
        cloth.thickness = random.decades(1e-3, 0.3);
        cloth.vertices.resize(points_each);
        std::iota(cloth.vertices.begin(), cloth.vertices.end(), next);
        next += points_each;
    }
    return cloths;
}

std::vector<Vec3> random_places(int cloths, Random& random) {
    std::vector<Vec3> x;
    for (int c = 0; c < cloths; ++c) {
        const Vec3 middle = random.point(1.0);
        for (int k = 0; k < points_each; ++k) x.push_back(middle + random.point(0.1));
    }
    return x;
}

/// Whether boxes about the moves of two cloths, grown by so many of their thicknesses, overlap.
bool near(const NearCloths::Cloth& a, const NearCloths::Cloth& b, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
          double grown) {
    const auto box_of = [&](const NearCloths::Cloth& cloth) {
        Box box;
        for (const int v : cloth.vertices) box.add(from[v]), box.add(to[v]);
        box.grow(grown * cloth.thickness);
        return box;
    };
    return box_of(a).overlaps(box_of(b));
}

std::vector<int> expected_islands(const std::vector<NearCloths::Cloth>& cloths, const std::vector<int>& before,
                                  const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    const int count = static_cast<int>(cloths.size());
    DisjointSets sets(cloths.size());
    for (int a = 0; a < count; ++a) {
        for (int b = 0; b < count; ++b) {
            const bool together = before.empty() || before[a] == before[b];
            if (near(cloths[a], cloths[b], from, to, together ? 1.0 : 0.5)) sets.join(a, b);
        }
    }
    std::vector<int> islands;
    for (int c = 0; c < count; ++c) islands.push_back(sets.of(c));
    return islands;
}

}  // namespace

TEST_CASE("cloths join islands where boxes of a move meet, and leave them where no chain of near boxes leads to the others") {
    Random random(7);
    std::set<std::size_t> sizes;
    for (int round = 0; round < 50; ++round) {
        const int count = 1 + random.index(20);
        const std::vector<NearCloths::Cloth> cloths = random_cloths(count, random);
        NearCloths tested(cloths);
        std::vector<int> before;
        for (int move = 0; move < 4; ++move) {
            const std::vector<Vec3> from = random_places(count, random), to = random_places(count, random);
            const std::vector<Vec3>& end = move % 2 == 0 ? from : to;
            const std::vector<int> expected = expected_islands(cloths, before, from, end);
            tested.set_motion(from, end);
            const std::vector<int> islands = tested.islands(before, true);
            CHECK(islands == expected);
            sizes.insert(std::set(islands.begin(), islands.end()).size());
            before = islands;
        }
    }
    CHECK(sizes.size() > 8);
}

TEST_CASE("cloths that hover between half of their thicknesses and a whole one keep their islands") {
    NearCloths cloths({{.vertices = {0}, .thickness = 0.1}, {.vertices = {1}, .thickness = 0.1}});
    const auto islands_at = [&](double apart, std::vector<int> before, bool may_part = true) {
        const std::vector<Vec3> x{Vec3::Zero(), Vec3(apart, 0, 0)};
        cloths.set_motion(x, x);
        return cloths.islands(before, may_part);
    };
    const std::vector<int> joined{0, 0}, parted{0, 1};
    CHECK(islands_at(0.15, joined) == joined);
    CHECK(islands_at(0.15, parted) == parted);
    CHECK(islands_at(0.15, {}) == joined);
    CHECK(islands_at(0.09, parted) == joined);
    CHECK(islands_at(0.21, joined) == parted);
    CHECK(islands_at(0.21, joined, false) == joined);
    CHECK(islands_at(0.09, parted, false) == joined);
}

}  // namespace percale::test::near_cloths_test
