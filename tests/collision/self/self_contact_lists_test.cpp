#include "collision/self/self_contact_lists.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/collision/cloths.h"
#include "tests/support/collision/steps.h"

namespace percale::test::self_contact_lists_test {
namespace {

using Key = std::pair<int, std::array<int, 2>>;

/// By features, the edge with the lower number first.
template <class Value, class Of>
std::map<Key, Value> by_features(SelfContactLists& lists, Of of) {
    std::map<Key, Value> all;
    lists.for_each([&](const SelfList& list) {
        for (SelfPair pair : list.pairs) {
            const double activation_distance = list.activation_distance(pair);
            if (pair.shape == PairShape::edge_edge && pair.feature[0] > pair.feature[1]) {
                std::swap(pair.feature[0], pair.feature[1]);
                std::swap(pair.vertex[0], pair.vertex[2]);
                std::swap(pair.vertex[1], pair.vertex[3]);
            }
            const bool fresh = all.insert({{static_cast<int>(pair.shape), pair.feature}, of(pair, activation_distance)}).second;
            CHECK(fresh);
        }
    });
    return all;
}
std::map<Key, SelfPair> pairs_of(SelfContactLists& lists) {
    return by_features<SelfPair>(lists, [](const SelfPair& pair, double) { return pair; });
}
std::map<Key, double> activation_distances_of(SelfContactLists& lists) {
    return by_features<double>(lists, [](const SelfPair&, double activation_distance) { return activation_distance; });
}

/// All pairs without a common vertex.
std::vector<SelfPair> every_pair(const Cloths& cloths) {
    const ClothSurface surface = make_cloth_surface(cloths.mesh.triangles, cloths.mesh.vertices.size());
    std::vector<SelfPair> pairs;
    for (int v = 0; v < static_cast<int>(cloths.mesh.vertices.size()); ++v) {
        for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
            const Triangle& c = surface.triangles[t];
            if (v != c[0] && v != c[1] && v != c[2]) pairs.push_back({.vertex = {v, c[0], c[1], c[2]}, .feature = {v, t}});
        }
    }
    for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
        for (int f = e + 1; f < static_cast<int>(surface.edges.size()); ++f) {
            const auto &a = surface.edges[e].vertex, &b = surface.edges[f].vertex;
            if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
            pairs.push_back({.shape = PairShape::edge_edge, .vertex = {a[0], a[1], b[0], b[1]}, .feature = {e, f}});
        }
    }
    return pairs;
}

double activation_distance(const Cloths& cloths, const SelfPair& pair) {
    const double mean = 0.5 * (cloths.thickness[pair.vertex[0]] + cloths.thickness[pair.vertex[3]]);
    const bool one = cloths.cloth[pair.vertex[0]] == cloths.cloth[pair.vertex[3]];
    return one ? std::min(mean, 0.5 * self_distance(pair, cloths.mesh.vertices)) : mean;
}

void check_bounds(SelfContactLists& lists, const std::vector<Vec3>& x) {
    lists.for_each([&](const SelfList& list) {
        for (const SelfPair& pair : list.pairs) {
            CHECK(pair.reach - list.travel <= self_distance(pair, x) * (1 + 1e-12));
            CHECK(list.smallest_reach <= pair.reach);
        }
    });
}

/// Pairs in no list are apart, others are what they should be; returns how many are in lists.
int check_pairs(SelfContactLists& lists, const Cloths& cloths, const std::vector<Vec3>& here) {
    const auto pairs = pairs_of(lists);
    int near = 0;
    for (const SelfPair& pair : every_pair(cloths)) {
        const double distance = self_distance(pair, here), thickness = activation_distance(cloths, pair);
        const auto found = pairs.find({static_cast<int>(pair.shape), pair.feature});
        if (found == pairs.end()) {
            CHECK(distance >= thickness);
            continue;
        }
        ++near;
        CHECK(found->second.vertex == pair.vertex);
        CHECK(found->second.thickness == Approx(thickness).epsilon(1e-12));
    }
    return near;
}

