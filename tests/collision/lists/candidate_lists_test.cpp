#include "collision/lists/candidate_lists.h"

#include <algorithm>
#include <map>
#include <set>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::candidate_lists_test {
namespace {

constexpr double thickness = 0.06;

struct World {
    TriangleMesh cloth;
    Obstacles obstacles;
    std::vector<double> thickness_of_vertex;

    World(int obstacle_number, Random& random) : cloth(crumpled_sheet(0.6, 4, 0.05, random)) {
        const TriangleMesh meshes[] = {make_sphere(0.3, 1), make_box({0.4, 0.3, 0.35}), spiky_ball(0.3, 1, 0.4, 9)};
        cloth = placed(cloth, random.pose(0.3));
        add(meshes[obstacle_number], random);
        if (obstacle_number == 1) add(make_plane(0.5), random);
        thickness_of_vertex.assign(cloth.vertices.size(), thickness);
    }

    void add(const TriangleMesh& mesh, Random& random) {
        obstacles.push_back(std::make_unique<Obstacle>(mesh, random.pose(0.1), 0.1, make_brute_force_tree));
    }
    void set_off(Random& random, double way) {
        for (auto& obstacle : obstacles) {
            const Pose start = random.pose(0.1);
            Pose end = start;
            end.translation += random.point(way);
            obstacle->move(start, end);
        }
    }
    CandidateLists lists() const { return {cloth.triangles, thickness_of_vertex, cloth.vertices}; }
};

std::set<PairKey> keys(CandidateLists& lists, const World& world) {
    std::set<PairKey> result;
    for (const ClusterList& list : lists.lists()) {
        for (const ListedPair& listed : listed_pairs(list, world.obstacles)) result.insert(key(listed.pair));
    }
    return result;
}

/// Where every vertex may be by all the boxes it has.
std::vector<Box> allowed(CandidateLists& lists, std::size_t vertices) {
    std::vector<Box> boxes(vertices);
    for (Box& box : boxes) box.low = Vec3::Constant(-1e300), box.high = Vec3::Constant(1e300);
    for (std::size_t i = 0; i < lists.lists().size(); ++i) {
        const auto& vertex = lists.clusters().clusters[i].all_vertices;
        for (std::size_t k = 0; k < vertex.size(); ++k) {
            boxes[vertex[k]].low = boxes[vertex[k]].low.cwiseMax(lists.lists()[i].boxes[k].low);
            boxes[vertex[k]].high = boxes[vertex[k]].high.cwiseMin(lists.lists()[i].boxes[k].high);
        }
    }
    return boxes;
}

std::vector<Vec3> anywhere(const std::vector<Box>& boxes, Random& random) {
    std::vector<Vec3> x;
    for (const Box& box : boxes) {
        const Vec3 u = 0.5 * (random.point(1.0) + Vec3::Ones());
        x.push_back(box.low + u.cwiseProduct(box.high - box.low));
    }
    return x;
}

/// Pairs nearer than the thickness that the lists lack. Counts the near ones into `near`.
int missing(const World& world, std::span<const Vec3> x, double fraction, const std::set<PairKey>& listed, int& near) {
    int count = 0;
    for (int o = 0; o < int(world.obstacles.size()); ++o) {
        for (ContactPair pair : all_pairs(world.cloth, *world.obstacles[o], true)) {
            pair.obstacle = o;
            if (pair_distance(pair, x, *world.obstacles[o], fraction) >= thickness) continue;
            ++near;
            count += listed.count(key(pair)) == 0 ? 1 : 0;
        }
    }
    return count;
}

/// Covers a whole step and returns the number of lists built for it: those get new boxes, the others keep a mark behind theirs.
long lists_built(CandidateLists& lists, const World& world, std::span<const Vec3> from, std::span<const Vec3> to) {
    for (ClusterList& list : lists.lists()) list.boxes.emplace_back();
    lists.cover({.from = from, .to = to, .fraction = {0.0, 1.0}}, world.obstacles);
    long built = 0;
    for (std::size_t i = 0; i < lists.lists().size(); ++i) {
        std::vector<Box>& boxes = lists.lists()[i].boxes;
        const bool marked = boxes.size() > lists.clusters().clusters[i].all_vertices.size();
        if (marked) boxes.pop_back();
        built += marked ? 0 : 1;
    }
    return built;
}

/// Largest excess of a pair's bound over its true distance, m (<= 0 if all bounds are valid).
double excess(const World& world, CandidateLists& lists, std::span<const Vec3> x, double fraction) {
    double most = -1e300;
    for (const ClusterList& list : lists.lists()) {
        for (const auto& [pair, reach] : listed_pairs(list, world.obstacles)) {
            const double distance = pair_distance(pair, x, *world.obstacles[pair.obstacle], fraction);
            most = std::max({most, reach - list.travel - distance, list.smallest_reach - reach});
        }
    }
    return most;
}

std::vector<Vec3> stepped(std::vector<Vec3> x, double step, Random& random) {
    for (Vec3& p : x) p += random.point(step);
    return x;
}

/// One step of a random walk, with four states on its way. Returns the largest excess.
double walk_one_step(const World& world, CandidateLists& lists, std::vector<Vec3>& x, Random& random) {
    const std::vector<Vec3> predicted = stepped(x, 0.03, random);
    lists.cover({.from = x, .to = predicted, .fraction = {0.0, 1.0}}, world.obstacles);
    double worst = excess(world, lists, x, 0.0);
    for (int k = 0; k < 4; ++k) {
        x = stepped(x, 0.02, random);
        const double fraction = random.number(0.0, 1.0);
        if (k % 2 == 0) lists.advance(x, fraction, world.obstacles);
        if (k % 2 == 1) lists.cover({.from = x, .to = x, .fraction = {fraction, fraction}}, world.obstacles);
        worst = std::max(worst, excess(world, lists, x, fraction));
    }
    return worst;
}

}  // namespace

