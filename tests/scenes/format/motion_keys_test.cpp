#include "format/motion_keys.h"

#include "format/scene_file.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::motion_keys_test {
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
    const auto written = bend_fields()[0].write(scene.obstacles[0]);
    REQUIRE(written);
    REQUIRE(written->items.size() == 2);
    CHECK(written->items[1].integer == 40);
}

TEST_CASE("A cache, a clip and when they are played are read, and written only where they are said") {
    const Scene scene =
        scene_with("mesh = \"a.glb\"\nclip = \"walk\"\nlead_in = 0.5\nplay_from = 1.0\nplay_offset = 0.25\nloop = true\n");
    const ObstacleSpec& body = scene.obstacles[0];
    CHECK(body.clip == "walk");
    CHECK(body.bends());
    CHECK((body.lead_in == 0.5 && body.play_from == 1.0 && body.play_offset == 0.25 && body.loop));
    CHECK(scene_with("mesh = \"a.obj\"\ncache = \"a.pc2\"\nstart_mesh = \"b.obj\"\n").obstacles[0].cache == "a.pc2");
    const ObstacleSpec still = scene_with("mesh = \"a.obj\"\n").obstacles[0];
    CHECK_FALSE(still.bends());
    for (const Field<ObstacleSpec>& field : bend_fields()) {
        CAPTURE(field.key.path);
        const bool optional = field.key.path == "frames" || field.key.path == "cache" || field.key.path == "clip";
        if (optional) CHECK_FALSE(field.write(still));
    }
}

TEST_CASE("What happens on a pinch is one of two words, and stop if nothing is said") {
    CHECK_FALSE(scene_with("mesh = \"a.obj\"\n").obstacles[0].yields);
    const Scene yields = scene_with("shape = { sphere = { radius = 1.0 } }\non_pinch = \"yield\"\n");
    CHECK(yields.obstacles[0].yields);
    CHECK(pinch_field().write(yields.obstacles[0])->text == "yield");
    CHECK(message_of([] { scene_with("mesh = \"a.obj\"\non_pinch = \"yeild\"\n"); }).find("stop, yield") != std::string::npos);
}

TEST_CASE("Frames of a shape, frames below 0 and no frames a second are refused") {
    CHECK(message_of([] { scene_with("shape = { sphere = { radius = 1.0 } }\nframes = [0, 1]\n"); }).find("mesh") !=
          std::string::npos);
    CHECK(message_of([] { scene_with("mesh = \"%d.obj\"\nframes = [-1, 1]\n"); }).find("frames") != std::string::npos);
    CHECK(message_of([] { scene_with("mesh = \"%d.obj\"\nframes = [0, 1]\nfps = 0.0\n"); }).find("fps") != std::string::npos);
}

}  // namespace percale::scenes::test::motion_keys_test
