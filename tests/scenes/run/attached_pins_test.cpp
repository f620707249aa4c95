#include "scenes/run/attached_pins.h"

#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/obstacle_motion.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;

namespace {

/// A flag whose first column is held by a turned, scaled ball that moves and spins.
Scene held_by_ball(const std::string& to = "ball") {
    return parse_scene(small_scene() + "pin = { box = [[0, 0, 0], [0, 1, 1]], to = \"" + to +
                           "\" }\n[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n"
                           "pose = { translation = [3, 1, 2], rotation = [0.6, 0, 0.8, 0], scale = 2 }\n"
                           "motion = [ { time = 0.5, translation = [3, 1, 2] }, { time = 1, translation = [4, 1, 2] } ]\n"
                           "spin = { axis = [0, 1, 0], turns_per_s = 0.25 }\n",
                       "t");
}

}  // namespace

TEST_CASE("a pin on an obstacle starts where its vertex is and then keeps its distance from the obstacle's points") {
    const Scene scene = held_by_ball();
    const BuiltScene built = build_scene(scene);
    const std::vector<AttachedPin> pins = attached_pins(scene, built.cloth_meshes);
    REQUIRE(pins.size() == 4);
    for (const AttachedPin& pin : pins) {
        const Vec3& start = built.cloth_meshes[0].vertices[static_cast<std::size_t>(pin.vertex)];
        CHECK((place_at(pin, scene, 0.0) - start).norm() < 1e-14);
        CHECK(pin.vertex % 5 == 0);
        // A quarter of a turn about the vertical through the ball's middle, and 1 m along x.
        const Vec3 arm = start - Vec3(3, 1, 2), turned(arm.z(), arm.y(), -arm.x());
        CHECK((place_at(pin, scene, 1.0) - (Vec3(4, 1, 2) + turned)).norm() < 1e-12);
    }
}

TEST_CASE("pins in the world are not attached, and an obstacle that there is not is refused with the nearest") {
    CHECK(attached_pins(parse_scene(small_scene() + "pin = [0, 1]\n", "t"), {}).empty());
    CHECK(error_of([] { build_scene(held_by_ball("bal")); }) ==
          "t:8:15: pin.to: no obstacle 'bal'; did you mean 'ball'? valid: ball");
    Scene bending = held_by_ball();
    const BuiltScene built = build_scene(bending);
    bending.obstacles[0].frames = std::array{0, 1};
    CHECK(error_of([&] { attached_pins(bending, built.cloth_meshes); }).find("'ball' changes its shape") != std::string::npos);
}
