#include "scenes/models/model.h"

#include "percale/error.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::model_test {
namespace {

Model good() {
    Model model;
    model.nodes.push_back({.name = "root", .parent = -1, .transform = Eigen::Matrix4d::Identity(), .parts = {}});
    model.nodes.push_back({.name = "leaf", .parent = 0, .transform = 2.0 * Eigen::Matrix4d::Identity(), .parts = {{0, 0}}});
    model.meshes.push_back({.name = "mesh",
                            .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}},
                            .corners = {0, 1, 2},
                            .face_sizes = {3},
                            .shares = {{2, 1, 0.5}},
                            .targets = {{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, 0.25}}});
    model.skins.push_back({{0, 1}, {Eigen::Matrix4d::Identity(), 3.0 * Eigen::Matrix4d::Identity()}});
    const ModelTrack track{.interpolation = Interpolation::step, .times = {0.0, 1.0}, .values = {{1, 2, 3, 0}, {4, 5, 6, 0}}};
    model.clips.push_back(
        {.name = "",
         .ticks_per_s = 24.0,
         .channels = {{.node = 1, .translation = track, .rotation = {}, .scale = {}}},
         .morphs = {{.nodes = {1}, .interpolation = Interpolation::linear, .times = {0.5}, .weights = {{0.75}}}}});
    return model;
}

std::string fault_of(const std::function<void(Model&)>& change) {
    Model model = good();
    change(model);
    return message_of([&] { check_model(model, "f"); });
}

}  // namespace

TEST_CASE("A model of which all numbers lead somewhere is good, and comes back from its bytes with every bit") {
    const Model model = good();
    CHECK(fault_of([](Model&) {}).empty());
    const std::vector<std::byte> bytes = bytes_of(model);
    const Model back = model_of(bytes);
    CHECK(bytes_of(back) == bytes);
    CHECK(back.nodes[1].transform == model.nodes[1].transform);
    CHECK(back.skins[0].offsets[1] == model.skins[0].offsets[1]);
    CHECK(back.clips[0].channels[0].translation.values == model.clips[0].channels[0].translation.values);
    CHECK(clip_names(back) == std::vector<std::string>{"0"});
    for (std::size_t cut = 0; cut < bytes.size(); ++cut) CHECK_THROWS_AS(model_of(std::span(bytes).first(cut)), SceneError);
}

TEST_CASE("A number that leads nowhere is refused, with the range that there is") {
    CHECK(fault_of([](Model& m) { m.meshes[0].corners[1] = 3; }) == "f: face 0: vertex index 3 is out of range 0 ... 2");
    CHECK(fault_of([](Model& m) { m.meshes[0].corners[1] = -1; }).starts_with("f: face 0: vertex index 4294967295 is out"));
    CHECK(fault_of([](Model& m) { m.meshes[0].face_sizes[0] = 4; }) == "f: mesh 'mesh': its faces are not whole");
    CHECK(fault_of([](Model& m) { m.meshes[0].face_sizes = {4, -1}; }) == "f: mesh 'mesh': its faces are not whole");
    CHECK(fault_of([](Model& m) { m.meshes[0].shares[0].vertex = 3; }) == "f: a bone: vertex 3 is out of range 0 ... 2");
    CHECK(fault_of([](Model& m) { m.meshes[0].shares[0].joint = 2; }) == "f: a vertex: joint 2 is out of range 0 ... 1");
    CHECK(fault_of([](Model& m) {
              m.meshes[0].targets[0].vertices.pop_back();
          }).starts_with("f: mesh 'mesh': a morph target has 2"));
    CHECK(fault_of([](Model& m) { m.nodes[1].parent = 1; }) == "f: a node: parent 1 is out of range 0 ... 0");
    CHECK(fault_of([](Model& m) { m.nodes[1].parts[0].mesh = 1; }) == "f: mesh 1 is out of range 0 ... 0");
    CHECK(fault_of([](Model& m) { m.nodes[1].parts[0].skin = 1; }) == "f: skin 1 is out of range 0 ... 0");
    CHECK(fault_of([](Model& m) { m.skins[0].joints[0] = 2; }) == "f: a skin: node 2 is out of range 0 ... 1");
    CHECK(fault_of([](Model& m) { m.skins[0].offsets.pop_back(); }) == "f: a skin has not one matrix for each joint");
    CHECK(fault_of([](Model& m) { m.clips[0].channels[0].node = 2; }) == "f: an animation: node 2 is out of range 0 ... 1");
    CHECK(fault_of([](Model& m) { m.clips[0].morphs[0].nodes[0] = -1; }) == "f: an animation: node -1 is out of range 0 ... 1");
    CHECK(fault_of([](Model& m) { m.clips[0].morphs[0].times.push_back(1); }) == "f: an animation has 1 values for 2 times");
    CHECK(fault_of([](Model& m) { m.clips[0].channels[0].translation.interpolation = Interpolation::cubic; }) ==
          "f: an animation has 2 values for 2 times");
}

}  // namespace percale::scenes::test::model_test
