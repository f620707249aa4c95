#include "scenes/drape/drape_run.h"

#include "scenes/drape/drape_verdict.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test {
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

}  // namespace percale::scenes::test
