#include "scenes/models/skinned_shape.h"

#include <Eigen/Geometry>

#include "tests/support/catch.h"

namespace percale::scenes::test::skinned_shape_test {
namespace {

/// A segment whose first vertex hangs on joint 0, its second half on each, its third on joint 1, and a fourth on nothing, under a
/// node that is a hundred times too large.
Model segment() {
    Model model;
    model.meshes.push_back({.name = "m",
                            .vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                            .corners = {0, 1, 2},
                            .face_sizes = {3},
                            .shares = {{0, 0, 2.0}, {1, 0, 0.5}, {1, 1, 0.5}, {2, 1, 0.25}, {2, 0, 0.0}},
                            .targets = {{{{0, 0, 0}, {1, 0, 0}, {2, 4, 0}, {3, 0, 0}}, 0.5}}});
    Eigen::Matrix4d large = 100.0 * Eigen::Matrix4d::Identity(), raised = Eigen::Matrix4d::Identity();
    large(3, 3) = 1.0;
    raised(2, 3) = 8.0;
    model.skins.push_back({{1, 2}, {Eigen::Matrix4d::Identity(), raised.inverse()}});
    model.nodes.push_back({.name = "body", .parent = -1, .transform = large, .parts = {{0, 0}}});
    model.nodes.push_back({.name = "hip", .parent = -1, .transform = Eigen::Matrix4d::Identity(), .parts = {}});
    model.nodes.push_back({.name = "knee", .parent = 1, .transform = raised, .parts = {}});
    return model;
}

std::vector<VertexOrigin> all(const Model& model) {
    std::vector<VertexOrigin> origins;
    for (int k = 0; k < static_cast<int>(model.meshes[0].vertices.size()); ++k) origins.push_back({0, 0, k});
    return origins;
}

}  // namespace

TEST_CASE("Bones carry a vertex by its shares whatever its node does; without shares it goes along with the node") {
    const Model model = segment();
    const std::vector<VertexOrigin> origins = all(model);
    const SkinnedShape shape(model, origins);
    const std::vector<Vec3> rest = shape.at(rest_poses(model), rest_weights(model));
    CHECK(rest == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 2, 0}, {300, 0, 0}});
    const auto turned = [&](int node) -> Eigen::Matrix4d {
        if (node != 2) return model.nodes[static_cast<std::size_t>(node)].transform;
        return model.nodes[2].transform * Eigen::Affine3d(Eigen::AngleAxisd(0.5, Vec3::UnitY())).matrix();
    };
    const std::vector<Vec3> bent =
        shape.at(node_poses(model, turned), [](int, const ModelMesh&) { return std::vector<double>{0.0}; });
    const Vec3 carried = Eigen::AngleAxisd(0.5, Vec3::UnitY()) * Vec3(1, 0, -8) + Vec3(0, 0, 8);
    CHECK((bent[1] - 0.5 * (Vec3(1, 0, 0) + carried)).norm() < 1e-14);
    CHECK((bent[2] - (Eigen::AngleAxisd(0.5, Vec3::UnitY()) * Vec3(2, 0, -8) + Vec3(0, 0, 8))).norm() < 1e-14);
}

TEST_CASE("A mesh without a skin goes along with each node that it hangs on, its targets mixed in") {
    Model model = segment();
    model.nodes[0].parts[0].skin = -1;
    model.nodes[2].parts.push_back({0, -1});
    std::vector<VertexOrigin> origins = all(model);
    origins.push_back({2, 0, 2});
    const std::vector<Vec3> shape = SkinnedShape(model, origins).at(rest_poses(model), rest_weights(model));
    CHECK(shape[2] == Vec3(200, 200, 0));
    CHECK(shape[4] == Vec3(2, 2, 8));
    model.nodes[2].weights = {1.0};  // its own, not the mesh's
    const std::vector<Vec3> own = SkinnedShape(model, origins).at(rest_poses(model), rest_weights(model));
    CHECK(own[2] == shape[2]);
    CHECK(own[4] == Vec3(2, 4, 8));
}

}  // namespace percale::scenes::test::skinned_shape_test
