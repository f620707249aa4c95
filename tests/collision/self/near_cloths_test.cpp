#include "collision/self/near_cloths.h"

#include <numeric>

#include "collision/geometry/disjoint_sets.h"
#include "collision/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

using namespace percale;
using namespace percale::test;

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

}  // namespace

TEST_CASE("cloths meet whose boxes during a move come within half of their thicknesses, and no others") {
    Random random(7);
    for (int round = 0; round < 50; ++round) {
        const int count = 1 + random.index(20);
        const std::vector<NearCloths::Cloth> cloths = random_cloths(count, random);
        const std::vector<Vec3> from = random_places(count, random), to = random_places(count, random);
        std::vector<std::pair<int, int>> expected;
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
                if (near(cloths[a], cloths[b], from, to, 0.5)) expected.emplace_back(a, b);
            }
        }
        NearCloths tested(cloths);
        tested.set_motion(from, to);
        CHECK(tested.meeting() == expected);
    }
}

TEST_CASE("groups of cloths are the connected parts of what comes within the thicknesses, in order, of those asked for alone") {
    Random random(8);
    std::size_t most = 0;
    for (int round = 0; round < 50; ++round) {
        const int count = 2 + random.index(20);
        const std::vector<NearCloths::Cloth> cloths = random_cloths(count, random);
        const std::vector<Vec3> x = random_places(count, random);
        std::vector<int> asked;
        for (int c = 0; c < count; ++c) {
            if (random.index(4) > 0) asked.push_back(c);
        }
        DisjointSets sets(cloths.size());
        for (const int a : asked) {
            for (const int b : asked) {
                if (near(cloths[a], cloths[b], x, x, 0.5 + tolerances::self_skin)) sets.join(a, b);
            }
        }
        NearCloths tested(cloths);
        tested.set_motion(x, x);
        const std::vector<std::vector<int>> groups = tested.groups(asked);
        most = std::max(most, groups.size());
        std::vector<int> all;
        for (const std::vector<int>& group : groups) {
            CHECK(std::is_sorted(group.begin(), group.end()));
            for (const int c : group) CHECK(sets.of(c) == group.front());
            all.insert(all.end(), group.begin(), group.end());
        }
        CHECK(std::is_sorted(groups.begin(), groups.end()));
        std::sort(all.begin(), all.end());
        CHECK(all == asked);
    }
    CHECK(most > 4);
}
