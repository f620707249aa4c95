#include "scenes/drape/drape_run.h"

#include "scenes/drape/drape_verdict.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/drape/open_seam.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::drape_run_test {
namespace {

DrapeOptions sheet_and_block(const TestFolder& folder) {
    TriangleMesh sheet = make_grid(0.2, 0.2, 9, 9), block = make_box(Vec3(0.1, 0.2, 0.1));
    for (Vec3& x : sheet.vertices) x += Vec3(0.0, 0.12, 0.0);
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("block.obj"), block.vertices, block.triangles);
    DrapeOptions options;
    options.files = {folder.path("sheet.obj"), folder.path("block.obj")};
    options.outs = {folder.path("out.obj")};
    options.friction = 0.8;
    return options;
}

}  // namespace

TEST_CASE("a drape ends at rest, when it is stopped, and when all has fallen below the body") {
    const TestFolder folder;
    DrapeOptions options = sheet_and_block(folder);
    BuiltScene resting = build_scene(drape_scene(options).scene);
    const Drape rest = settle(resting, options, [](double) { return false; });
    CHECK(rest.end == DrapeEnd::settled);
    CHECK(rest.met);
    CHECK(rest.height[0] == Approx(0.12));
    CHECK(mean_height(resting.simulation, resting.cloths[0]) < 0.11);

    BuiltScene stopped = build_scene(drape_scene(options).scene);
    CHECK(settle(stopped, options, [](double time) { return time > 0.09; }).end == DrapeEnd::stopped);
    CHECK(stopped.simulation.time() == Approx(0.1));

    options.move = {2.0, 0.0, 0.0};
    BuiltScene falling = build_scene(drape_scene(options).scene);
    const Drape fell = settle(falling, options, [](double) { return false; });
    CHECK(fell.end == DrapeEnd::fell);
    CHECK_FALSE(fell.met);
    CHECK(falling.simulation.time() < 0.4);
    CHECK(verdict_of(falling, options, fell, write_draped(falling, options, false)).wrong.find("never met the body") !=
          std::string::npos);
}

TEST_CASE("a garment that cannot be sewn is given up a second after its seams should have closed, if it is tried again") {
    const TestFolder folder;
    write_open_seam(folder, "side");
    DrapeOptions options;
    options.files = {folder.path("strips.toml"), folder.path("plate.obj")};
    options.outs = {folder.path("out.obj")};
    options.sewing_time = 0.3;
    options.seconds = 1.5;
    const auto go_on = [](double) { return false; };
    BuiltScene tried = build_scene(drape_scene(options).scene);
    const Drape given_up = settle(tried, options, go_on, true);
    CHECK(given_up.end == DrapeEnd::unsewn);
    CHECK(given_up.failure.find("not sewn: seam 'side' of 'strips' is open by ") == 0);
    CHECK(tried.simulation.time() == Approx(1.3).margin(0.02));
    BuiltScene last = build_scene(drape_scene(options).scene);
    CHECK(settle(last, options, go_on).end == DrapeEnd::time_up);
    CHECK(last.simulation.time() == Approx(1.5).margin(0.02));
}

TEST_CASE("sewing times leave time to settle, the first is what the options say") {
    DrapeOptions options;
    options.files = {"a.toml", "b.toml", "body.obj"};
    CHECK(sewing_times(options) == std::vector<double>{1.0, 2.0, 0.6});
    options.seconds = 3.0;
    CHECK(sewing_times(options) == std::vector<double>{1.0, 0.6});
}

}  // namespace percale::scenes::test::drape_run_test