/// Random pairs that are in no list are apart.
void check_some_pairs(SelfContactLists& lists, const Cloths& cloths, const std::vector<Vec3>& here, Random& random) {
    std::vector<std::array<int, 2>> listed;  // vertices and triangles
    lists.for_each([&](const SelfList& list) {
        for (const SelfPair& pair : list.pairs) {
            if (pair.shape == PairShape::point_triangle) listed.push_back(pair.feature);
        }
    });
    std::sort(listed.begin(), listed.end());
    const ClothSurface& surface = lists.surface();
    for (int n = 0; n < 20000; ++n) {
        const int v = random.index(static_cast<int>(here.size())), t = random.index(static_cast<int>(surface.triangles.size()));
        const Triangle& face = surface.triangles[t];
        if (v == face[0] || v == face[1] || v == face[2]) continue;
        const SelfPair pair{.vertex = {v, face[0], face[1], face[2]}, .feature = {v, t}};
        if (std::binary_search(listed.begin(), listed.end(), pair.feature)) continue;
        CHECK(self_distance(pair, here) >= activation_distance(cloths, pair));
    }
}

constexpr double mark = -123.0;

void mark_all(SelfContactLists& lists) {
    lists.for_each([](SelfList& list) {
        for (SelfPair& pair : list.pairs) pair.reach = mark;
    });
}

/// How many lists of each two cloths have been kept, and how many rebuilt.
std::map<std::pair<int, int>, std::array<int, 2>> kept_and_made(SelfContactLists& lists, const Cloths& cloths) {
    std::map<std::pair<int, int>, std::array<int, 2>> counts;
    lists.for_each([&](const SelfList& list) {
        if (list.pairs.empty()) return;
        const auto& vertex = list.pairs[0].vertex;
        ++counts[{cloths.cloth[vertex[0]], cloths.cloth[vertex[3]]}][list.pairs[0].reach == mark ? 0 : 1];
    });
    return counts;
}

/// Whether each list with pairs is as it was.
bool all_kept(SelfContactLists& lists, const Cloths& cloths) {
    const auto counts = kept_and_made(lists, cloths);
    return !counts.empty() && std::ranges::all_of(counts, [](const auto& entry) { return entry.second[1] == 0; });
}

std::vector<std::vector<int>> islands_of(const SelfContactLists& lists) {
    std::vector<std::vector<int>> islands;
    for (const Island& island : lists.memory().islands) islands.push_back(island.cloths);
    return islands;
}

/// Cloth n moved by n times a vector.
std::vector<Vec3> spread_out(const Cloths& cloths, std::vector<Vec3> x, const Vec3& by) {
    for (std::size_t v = 0; v < x.size(); ++v) x[v] += cloths.cloth[v] * by;
    return x;
}

std::vector<Vec3> shaken(std::vector<Vec3> x, double by, Random& random) {
    for (Vec3& point : x) point += random.point(by);
    return x;
}

}  // namespace

TEST_CASE("lists of cloth against cloth hold every pair that comes near during a move, each once, and bound its distance",
          "[slow]") {
    Random random(GENERATE(1U, 3U));
    const double h = 0.05;
    const Cloths cloths = sheet_stack(3, 9, 0.06, h, random);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> x = cloths.mesh.vertices;
    for (int step = 0; step < 5; ++step) {
        // A long common displacement, and a short one each.
        const Vec3 together = random.point(2.0);
        std::vector<Vec3> to = shaken(x, random.decades(1e-3, 0.1), random);
        for (Vec3& point : to) point += together;
        CHECK((step % 2 == 0 ? lists.cover(x, to) : lists.begin_step(x, to)) == 1.0);
        const double fraction = random.number(0.0, 1.0);
        const std::vector<Vec3> here = shaken(between(x, to, fraction), 0.1 * h, random);
        CHECK(lists.cover(here, here) == 1.0);
        const int near = check_pairs(lists, cloths, here);
        CHECK(near > 10);
        check_bounds(lists, here);
        x = here;
    }
}

TEST_CASE("lists stay valid while cloth moves as a whole, along its prediction or by less than its skin") {
    Random random(6);
    const double h = 0.05;
    const Cloths cloths = sheet_stack(2, 9, 0.06, h, random);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    const std::vector<Vec3>& start = cloths.mesh.vertices;
    const std::vector<Vec3> to = shaken(start, 0.3, random);
    lists.cover(start, to);
    const auto kept = [&](const std::vector<Vec3>& x) {
        mark_all(lists);
        lists.cover(x, x);
        return all_kept(lists, cloths);
    };
    const std::vector<Vec3> there = between(start, to, 0.37);
    CHECK(kept(there));
    CHECK(kept(shaken(there, 0.02 * h, random)));
    std::vector<Vec3> away = between(start, to, 0.8);
    for (Vec3& point : away) point += Vec3(5.0, -2.0, 1.0);
    CHECK(kept(away));
    std::vector<Vec3> off = away;
    off[17].y() += 2.0;
    CHECK_FALSE(kept(off));
    CHECK(kept(off));
}

