#include "engine/step/sewing.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::step_sewing_test {

TEST_CASE("A stitch joins a vertex to itself at either end of its edge, or where both ends are that vertex") {
    CHECK(joins_itself({3, 3, 3}));
    CHECK(joins_itself({3, 3, 4, 0.5}));
    CHECK(joins_itself({3, 4, 3, 0.5}));
    CHECK(joins_itself({3, 4, 3, 1.0}));
    CHECK_FALSE(joins_itself({3, 4, 3, 0.0}));
    CHECK_FALSE(joins_itself({3, 4, 5, 0.5}));
}

TEST_CASE("Rest lengths of new springs are added to a state that has its own, and to no other") {
    SpringNetwork network;
    for (int k = 0; k < 3; ++k) {
        append_pair(k, k + 1, network);
        network.rest_length.back() = k + 1.0;
    }
    std::vector<double> none, own = {7.0};
    add_rest_lengths(network, none);
    add_rest_lengths(network, own);
    CHECK(none.empty());
    CHECK(own == std::vector{7.0, 2.0, 3.0});
}

TEST_CASE("A seam that is sewn gets the next number, begins now and makes the plan outdated") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {});
    world.state.time = 2.0;
    world.plan_outdated = false;
    const int springs = world.scene.model.springs.size();
    CHECK(sew(world, std::vector<Stitch>{{0, 8, 8}}, {.over = 0.5}) == 0);
    CHECK(sew(world, std::vector<Stitch>{{0, 4, 5, 0.5}}, {.over = 0.5}) == 1);
    CHECK(world.scene.script.seams[1].from == 2.0);
    CHECK(world.scene.model.springs.size() == springs + 4);
    CHECK(world.scene.model.adjacency.place.size() == static_cast<std::size_t>(springs) + 4);
    CHECK(world.plan_outdated);
}

TEST_CASE("Welds of closed seams tighten at the beginning of a step, those of others wait, and a failed step restores them") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {});
    sew(world, std::vector<Stitch>{{0, 8, 8}}, {.over = 0.0, .stiffness = 3.0, .weld = true});
    sew(world, std::vector<Stitch>{{2, 6, 6}}, {.over = 9.0, .weld = true});
    world.rest.potential = 1.0;
    const double work = tighten_holds(world), gap = std::sqrt(2.0);
    const Vec3 held = world.scene.model.welds[0].hold;
    CHECK(held.norm() == Approx(3.0 * 0.01));  // bounded
    CHECK(work == Approx(0.03 * gap));
    CHECK(*world.rest.potential == Approx(1.0 + work));
    CHECK(world.scene.model.welds[1].hold == Vec3::Zero());
    world.state.cloth.positions.set(0, {3.0, 0.0, 0.0});
    tighten_holds(world);
    CHECK((world.scene.model.welds[0].hold - held).norm() > 1e-3);
    loosen_holds(world);
    CHECK(world.scene.model.welds[0].hold == held);
}

}  // namespace percale::test::step_sewing_test
