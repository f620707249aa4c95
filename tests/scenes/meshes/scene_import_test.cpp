#include "meshes/scene_import.h"

#include <assimp/scene.h>

#include <limits>

#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_import_test {

TEST_CASE("An imported scene knows where each vertex comes from, and its clips by name or number") {
    const TestFolder folder;
    const BendingBar bar;
    const ImportedScene imported = import_scene(bar.write_gltf(folder));
    CHECK(clip_names(imported) == std::vector<std::string>{"bend", "1"});
    CHECK(imported.mesh.triangles == bar.triangles);
    REQUIRE(imported.origins.size() == bar.vertices.size());
    for (std::size_t i = 0; i < imported.origins.size(); ++i) {
        const VertexOrigin& origin = imported.origins[i];
        CHECK(std::string(origin.node->mName.C_Str()) == "bar");
        const aiVector3D x = origin.mesh->mVertices[origin.vertex];
        CHECK(Vec3(x.x, x.y, x.z) == imported.mesh.vertices[i]);
    }
}

TEST_CASE("Vertices at one place become one, with the origin of the first") {
    const TestFolder folder;
    const std::string stl = R"(solid two
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 1 0 0
vertex 1 1 0
vertex 0 1 0
endloop
endfacet
endsolid two
)";
    ImportedScene imported = import_scene(folder.write("two.stl", stl));
    CHECK(imported.mesh.vertices.size() == 6);
    ImportedScene apart = imported;
    weld(apart, [](int, int) { return false; });
    CHECK(apart.mesh.vertices.size() == 6);
    weld(imported);
    CHECK(imported.mesh.vertices.size() == 4);
    CHECK(imported.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(imported.origins[3].vertex == 4);
}

TEST_CASE("A part that there is not and a coordinate without a number are refused") {
    const TestFolder folder;
    const std::string file = BendingBar().write_gltf(folder);
    CHECK(message_of([&] { import_scene(file, "bra"); }).find("bar") != std::string::npos);
    CHECK(message_of([&] {
              check_finite({0.0, std::numeric_limits<double>::infinity(), 0.0}, 7, "a.fbx");
          }) == "a.fbx: vertex 7: coordinate y is not finite");
}

}  // namespace percale::scenes::test::scene_import_test