TEST_CASE("iterations that go to and fro within the move of a step use up no room; steps do") {
    Random random(8);
    const Cloths cloths = sheet_stack(2, 9, 0.06, 0.05, random);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    const std::vector<Vec3>& start = cloths.mesh.vertices;
    const std::vector<Vec3> to = shaken(start, 0.3, random);
    const auto kept = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& end) {
        mark_all(lists);
        lists.cover(from, end);
        return all_kept(lists, cloths);
    };
    lists.begin_step(start, to);
    for (int n = 0; n < 10; ++n) {
        CHECK(kept(start, to));
        CHECK(kept(to, start));
    }
    lists.begin_step(start, start);
    lists.begin_step(to, start);
    mark_all(lists);
    lists.begin_step(start, to);
    CHECK_FALSE(all_kept(lists, cloths));
    check_pairs(lists, cloths, to);
}

TEST_CASE("lists of cloth that has moved are rebuilt, others stay") {
    Random random(16);
    const Cloths cloths = sheet_stack(2, 17, 0.06, 0.05, random);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> x = cloths.mesh.vertices;
    lists.cover(x, x);
    x[0].y() -= 0.04;  // a corner of the lower sheet
    mark_all(lists);
    lists.cover(x, x);
    int kept = 0, made = 0;
    for (const auto& [cloth, count] : kept_and_made(lists, cloths)) kept += count[0], made += count[1];
    CHECK(made > 0);
    CHECK(kept > 10 * made);
    check_pairs(lists, cloths, x);
}

TEST_CASE("a contact stays one where lists are rebuilt") {
    Random random(9);
    const Cloths cloths = sheet_stack(2, 6, 0.06, 0.05, random);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> x = cloths.mesh.vertices;
    lists.cover(x, x);
    int marked = 0;
    lists.for_each([&](SelfList& list) {
        for (SelfPair& pair : list.pairs) {
            if (pair.feature[1] % 3 == 0) list.record_of(pair).activation_distance = 0.01 * (1 + pair.feature[0]);
            marked += list.activation_distance(pair) > 0.0;
        }
    });
    REQUIRE(marked > 10);
    const auto before = activation_distances_of(lists);
    x[0].y() += 10.0;  // the lists are no longer valid
    lists.cover(x, x);
    lists.for_each([](const SelfList& list) { CHECK(list.pairs.capacity() <= 2 * list.pairs.size() + 8); });
    int taken = 0;
    for (const auto& [key, activation_distance] : activation_distances_of(lists)) {
        const auto old = before.find(key);
        CHECK(activation_distance == (old == before.end() ? 0.0 : old->second));
        taken += activation_distance > 0.0;
    }
    CHECK(taken > marked / 2);
}

TEST_CASE("a list that no longer holds a pair holds no memory either") {
    SelfList list;
    list.pairs.resize(100);
    list.record_of(list.pairs[7]).activation_distance = 0.01;
    list.record_of(list.pairs[40]).activation_distance = 0.0;
    REQUIRE(list.record_of(list.pairs[7]).pair == 7);
    REQUIRE(list.records.size() == 2);
    list.give_up();
    REQUIRE(list.pairs.size() == 1);
    CHECK(list.activation_distance(list.pairs[0]) == 0.01);
    CHECK(list.records[0].pair == 0);
    CHECK(list.pairs.capacity() < 3);
    list.clear(1.0);
    CHECK(list.pairs.capacity() + list.records.capacity() == 0);
}

TEST_CASE("cloth that meets no cloth is in no list") {
    Random random(5);
    Cloths cloths;
    cloths.add(make_grid(1, 1, 5, 5), 0.05, false);
    cloths.add(moved(make_grid(1, 1, 5, 5), {0, 0.01, 0}), 0.05);
    cloths.add(moved(make_grid(1, 1, 5, 5), {0, 0.02, 0}), 0.05);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    lists.cover(cloths.mesh.vertices, cloths.mesh.vertices);
    const auto pairs = pairs_of(lists);
    CHECK(pairs.size() > 50);
    for (const auto& [key, pair] : pairs) {
        for (const int v : pair.vertex) CHECK(v >= 25);
    }
}

