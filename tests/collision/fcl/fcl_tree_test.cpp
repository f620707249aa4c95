#include "collision/fcl/fcl_tree.h"

#include "tests/support/catch.h"
#include "tests/support/collision/trees.h"

namespace percale::test::fcl_tree_test {

TEST_CASE("fcl: a tree finds every triangle whose box overlaps the queried one") { check_tree_laws(make_fcl_tree); }

TEST_CASE("fcl: triangles that no split separates are found like all others") { check_degenerate_trees(make_fcl_tree); }

TEST_CASE("fcl: a tree finds no triangle whose box lies apart") {
    const TriangleMesh mesh = soup(1000, 12);
    const std::vector<Box> boxes = boxes_of(mesh), asked = asked_boxes(300, 13);
    IdLists found;
    make_fcl_tree(mesh.vertices, mesh.triangles)->find(asked, found);
    long apart = 0;
    for (int i = 0; i < 300; ++i) {
        for (int k = found.start[i]; k < found.start[i + 1]; ++k) apart += boxes[found.ids[k]].overlaps(asked[i]) ? 0 : 1;
    }
    CHECK(apart == 0);
    CHECK(found.ids.size() > 1000);
}

}  // namespace percale::test::fcl_tree_test
