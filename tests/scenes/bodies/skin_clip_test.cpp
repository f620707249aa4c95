#include "bodies/skin_clip.h"

#include <cmath>
#include <numbers>

#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/collada_text.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::skin_clip_test {
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

/// A triangle on a node that goes by 3 m along x within 2 s, and one that stays, as Collada.
const std::string moving_node =
    collada(R"(<node id="n1"><translate sid="place">5 0 0</translate><instance_geometry url="#g"/></node>
<node id="n2"><instance_geometry url="#g"/></node>
)",
            R"(<library_animations><animation id="slide">
<source id="t"><float_array id="ta" count="2">0 2</float_array><technique_common>
<accessor source="#ta" count="2"><param name="TIME" type="float"/></accessor></technique_common></source>
<source id="o"><float_array id="oa" count="6">5 0 0 8 0 0</float_array><technique_common>
<accessor source="#oa" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/></sampler>
<channel source="#s" target="n1/place"/></animation></library_animations>
)");

}  // namespace

TEST_CASE("A clip of a Collada file moves a node and leaves another") {
    Bar given;
    given.folder.write("two.dae", moving_node);
    given.obstacle.mesh = "two.dae";
    given.obstacle.clip = "0";
    SkinClip clip(given.scene, given.obstacle);
    CHECK(clip.length() == Approx(2.0));
    for (const double time : {0.0, 0.5, 2.0}) {
        const Vec3 gone(5.0 + 1.5 * time, 0.0, 0.0);
        const std::vector<Vec3> expected = {gone, gone + Vec3(1, 0, 0), gone + Vec3(0, 1, 0), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        CHECK(farthest_apart(clip.at(time), expected) < 1e-6);
    }
}

TEST_CASE("Vertices at one place that a clip moves apart stay two, and those that it keeps together are one") {
    Bar given;
    CHECK(SkinClip(given.scene, given.obstacle).mesh().vertices.size() == 12);
    // The same bar once more, without a skin: it stays straight when the first bends, but for the ring about the root.
    std::string text = given.folder.read("bar.gltf");
    const auto replace = [&](const std::string& before, const std::string& after) {
        REQUIRE(text.find(before) != std::string::npos);
        text.replace(text.find(before), before.size(), after);
    };
    replace("\"nodes\":[0,1]", "\"nodes\":[0,1,3]");
    replace("{\"name\":\"joint\",\"translation\":[0,1,0]}",
            "{\"name\":\"joint\",\"translation\":[0,1,0]},{\"name\":\"stiff\",\"mesh\":1}");
    replace("\"targets\":[{\"POSITION\":4}]}]}",
            "\"targets\":[{\"POSITION\":4}]}]},{\"name\":\"stiff\",\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":"
            "3}]}");
    given.folder.write("bar.gltf", text);
    SkinClip two(given.scene, given.obstacle);
    CHECK(two.mesh().triangles.size() == 2 * given.bar.triangles.size());
    CHECK(two.mesh().vertices.size() == 20);
}

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

}  // namespace percale::scenes::test::skin_clip_test