TEST_CASE("cloths that fly past each other are in lists together while they are near, and leave no pair out", "[slow]") {
    Random random(11);
    Cloths cloths;
    for (int n = 0; n < 4; ++n) cloths.add(moved(make_grid(0.5, 0.5, 5, 5), random.point(0.8)), 0.04);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> x = cloths.mesh.vertices;
    std::set<std::size_t> island_counts;
    int of_two = 0;
    for (int step = 0; step < 20; ++step) {
        std::vector<Vec3> velocity(4);
        for (Vec3& v : velocity) v = random.point(0.4);
        std::vector<Vec3> to = shaken(x, 0.02, random);
        for (std::size_t v = 0; v < to.size(); ++v) to[v] += velocity[cloths.cloth[v]] - 0.2 * to[v];
        lists.begin_step(x, to);
        check_pairs(lists, cloths, between(x, to, random.number(0.0, 1.0)));
        lists.cover(to, to);
        check_pairs(lists, cloths, to);
        check_bounds(lists, to);
        island_counts.insert(islands_of(lists).size());
        for (const auto& [key, pair] : pairs_of(lists)) of_two += cloths.cloth[pair.vertex[0]] != cloths.cloth[pair.vertex[3]];
        x = to;
    }
    CHECK(island_counts.size() > 1);
    CHECK(of_two > 100);
}

TEST_CASE("cloths that meet join islands and keep their own lists, until they are apart") {
    Cloths cloths;
    for (int n = 0; n < 4; ++n) cloths.add(make_grid(1, 1, 5, 5), 0.3);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> folded = cloths.mesh.vertices;
    for (Vec3& point : folded) {
        if (point.x() > 0.0) point = Vec3(-point.x(), 0.1, point.z());
    }
    const std::vector<Vec3> apart = spread_out(cloths, folded, {3, 0, 0});
    lists.cover(apart, apart);
    CHECK(islands_of(lists) == std::vector<std::vector<int>>{{0}, {1}, {2}, {3}});
    mark_all(lists);
    std::vector<Vec3> x = spread_out(cloths, folded, {7, 1, -2});
    lists.cover(x, x);
    CHECK(all_kept(lists, cloths));
    for (std::size_t v = 0; v < x.size(); ++v) {
        if (cloths.cloth[v] == 2) x[v] = folded[v] + Vec3(0, 0.04, 0);  // in cloth 0's fold
    }
    lists.cover(x, x);
    CHECK(islands_of(lists) == std::vector<std::vector<int>>{{0, 2}, {1}, {3}});
    CHECK(check_pairs(lists, cloths, x) > 100);
    for (const auto& [two, count] : kept_and_made(lists, cloths)) CHECK(count[two.first == two.second ? 1 : 0] == 0);
    lists.cover(apart, apart);
    CHECK(islands_of(lists) == std::vector<std::vector<int>>{{0, 2}, {1}, {3}});
    lists.begin_step(apart, apart);
    CHECK(islands_of(lists) == std::vector<std::vector<int>>{{0}, {1}, {2}, {3}});
    check_pairs(lists, cloths, apart);
}

TEST_CASE("a move that would take too many pairs is covered in part, and leaves no more lists than others once a step has begun",
          "[slow]") {
    Random random(21);
    Cloths cloths;
    for (int n = 0; n < 2; ++n) cloths.add(moved(make_grid(1, 1, 21, 21), {0, 0.06 * n, 0}), 0.05);
    SelfContactLists lists(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    const std::vector<Vec3>& x = cloths.mesh.vertices;
    const auto counted = [&] {
        std::array<std::size_t, 2> counts{};  // lists, pairs
        lists.for_each([&](const SelfList& list) { ++counts[0], counts[1] += list.pairs.size(); });
        return counts;
    };
    lists.begin_step(x, x);
    const auto before = counted();
    const std::vector<Vec3> to = shaken(x, 1.0, random);
    const double fraction = lists.cover(x, to);
    CHECK(fraction > 0.0);
    CHECK(fraction < 1.0);
    const auto there = counted();
    CHECK(there[0] < 300000);
    CHECK(there[1] < 5000000);
    const std::vector<Vec3> here = between(x, to, random.number(0.0, fraction));
    lists.cover(here, here);
    check_some_pairs(lists, cloths, here, random);
    lists.cover(x, x);
    lists.begin_step(x, x);
    const auto after = counted();
    CHECK(after[0] <= 2 * before[0]);
    CHECK(after[1] <= 4 * before[1]);
}

}  // namespace percale::test::self_contact_lists_test
