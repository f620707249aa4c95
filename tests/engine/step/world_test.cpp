#include "engine/step/world.h"

#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::world_test {
namespace {

World sheet_world(const StepSettings& settings) {
    const TriangleMesh grid = make_grid(0.5, 0.5, 4, 4);
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, settings);
}

}  // namespace

TEST_CASE("There are as many threads as requested, with auto as many as pay and the machine has") {
    World world = sheet_world({.threads = 3});
    set_workers(world);
    REQUIRE(world.workers);
    CHECK(world.workers->threads() == 3);
    CHECK(world.scene.compute.workers == world.workers.get());
    CHECK(world.scene.compute.threads() == 3);
    world.scene.settings.threads = 1;
    set_workers(world);
    CHECK(world.workers == nullptr);
    CHECK(world.scene.compute.threads() == 1);
    REQUIRE(world.scene.model.vertex_count() < 2 * min_vertices_a_thread);
    world.scene.settings.threads = 0;
    set_workers(world);
    CHECK(world.workers == nullptr);
}

TEST_CASE("Given workers are kept, whatever the settings are") {
    World world = sheet_world({.threads = 5});
    world.own_workers = false;
    world.workers = make_workers(2);
    set_workers(world);
    CHECK(world.scene.compute.threads() == 2);
}

TEST_CASE("Schemes without contact are refused where the scene has some") {
    World world = sheet_world({.scheme = Scheme::rk4});
    CHECK_NOTHROW(check_scheme(world.scene));
    world.scene.model.cloths[0].fabric.self_contact = true;
    CHECK(meets_cloth(world.scene));
    CHECK(mentions(scene_error([&] { check_scheme(world.scene); }), {"explicit", "self_contact"}));
    world.scene.settings = {.scheme = Scheme::tr_bdf2, .contact_response = ContactResponse::projection};
    CHECK(mentions(scene_error([&] { check_scheme(world.scene); }), {"projection", "tr_bdf2"}));
}

}  // namespace percale::test::world_test
