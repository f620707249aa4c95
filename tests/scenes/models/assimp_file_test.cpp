#include "scenes/models/assimp_file.h"

#include "scenes/models/joined_model.h"
#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/collada_text.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::assimp_file_test {

TEST_CASE("What assimp reads of a bending bar is what our own reader reads: nodes, skin, targets and clips") {
    const TestFolder folder;
    const BendingBar bar;
    const std::string file = bar.write_gltf(folder);
    const JoinedModel ours = read_joined_model(file), theirs = join(read_by_assimp(file), file);
    CHECK(theirs.mesh.triangles == ours.mesh.triangles);
    CHECK(farthest_apart(theirs.mesh.vertices, ours.mesh.vertices) < 1e-6);
    CHECK(clip_names(theirs.model) == clip_names(ours.model));
    REQUIRE(theirs.model.skins.size() == 1);
    CHECK((theirs.model.skins[0].offsets[1] - ours.model.skins[0].offsets[1]).norm() < 1e-6);
    REQUIRE(theirs.model.clips[0].channels.size() == 1);
    CHECK(theirs.model.nodes[theirs.model.clips[0].channels[0].node].name == "joint");
    CHECK(theirs.model.meshes[0].targets.size() == 1);
    REQUIRE(theirs.model.clips[1].morphs.size() == 1);
    CHECK(theirs.model.clips[1].morphs[0].weights.back() == std::vector<double>{1.0});
}

TEST_CASE("A file that no importer reads is refused by name, in one line") {
    const TestFolder folder;
    const std::string torn = test::collada("<node id=\"n\"><instance_geometry url=\"#g\"/></node>\n");
    for (std::size_t cut = 0; cut < torn.size(); cut += 97) {
        const std::string file = folder.write("torn.dae", torn.substr(0, cut));
        const std::string text = message_of([&] { read_by_assimp(file); });
        CAPTURE(cut, text);
        CHECK(text.starts_with(file + ": "));
        CHECK(text.find('\n') == std::string::npos);
    }
    CHECK(message_of([&] { read_by_assimp(folder.path("none.fbx")); }).find("none.fbx: cannot be read: ") != std::string::npos);
}

}  // namespace percale::scenes::test::assimp_file_test
