#include "scenes/models/joined_model.h"

#include <limits>

#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::joined_model_test {

TEST_CASE("A joined model knows where each vertex comes from, and its clips by name or number") {
    const TestFolder folder;
    const BendingBar bar;
    const JoinedModel joined = read_joined_model(bar.write_gltf(folder));
    CHECK(clip_names(joined.model) == std::vector<std::string>{"bend", "1"});
    CHECK(joined.mesh.triangles == bar.triangles);
    CHECK(farthest_apart(joined.mesh.vertices, bar.vertices) < 1e-7);
    REQUIRE(joined.origins.size() == bar.vertices.size());
    for (std::size_t i = 0; i < joined.origins.size(); ++i) {
        const VertexOrigin& origin = joined.origins[i];
        CHECK(joined.model.nodes[origin.node].name == "bar");
        CHECK(origin.vertex == static_cast<int>(i));
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
    JoinedModel joined = read_joined_model(folder.write("two.stl", stl));
    CHECK(joined.mesh.vertices.size() == 6);
    JoinedModel apart = joined;
    weld(apart, [](int, int) { return false; });
    CHECK(apart.mesh.vertices.size() == 6);
    weld(joined);
    CHECK(joined.mesh.vertices.size() == 4);
    CHECK(joined.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(joined.origins[3].vertex == 4);
}

TEST_CASE("Meshes hang on nodes that hang on nodes, once for each, with corners of their own") {
    Model model;
    model.meshes.push_back({.name = "t",
                            .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                            .corners = {0, 1, 2},
                            .face_sizes = {3},
                            .shares = {},
                            .targets = {}});
    Eigen::Matrix4d up = Eigen::Matrix4d::Identity(), twice = 2.0 * Eigen::Matrix4d::Identity();
    up(1, 3) = 5.0;
    twice(3, 3) = 1.0;
    model.nodes.push_back({.name = "up", .parent = -1, .transform = up, .parts = {{0}}});
    model.nodes.push_back({.name = "twice", .parent = 0, .transform = twice, .parts = {{0}}});
    const JoinedModel both = join(model, "two");
    CHECK(both.mesh.vertices == std::vector<Vec3>{{0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {0, 5, 0}, {2, 5, 0}, {0, 7, 0}});
    CHECK(both.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
    CHECK(join(model, "two", "twice").mesh.vertices == std::vector<Vec3>{{0, 5, 0}, {2, 5, 0}, {0, 7, 0}});
    model.nodes[1].transform(0, 0) = -2.0;  // a mirror: its triangles are turned about, so that they face as before
    CHECK(join(model, "two").mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {4, 3, 5}});
    model.meshes[0].vertices[1].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK(message_of([&] { join(model, "two"); }) == "two: vertex 1: coordinate y is not finite");
}

TEST_CASE("A part that there is not and a coordinate without a number are refused") {
    const TestFolder folder;
    const std::string file = BendingBar().write_gltf(folder);
    CHECK(message_of([&] { read_joined_model(file, "bra"); }).find("bar") != std::string::npos);
    CHECK(message_of([&] {
              check_finite({0.0, std::numeric_limits<double>::infinity(), 0.0}, 7, "a.fbx");
          }) == "a.fbx: vertex 7: coordinate y is not finite");
}

}  // namespace percale::scenes::test::joined_model_test
