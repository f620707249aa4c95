#include "collision/bullet/bullet_tree.h"

#include "tests/support/catch.h"
#include "tests/support/collision/trees.h"

namespace percale::test::bullet_tree_test {

TEST_CASE("bullet: a tree finds every triangle whose box overlaps the queried one") { check_tree_laws(make_bullet_tree); }

TEST_CASE("bullet: triangles that no split separates are found like all others") { check_degenerate_trees(make_bullet_tree); }

TEST_CASE("bullet: rounding boxes outwards adds only a few triangles") {
    const TriangleMesh mesh = make_sphere(0.8, 4);
    const std::vector<Box> boxes = boxes_of(mesh), asked = asked_boxes(500, 13);
    IdLists found;
    make_bullet_tree(mesh.vertices, mesh.triangles)->find(asked, found);
    long apart = 0;
    for (int i = 0; i < 500; ++i) {
        for (int k = found.start[i]; k < found.start[i + 1]; ++k) apart += boxes[found.ids[k]].overlaps(asked[i]) ? 0 : 1;
    }
    CHECK(found.ids.size() > 1000);
    CHECK(apart < static_cast<long>(found.ids.size()) / 10);
}

TEST_CASE("bullet: boxes beside, around and far from the mesh are queried without harm") {
    // The tree's 16-bit coordinates end at the mesh: what lies beyond must be neither wrapped round nor lost.
    const TriangleMesh mesh = make_box({1, 1, 1});
    for (const double size : {1e-3, 1.0, 1e3}) {
        TriangleMesh scaled = mesh;
        for (Vec3& x : scaled.vertices) x *= size;
        std::vector<Box> asked(9);
        for (int i = 0; i < 9; ++i) {
            asked[i].add(size * Vec3(i - 4.0, 0.0, 0.0));
            asked[i].grow(0.51 * size);
        }
        CHECK(check_tree(make_bullet_tree, scaled, asked) > 0);
    }
}

}  // namespace percale::test::bullet_tree_test
