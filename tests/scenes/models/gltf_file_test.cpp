#include "scenes/models/gltf_file.h"

#include <Eigen/Geometry>

#include "percale/error.h"
#include "scenes/models/joined_model.h"
#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::gltf_file_test {
namespace {

/// The text of a bending bar, with parts of it replaced.
class Bar {
public:
    Bar() {
        BendingBar().write_gltf(folder_);
        text_ = folder_.read("bar.gltf");
    }
    Bar& with(const std::string& before, const std::string& after) {
        REQUIRE(text_.find(before) != std::string::npos);
        text_.replace(text_.find(before), before.size(), after);
        return *this;
    }
    std::string file() const { return folder_.write("bar.gltf", text_); }
    std::string fault() const {
        const std::string name = file(), text = message_of([&] { read_joined_model(name); });
        return text.starts_with(name + ": ") ? text.substr(name.size() + 2) : text;
    }

private:
    TestFolder folder_;
    std::string text_;
};

}  // namespace

TEST_CASE("A skin without inverse bind matrices has identities, as the specification says") {
    Bar bar;
    const Model given = read_gltf(bar.file());
    CHECK(given.skins[0].offsets[1](1, 3) == -1.0);
    const Model without = read_gltf(bar.with(",\"inverseBindMatrices\":5", "").file());
    REQUIRE(without.skins[0].offsets.size() == 2);
    for (const Eigen::Matrix4d& offset : without.skins[0].offsets) CHECK(offset == Eigen::Matrix4d::Identity());
}

TEST_CASE("A skinned mesh is where its joints have it, whatever its own node does, with a clip or without") {
    Bar bar;
    const std::vector<Vec3> rest = read_joined_model(bar.file()).mesh.vertices;
    bar.with("{\"name\":\"bar\",\"mesh\":0,\"skin\":0}",
             "{\"name\":\"bar\",\"mesh\":0,\"skin\":0,\"scale\":[0.01,0.01,0.01],\"translation\":[9,9,9]}");
    CHECK(read_joined_model(bar.file()).mesh.vertices == rest);
}

TEST_CASE("Nodes' transforms are translation, rotation and scale, or a matrix by columns") {
    Bar bar;
    bar.with("\"skin\":0}",
             "\"translation\":[1,2,3],\"rotation\":[0,0,0.70710678118654752,0.70710678118654752],\"scale\":[2,1,1]}");
    const Eigen::Matrix4d trs = read_gltf(bar.file()).nodes[0].transform;
    CHECK((trs * Eigen::Vector4d(1, 0, 0, 1) - Eigen::Vector4d(1, 4, 3, 1)).norm() < 1e-15);
    Bar other;
    other.with("\"skin\":0}", "\"matrix\":[0,2,0,0,-1,0,0,0,0,0,1,0,1,2,3,1]}");
    CHECK((read_gltf(other.file()).nodes[0].transform - trs).norm() < 1e-15);
}

TEST_CASE("A node's weights of morph targets take the place of its mesh's") {
    Bar bar;
    const std::vector<Vec3> rest = read_joined_model(bar.file()).mesh.vertices;
    bar.with("\"mesh\":0,\"skin\":0}", "\"mesh\":0,\"skin\":0,\"weights\":[1]}");
    const std::vector<Vec3> own = read_joined_model(bar.file()).mesh.vertices;
    for (std::size_t k = 0; k < own.size(); ++k) CHECK((own[k] - rest[k] - Vec3(0, 0, k < 8 ? 0.0 : 0.5)).norm() < 1e-6);
}

TEST_CASE("Parts that use the same numbers without end are refused before they fill the memory") {
    const TestFolder folder;
    std::string primitives;
    for (int k = 0; k < 3000; ++k) primitives += std::string(k > 0 ? "," : "") + R"({"attributes":{"POSITION":0}})";
    const std::string file = folder.write("a.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":30000,"uri":"a.bin"}],
"bufferViews":[{"buffer":0,"byteLength":30000}],"accessors":[{"bufferView":0,"componentType":5120,"count":10000,"type":"VEC3"}],
"meshes":[{"primitives":[)" + primitives + R"(]}],"nodes":[{"mesh":0}]})");
    folder.write("a.bin", std::string(30000, '\1'));
    CHECK(message_of([&] { read_gltf(file); }).find("its parts use the same numbers over and over, 64") != std::string::npos);
}

