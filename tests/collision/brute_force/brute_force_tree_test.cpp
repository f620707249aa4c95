#include "collision/brute_force/brute_force_tree.h"

#include "tests/support/catch.h"
#include "tests/support/collision/trees.h"

namespace percale::test::brute_force_tree_test {

TEST_CASE("brute_force: a tree finds every triangle whose box overlaps the queried one") {
    check_tree_laws(make_brute_force_tree);
}

TEST_CASE("brute_force: triangles that no split separates are found like all others") {
    check_degenerate_trees(make_brute_force_tree);
}

TEST_CASE("brute_force: what only touches a box is found, in ascending order") {
    const TriangleMesh plane = make_plane(1.0);
    Box above;
    above.add({-2, 0.0, -2});
    above.add({2, 1.0, 2});
    Box over = above;
    over.low.y() = 1e-300;
    IdLists found;
    make_brute_force_tree(plane.vertices, plane.triangles)->find(std::vector<Box>{above, over, above}, found);
    CHECK(found.start == std::vector<int>{0, 2, 2, 4});
    CHECK(found.ids == std::vector<int>{0, 1, 0, 1});
}

}  // namespace percale::test::brute_force_tree_test