TEST_CASE("every pair that comes closer than the thickness while the cloth is in its boxes is in the lists") {
    const int number = GENERATE(0, 1, 2);
    const double obstacle_way = GENERATE(0.0, 0.2);
    Random random(200 + number);
    int near = 0, lacking = 0;
    for (int round = 0; round < 12; ++round) {
        World world(number, random);
        if (obstacle_way > 0.0) world.set_off(random, obstacle_way);
        CandidateLists lists = world.lists();
        const std::vector<Vec3> to = stepped(world.cloth.vertices, round % 2 == 0 ? 0.02 : 0.3, random);
        const double start = random.number(0.0, 0.5);
        lists.cover({.from = world.cloth.vertices, .to = to, .fraction = {start, 1.0}}, world.obstacles);
        const std::set<PairKey> listed = keys(lists, world);
        const std::vector<Box> boxes = allowed(lists, to.size());
        lacking += missing(world, world.cloth.vertices, start, listed, near);
        lacking += missing(world, to, 1.0, listed, near);
        for (int k = 0; k < 4; ++k) lacking += missing(world, anywhere(boxes, random), random.number(start, 1.0), listed, near);
    }
    CHECK(near > 1000);
    CHECK(lacking == 0);
}

TEST_CASE("the lists stay complete when only those of clusters that left their boxes are rebuilt") {
    Random random(220);
    int near = 0, lacking = 0;
    long built = 0;
    World world(2, random);
    CandidateLists lists = world.lists();
    std::vector<Vec3> x = world.cloth.vertices;
    for (int step = 0; step < 40; ++step) {
        std::vector<Vec3> to = x;
        to[random.index(16)] += random.point(0.1);
        built += lists_built(lists, world, x, to);
        x = to;
        lacking += missing(world, x, 1.0, keys(lists, world), near);
    }
    CHECK(built < 40 * long(lists.lists().size()));
    CHECK(near > 100);
    CHECK(lacking == 0);
}

TEST_CASE("reach less travel is never above the true distance on random walks, moving obstacles included, and stays useful") {
    const int number = GENERATE(0, 1, 2);
    const double obstacle_way = GENERATE(0.0, 0.1);
    Random random(240 + number);
    double worst = -1e300;
    for (int round = 0; round < 10; ++round) {
        World world(number, random);
        CandidateLists lists = world.lists();
        std::vector<Vec3> x = world.cloth.vertices;
        for (int step = 0; step < 3; ++step) {
            if (obstacle_way > 0.0) world.set_off(random, obstacle_way);
            worst = std::max(worst, walk_one_step(world, lists, x, random));
        }
    }
    CHECK(worst <= 1e-13);
    CHECK(worst > -1e-3);  // a pair measured just now has no slack
}