TEST_CASE("Strips and fans are triangles that turn the same way; a list without indices takes its vertices in turn") {
    for (const auto& [mode, triangles] : {std::pair<int, std::vector<Triangle>>{4, {{0, 1, 2}}},
                                          {5, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}},
                                          {6, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}}}) {
        const TestFolder folder;
        const std::string file = folder.write(
            "a.gltf",
            R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":20,"uri":"data:;base64,AAEAAAEAAAABAQAAAgEAAAMDAAA="}],
"bufferViews":[{"buffer":0,"byteLength":20,"byteStride":4}],
"accessors":[{"bufferView":0,"componentType":5120,"count":5,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":)" +
                std::to_string(mode) + R"(}]}],"nodes":[{"mesh":0}]})");
        CHECK(read_joined_model(file).mesh.triangles == triangles);
    }
}

TEST_CASE("Of several scenes the named one is read, vertices that no triangle has are left out, and so are points and lines") {
    Bar bar;
    bar.with("\"scenes\":[{\"nodes\":[0,1]}]", "\"scenes\":[{\"nodes\":[1]},{\"nodes\":[0,1]}]");
    CHECK(read_joined_model(bar.file()).mesh.vertices.empty());
    bar.with("\"scene\":0", "\"scene\":1");
    CHECK(read_joined_model(bar.file()).mesh.vertices.size() == 12);
    bar.with("\"count\":48", "\"count\":24");
    CHECK(read_joined_model(bar.file()).mesh.vertices.size() == 8);
    bar.with("\"indices\":3", "\"mode\":1,\"indices\":3");
    CHECK(read_joined_model(bar.file()).mesh.vertices.empty());
}

TEST_CASE("A file that does not fit together is refused with what and where") {
    CHECK(Bar().with("\"count\":48", "\"count\":49").fault() == "an accessor of 49 elements is outside of its buffer view");
    CHECK(Bar().with("\"children\":[2]", "\"children\":[3]").fault() == "child 3 is out of range 0 ... 2");
    CHECK(Bar().with("\"children\":[2]", "\"children\":[1]").fault() == "node 1 hangs on two nodes, or on itself");
    CHECK(Bar().with("{\"name\":\"joint\"", "{\"name\":\"joint\",\"children\":[1]").fault() ==
          "nodes hang on each other in a ring");
    CHECK(Bar().with("\"joints\":[1,2]", "\"joints\":[1]").fault() == "a vertex: joint 1 is out of range 0 ... 0");
    CHECK(Bar().with("\"joints\":[1,2]", "\"joints\":[1,2,0]").fault() == "a skin has 2 inverse bind matrices for 3 joints");
    CHECK(
        Bar()
            .with("\"componentType\":5121,\"count\":12,\"type\":\"VEC4\"", "\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"")
            .fault() == "JOINTS_0 and WEIGHTS_0 are not of as many vertices as POSITION");
    CHECK(Bar().with("\"JOINTS_0\":1", "\"JOINTS_0\":2").with("\"WEIGHTS_0\":2", "\"WEIGHTS_0\":2").fault() ==
          "JOINTS_0 holds 0.500000, no number of a joint");
    CHECK(Bar().with("\"mesh\":0", "\"mesh\":1").fault() == "mesh 1 is out of range 0 ... 0");
    CHECK(Bar().with("\"input\":6", "\"input\":8").fault() == "an animation has 3 values for 2 times");
    CHECK(Bar().with("\"POSITION\":0", "\"POSITION\":\"x\"").fault() == "POSITION is \"x\", no whole number");
    CHECK(Bar().with("\"nodes\":[{", "\"nodes\":[7,{").fault().starts_with("is no proper glTF: "));
    CHECK(Bar().with("{\"asset\"", "{\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"").fault() ==
          "needs the extension KHR_draco_mesh_compression, which is not read; export it without");
    CHECK(Bar().with("\"nodes\":[0,1]}],", "").fault().starts_with("is no proper glTF: "));
}

TEST_CASE("glTF 2.0 is known by what the file says, not by its name") {
    const TestFolder folder;
    CHECK(is_gltf_2(BendingBar().write_gltf(folder)));
    CHECK(is_gltf_2(folder.write("b", std::string("glTF\2\0\0\0", 8))));
    CHECK_FALSE(is_gltf_2(folder.write("b", std::string("glTF\1\0\0\0", 8))));
    CHECK_FALSE(is_gltf_2(folder.write("b", "{\"nodes\":{\"asset\":{\"version\":\"2.0\"}},\"asset\":{\"version\":\"1.0\"}}")));
    CHECK_FALSE(is_gltf_2(folder.write("b", "{\"asset\":{\"version\":1}}")));
    CHECK_FALSE(is_gltf_2(folder.write("b", "{\"asset\":7}")));
    CHECK_FALSE(is_gltf_2(folder.write("b", "solid a")));
    CHECK_FALSE(is_gltf_2(folder.write("b", "")));
}

}  // namespace percale::scenes::test::gltf_file_test
