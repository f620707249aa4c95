#include "engine/substep/targets.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::targets_test {
namespace {

World sheet_world() {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {});
}

/// A sheet whose opposite corners are sewn together within four steps.
World sewn_world() {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.time_step = 0.1});
    Seam seam{.length = {}, .from = 0.0, .over = 0.4};
    append_seam(std::vector<Stitch>{{0, 8, 8}}, 50.0, world.state.cloth.positions, seam, world.scene.model);
    finish_model(world.scene.model);
    world.scene.script.seams = {seam};
    return world;
}

}  // namespace

TEST_CASE("Pins move along the straight line and arrive exactly") {
    World world = sheet_world();
    const Vec3 target(0.1, 0.7, 0.3), start = world.state.cloth.positions.at(5);
    world.scene.script.free[5] = 0.0;
    world.scene.script.pin_targets.set(5, target);
    const ClothState step_start = world.state.cloth;
    const Substep substep{world.scene, step_start.positions, {0.0, 1.0}};
    Vec3Arrays targets;
    for (const double fraction : {0.25, 0.5}) {
        set_targets(substep, fraction, targets);
        CHECK((targets.at(5) - (start + fraction * (target - start))).norm() < 1e-15);
    }
    set_targets(substep, 1.0, targets);
    CHECK(targets.at(5) == target);
}

TEST_CASE("Seams close during a substep, other springs keep their lengths, and the model keeps all of them") {
    World world = sewn_world();
    const std::vector<double> before = world.scene.model.springs.rest_length;
    plan_step(world);
    const Substep second_half{world.scene, world.state.cloth.positions, {0.5, 1.0}};
    std::vector<double> list;
    for (const double place : {0.0, 0.5, 1.0}) {
        const std::span<const double> lengths = rest_lengths_at(second_half, place, world.state, list);
        REQUIRE(lengths.size() == before.size());
        for (std::size_t k = 0; k + 1 < before.size(); ++k) CHECK(lengths[k] == before[k]);
        CHECK(lengths.back() == Approx(before.back() * (1.0 - (0.05 + 0.05 * place) / 0.4)));
    }
    CHECK(world.scene.model.springs.rest_length == before);
}

TEST_CASE("The work of a closing seam on cloth that stays is its stored energy") {
    World world = sewn_world();
    plan_step(world);
    const double shortened = 0.25 * world.scene.script.seams[0].length[0];
    const Substep substep{world.scene, world.state.cloth.positions, {0.0, 1.0}};
    CHECK(seam_work(substep, world.state, world.state.cloth) == Approx(0.5 * 50.0 * shortened * shortened));
}

}  // namespace percale::test::targets_test
