#include "bodies/skin_clip.h"

#include <cmath>
#include <numbers>

#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;
using namespace percale::scenes::test;

namespace {

struct Bar {
    TestFolder folder;
    BendingBar bar;
    Scene scene;
    ObstacleSpec obstacle;

    Bar() {
        scene.file = folder.path("scene.toml");
        bar.write_gltf(folder);
        obstacle.name = "bar";
        obstacle.mesh = "bar.gltf";
        obstacle.clip = "bend";
    }

    std::string refusal(const std::string& clip) const {
        ObstacleSpec other = obstacle;
        other.clip = clip;
        return message_of([&] { SkinClip(scene, other); });
    }
};

}  // namespace

TEST_CASE("A clip bends a skin by its joints: each vertex is the mean, by weights, of where its joints take it") {
    const Bar given;
    SkinClip clip(given.scene, given.obstacle);
    CHECK(clip.length() == Approx(2.0));
    CHECK(clip.text() == "clip 'bend' of 2 s");
    CHECK(clip.mesh().triangles == given.bar.triangles);
    CHECK(farthest_apart(clip.mesh().vertices, given.bar.vertices) < 1e-6);
    for (const double time : {0.0, 0.3, 0.5, 1.0, 1.6, 2.0}) {
        const double angle = 0.5 * std::numbers::pi * (time < 1.0 ? time : 2.0 - time);
        CHECK(farthest_apart(clip.at(time), given.bar.shape(angle, 0.0)) < 1e-6);
    }
    CHECK(clip.at(-1.0) == clip.at(0.0));
    CHECK(clip.at(7.0) == clip.at(2.0));
}

TEST_CASE("A clip mixes morph targets in, is found by its number, and is scaled by the unit") {
    Bar given;
    given.obstacle.clip = "1";
    given.obstacle.unit = 0.01;
    SkinClip clip(given.scene, given.obstacle);
    CHECK(clip.length() == Approx(0.5));
    for (const double time : {0.0, 0.1, 0.5}) {
        std::vector<Vec3> shape = given.bar.shape(0.0, 2.0 * time);
        for (Vec3& x : shape) x *= 0.01;
        CHECK(farthest_apart(clip.at(time), shape) < 1e-8);
    }
}

TEST_CASE("Clips that there are not are refused with those that there are, and so are files without clips") {
    Bar given;
    CHECK(given.refusal("bent").find("did you mean 'bend'? valid: bend, 1") != std::string::npos);
    CHECK(given.refusal("2").find("has no clip '2'") != std::string::npos);
    given.obstacle.fps = 25.0;
    CHECK(given.refusal("bend").find("has its own times") != std::string::npos);
    given.obstacle.fps.reset();
    given.obstacle.mesh = "bar.obj";
    CHECK(given.refusal("bend").find(".glb") != std::string::npos);
    given.obstacle.mesh = "none.glb";
    CHECK(given.refusal("bend").find("no such file") != std::string::npos);
}
