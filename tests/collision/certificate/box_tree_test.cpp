#include "certificate/box_tree.h"

#include <random>
#include <set>

#include "tests/support/catch.h"

namespace percale::test::box_tree_test {
using namespace percale::certificate;
using certificate::Box;  // not that of the search

namespace {

class Boxes {
public:
    explicit Boxes(unsigned seed) : random_(seed) {}

    Vec3 point(double size) {
        std::uniform_real_distribution<double> number(-size, size);
        return {number(random_), number(random_), number(random_)};
    }

    std::vector<Box> make(int count, double extent) {
        std::vector<Box> boxes(count);
        for (Box& box : boxes) {
            const Vec3 corner = point(1.0);
            box.add(corner);
            box.add(corner + point(extent));
        }
        return boxes;
    }

private:
    std::mt19937 random_;
};

std::set<std::pair<int, int>> overlapping(const std::vector<Box>& a, const std::vector<Box>& b) {
    std::set<std::pair<int, int>> pairs;
    for (int i = 0; i < int(a.size()); ++i) {
        for (int j = 0; j < int(b.size()); ++j) {
            if (overlap(a[i], b[j])) pairs.insert({i, j});
        }
    }
    return pairs;
}

}  // namespace

TEST_CASE("box distance is the length of the gap vector and 0 for boxes that share a point") {
    const Box unit{Vec3{0, 0, 0}, Vec3{1, 1, 1}};
    CHECK(distance(unit, {Vec3{4, 5, 0.5}, Vec3{6, 6, 0.6}}) == 5.0);
    CHECK(distance({Vec3{4, 5, 0.5}, Vec3{6, 6, 0.6}}, unit) == 5.0);
    CHECK(distance(unit, {Vec3{1, 1, 1}, Vec3{2, 2, 2}}) == 0.0);
    CHECK(overlap(unit, {Vec3{1, 1, 1}, Vec3{2, 2, 2}}));
    CHECK_FALSE(overlap(unit, {Vec3{1, 1, std::nextafter(1.0, 2.0)}, Vec3{2, 2, 2}}));
    CHECK_FALSE(overlap(unit, Box{}));
}

TEST_CASE("the pairs of overlapping boxes are those of brute force, each once") {
    const int count = GENERATE(0, 1, 3, 4, 5, 60, 700);
    const double extent = GENERATE(0.0, 0.1, 1.0);
    Boxes source(count + 1);
    const std::vector<Box> a = source.make(count, extent), b = source.make(137, extent);
    std::set<std::pair<int, int>> found;
    int visits = 0;
    BoxTree(a).walk_overlaps(BoxTree(b), [&](int i, int j) { found.insert({i, j}), ++visits; });
    CHECK(found == overlapping(a, b));
    CHECK(visits == int(found.size()));
}

TEST_CASE("boxes at one place or of very uneven spacing give a tree that still finds all pairs") {
    std::vector<Box> same(500, Box{Vec3{1, 2, 3}, Vec3{1, 2, 3}}), uneven;
    for (int i = 0; i < 900; ++i) {
        const double x = std::ldexp(1.0, -i);
        uneven.push_back({Vec3{x, 0, 0}, Vec3{x, 0, 0}});
    }
    int visits = 0;
    BoxTree(same).walk_overlaps(BoxTree(same), [&](int, int) { ++visits; });
    CHECK(visits == 500 * 500);
    std::set<std::pair<int, int>> found;
    BoxTree(uneven).walk_overlaps(BoxTree(uneven), [&](int i, int j) { found.insert({i, j}); });
    CHECK(found == overlapping(uneven, uneven));
}

TEST_CASE("a walk visits every item whose box passes and skips branches that do not") {
    Boxes source(5);
    const std::vector<Box> boxes = source.make(2000, 0.05);
    const BoxTree tree(boxes);
    const Box window{Vec3{0, 0, 0}, Vec3{0.2, 0.2, 0.2}};
    std::set<int> found;
    int opened = 0;
    tree.walk([&](const Box& box) { return ++opened, overlap(box, window); }, [&](int item) { found.insert(item); });
    for (int i = 0; i < 2000; ++i) {
        if (overlap(boxes[i], window) && found.count(i) == 0) FAIL("item " << i << " missed");
    }
    CHECK(found.size() < 400);
    CHECK(opened < 400);
}

TEST_CASE("the nearest box is that of brute force, and nothing is found beyond the limit") {
    Boxes source(9);
    const std::vector<Box> boxes = source.make(800, 0.02);
    const BoxTree tree(boxes);
    for (int trial = 0; trial < 200; ++trial) {
        Box here;
        here.add(source.point(2.0));
        double expected = std::numeric_limits<double>::infinity();
        for (const Box& box : boxes) expected = std::min(expected, distance(here, box));
        int measured = 0;
        const auto to_box = [&](const Box& box) { return distance(here, box); };
        const auto to_item = [&](int item) { return ++measured, distance(here, boxes[item]); };
        const auto [item, value] = tree.nearest(std::numeric_limits<double>::infinity(), to_box, to_item);
        REQUIRE(item >= 0);
        CHECK(value == expected);
        CHECK(distance(here, boxes[item]) == expected);
        CHECK(measured < 300);
        CHECK(tree.nearest(expected, to_box, to_item).second == expected);
        if (expected > 0.0) CHECK(tree.nearest(0.99 * expected, to_box, to_item).first == -1);
    }
}

TEST_CASE("the nearest pair is that of brute force, up to the limit") {
    const double extent = GENERATE(0.001, 0.02);
    Boxes source(13);
    const std::vector<Box> a = source.make(300, extent), b = source.make(200, extent);
    double expected = std::numeric_limits<double>::infinity();
    for (const Box& x : a) {
        for (const Box& y : b) expected = std::min(expected, distance(x, y));
    }
    const BoxTree tree_a(a), tree_b(b);
    int measured = 0;
    const auto pair_distance = [&](int i, int j, double) { return ++measured, distance(a[i], b[j]); };
    CHECK(tree_a.nearest_pair(tree_b, std::numeric_limits<double>::infinity(), pair_distance) == expected);
    CHECK(tree_b.nearest_pair(tree_a, expected, [&](int j, int i, double) { return distance(a[i], b[j]); }) == expected);
    CHECK(measured < 6000);
    if (expected == 0.0) return;
    measured = 0;
    CHECK(tree_a.nearest_pair(tree_b, 0.999 * expected, pair_distance) == std::numeric_limits<double>::infinity());
    CHECK(measured == 0);
}

TEST_CASE("an empty tree has no items, no bounds and no nearest") {
    const BoxTree empty{std::span<const Box>{}};
    Boxes source(3);
    const std::vector<Box> boxes = source.make(10, 1.0);
    const auto distance_of_pair = [](int, int, double) { return 0.0; };
    CHECK(empty.nearest_pair(BoxTree(boxes), 1.0, distance_of_pair) == std::numeric_limits<double>::infinity());
    CHECK(BoxTree(boxes).nearest_pair(empty, 1.0, distance_of_pair) == std::numeric_limits<double>::infinity());
    CHECK(empty
              .nearest(
                  1.0, [](const Box&) { return 0.0; }, [](int) { return 0.0; })
              .first == -1);
    CHECK_FALSE(empty.bounds().contains(Vec3::Zero()));
}

}  // namespace percale::test::box_tree_test
