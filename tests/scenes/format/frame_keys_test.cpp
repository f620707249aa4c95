#include "format/frame_keys.h"

#include "format/scene_file.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

using namespace percale::scenes;
using namespace percale::scenes::test;

namespace {

Scene scene_with(const std::string& keys) {
    return parse_scene(falling_sheet() + "[[obstacle]]\nname = \"body\"\n" + keys, "test.toml", {});
}

}  // namespace

TEST_CASE("Frames and their rate are read, and written back as they were") {
    const Scene scene = scene_with("mesh = \"walk/%04d.obj\"\nframes = [3, 40]\nfps = 25.0\n");
    CHECK(scene.obstacles[0].frames == std::array{3, 40});
    CHECK(scene.obstacles[0].fps == 25.0);
    CHECK_FALSE(scene_with("mesh = \"body.obj\"\n").obstacles[0].frames);
    const auto written = frames_field().write(scene.obstacles[0]);
    REQUIRE(written);
    REQUIRE(written->items.size() == 2);
    CHECK(written->items[1].integer == 40);
}

TEST_CASE("Frames of a shape, frames below 0 and no frames a second are refused") {
    CHECK(message_of([] { scene_with("shape = { sphere = { radius = 1.0 } }\nframes = [0, 1]\n"); }).find("mesh") !=
          std::string::npos);
    CHECK(message_of([] { scene_with("mesh = \"%d.obj\"\nframes = [-1, 1]\n"); }).find("frames") != std::string::npos);
    CHECK(message_of([] { scene_with("mesh = \"%d.obj\"\nframes = [0, 1]\nfps = 0.0\n"); }).find("fps") != std::string::npos);
}
