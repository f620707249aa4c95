#include "collision/self/cluster_tree.h"

#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::test::cluster_tree_test {
namespace {

std::vector<Box> random_boxes(int count, Random& random) {
    std::vector<Box> boxes(static_cast<std::size_t>(count));
    for (Box& box : boxes) {
        box.add(random.point(1.0));
        box.grow(random.decades(1e-3, 0.5));
    }
    return boxes;
}

std::vector<std::pair<int, int>> all_pairs(const std::vector<Box>& boxes) {
    std::vector<std::pair<int, int>> pairs;
    for (int a = 0; a < static_cast<int>(boxes.size()); ++a) {
        for (int b = a; b < static_cast<int>(boxes.size()); ++b) {
            if (boxes[a].overlaps(boxes[b])) pairs.emplace_back(a, b);
        }
    }
    return pairs;
}

}  // namespace

TEST_CASE("a cluster tree finds exactly the pairs of overlapping boxes, in order, also after it was refitted") {
    Random random(3);
    ClusterTree tree;
    std::vector<std::pair<int, int>> found{{7, 7}};
    for (const int count : {0, 1, 2, 3, 7, 8, 9, 100, 33}) {
        for (int round = 0; round < 3; ++round) {
            const std::vector<Box> boxes = random_boxes(count, random);
            tree.refit(boxes);
            tree.find_pairs(found);
            CHECK(found == all_pairs(boxes));
        }
    }
}

TEST_CASE("boxes of a cluster tree that only touch are a pair") {
    std::vector<Box> boxes(2);
    boxes[0].add(Vec3(0, 0, 0));
    boxes[0].add(Vec3(1, 1, 1));
    boxes[1].add(Vec3(1, 0, 0));
    boxes[1].add(Vec3(2, 1, 1));
    ClusterTree tree;
    std::vector<std::pair<int, int>> found;
    tree.refit(boxes);
    tree.find_pairs(found);
    CHECK(found == std::vector<std::pair<int, int>>{{0, 0}, {0, 1}, {1, 1}});
}

}  // namespace percale::test::cluster_tree_test