TEST_CASE("bounds of a listed pack only rise, and a persistent one wakes as soon as it comes within the thickness") {
    ListedPacks packs;
    packs.add(0, 7, 0.02, 0.005);
    CHECK(packs.reach[0] == Approx(0.02));
    CHECK(packs.wake[0] == Approx(0.015));
    packs.raise(0, 0.01, 0.03, 0.005, 0.004);  // no contact before a displacement of 0.03 m, though 0.01 m near
    CHECK(packs.reach[0] == Approx(0.02));
    CHECK(packs.wake[0] == Approx(0.034));
    packs.make_persistent(0, 3, 0.005);
    CHECK(packs.at[0].persistent == 8U);
    CHECK(packs.wake[0] == Approx(0.015));
    packs.raise(0, 0.03, 0.5, 0.005, 0.004);
    CHECK(packs.reach[0] == Approx(0.034));
    CHECK(packs.wake[0] == Approx(0.029));
    CHECK(static_cast<double>(packs.reach[0]) <= 0.034);
    CHECK(static_cast<double>(packs.wake[0]) <= 0.029);
}

TEST_CASE("cloth that stays in its boxes and obstacles that rest cost no list, any move out of them does") {
    Random random(260);
    World world(0, random);
    CandidateLists lists = world.lists();
    const std::vector<Vec3> x = world.cloth.vertices;
    const auto cover = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
        return lists_built(lists, world, from, to);
    };
    const long all = long(lists.lists().size());
    CHECK(cover(x, x) == all);
    CHECK(cover(x, x) == 0);
    CHECK(cover(x, stepped(x, 0.3 * thickness, random)) == 0);
    CHECK(cover(stepped(x, 0.3 * thickness, random), x) == 0);
    std::vector<Vec3> out = x;
    out[0].x() += 0.5;
    const long some = cover(x, out);
    CHECK(some >= 1);
    CHECK(some < all);
    world.set_off(random, 0.0);
    CHECK(cover(x, x) == all);
    CHECK(cover(x, x) == 0);
}

TEST_CASE("a pair is listed once, and obstacles that are far away are not listed at all") {
    Random random(270);
    World world(1, random);
    CandidateLists lists = world.lists();
    lists.cover({.from = world.cloth.vertices, .to = world.cloth.vertices, .fraction = {0.0, 0.0}}, world.obstacles);
    std::size_t count = 0;
    for (const ClusterList& list : lists.lists()) count += listed_pairs(list, world.obstacles).size();
    CHECK(count > 0);
    CHECK(keys(lists, world).size() == count);

    std::vector<Vec3> away = world.cloth.vertices;
    for (Vec3& p : away) p.y() += 50.0;
    lists.cover({.from = away, .to = away, .fraction = {0.0, 0.0}}, world.obstacles);
    CHECK(keys(lists, world).empty());
}

TEST_CASE("a move too long for its lists to fit is covered in part, and the clamp stays within that part") {
    const TriangleMesh sheet = make_grid(1.0, 1.0, 17, 17);
    std::vector<Vec3> from, to;
    for (const Vec3& p : sheet.vertices) {
        from.push_back(p + Vec3(0, 2, 0));
        to.push_back(p - Vec3(0, 2, 0));
    }
    const std::vector<double> thick(from.size(), 0.005);
    Obstacles obstacles;
    obstacles.push_back(std::make_unique<Obstacle>(make_sphere(0.4, 5), Pose{}, 0.0, make_brute_force_tree));
    CandidateLists lists(sheet.triangles, thick, from);
    const double share = lists.cover({.from = from, .to = to, .fraction = {0.0, 1.0}}, obstacles);
    CHECK(share < 1.0);
    CHECK(share > 0.0);
    std::size_t pairs = 0;
    for (const ClusterList& list : lists.lists()) pairs += listed_pairs(list, obstacles).size();
    CHECK(pairs < 5000000);

    const auto detector = make_brute_force_detector();
    detector->set_cloth(sheet.triangles, thick);
    detector->add_obstacle(make_sphere(0.4, 5), {}, 0.0);
    CHECK(detector->collision_free_step_size(from, to, {0.0, 1.0}) <= share);
}

TEST_CASE("a cluster's thickness is the largest of its vertices") {
    Random random(280);
    World world(0, random);
    world.thickness_of_vertex[0] = 3.0 * thickness;
    CandidateLists lists = world.lists();
    for (std::size_t i = 0; i < lists.lists().size(); ++i) {
        const auto& vertices = lists.clusters().clusters[i].all_vertices;
        const bool has_first = std::find(vertices.begin(), vertices.end(), 0) != vertices.end();
        CHECK(lists.lists()[i].thickness == (has_first ? 3.0 : 1.0) * thickness);
    }
}

}  // namespace percale::test::candidate_lists_test
