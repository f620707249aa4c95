#include "scenes/run/attached_pins.h"

#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/obstacle_motion.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::attached_pins_test {
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
    const std::vector<AttachedPin> pins = attached_pins(scene, built.cloth_meshes, built.obstacle_meshes);
    REQUIRE(pins.size() == 4);
    for (const AttachedPin& pin : pins) {
        const Vec3& start = built.cloth_meshes[0].vertices[static_cast<std::size_t>(pin.vertex)];
        CHECK((place_at(pin, scene, {}, 0.0) - start).norm() < 1e-14);
        CHECK(pin.vertex % 5 == 0);
        // A quarter of a turn about the vertical through the ball's middle, and 1 m along x.
        const Vec3 arm = start - Vec3(3, 1, 2), turned(arm.z(), arm.y(), -arm.x());
        CHECK((place_at(pin, scene, {}, 1.0) - (Vec3(4, 1, 2) + turned)).norm() < 1e-12);
    }
}

TEST_CASE("pins in the world are not attached, and an obstacle that there is not is refused with the nearest") {
    CHECK(attached_pins(parse_scene(small_scene() + "pin = [0, 1]\n", "t"), {}, {}).empty());
    CHECK(error_of([] { build_scene(held_by_ball("bal")); }) ==
          "t:8:15: pin.to: no obstacle 'bal'; did you mean 'ball'? valid: ball");
}

TEST_CASE("a pin on an obstacle that bends goes along with its nearest triangle, and with the pose on top") {
    Scene scene = held_by_ball();
    const BuiltScene built = build_scene(scene);
    scene.obstacles[0].frames = std::array{0, 1};
    std::vector<Vec3> swollen = built.obstacle_meshes[0].vertices;
    for (Vec3& x : swollen) x *= 1.5;
    for (const AttachedPin& pin : attached_pins(scene, built.cloth_meshes, built.obstacle_meshes)) {
        const Vec3& start = built.cloth_meshes[0].vertices[static_cast<std::size_t>(pin.vertex)];
        CHECK((place_at(pin, scene, built.obstacle_meshes[0].vertices, 0.0) - start).norm() < 1e-14);
        // The ball, 0.2 m in radius where it stands, swells by half: a place beside it is pushed off by 0.1 m.
        const Vec3 middle(3, 1, 2), out = (start - middle).normalized();
        CHECK((place_at(pin, scene, swollen, 0.0) - (start + 0.1 * out)).norm() < 0.01);
    }
}

}  // namespace percale::scenes::test::attached_pins_test
