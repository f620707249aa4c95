#include "bodies/clip_keys.h"

#include <assimp/anim.h>
#include <assimp/mesh.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/support/catch.h"

namespace percale::scenes::test::clip_keys_test {

TEST_CASE("A node's transform is linear between its keys, its rotation at a constant rate, and constant outside") {
    aiNodeAnim channel;  // its destructor frees the keys
    channel.mNumPositionKeys = channel.mNumRotationKeys = channel.mNumScalingKeys = 2;
    channel.mPositionKeys = new aiVectorKey[2]{{1.0, aiVector3D(0, 0, 0)}, {3.0, aiVector3D(4, 0, 0)}};
    channel.mRotationKeys = new aiQuatKey[2]{{1.0, aiQuaternion()}, {3.0, aiQuaternion(aiVector3D(0, 0, 1), 1.0f)}};
    channel.mScalingKeys = new aiVectorKey[2]{{1.0, aiVector3D(1, 1, 1)}, {3.0, aiVector3D(3, 1, 1)}};
    CHECK(last_key(channel) == 3.0);
    for (const double tick : {0.0, 1.0, 1.5, 2.2, 3.0, 9.0}) {
        const double share = std::clamp(0.5 * (tick - 1.0), 0.0, 1.0);
        const Eigen::Matrix4d expected =
            (Eigen::Translation3d(4.0 * share, 0.0, 0.0) * Eigen::AngleAxisd(share, Eigen::Vector3d::UnitZ()) *
             Eigen::Scaling(1.0 + 2.0 * share, 1.0, 1.0))
                .matrix();
        CHECK((node_transform(channel, tick) - expected).norm() < 1e-6);
    }
    CHECK(node_transform(aiNodeAnim(), 1.0) == Eigen::Matrix4d::Identity());
}

TEST_CASE("Weights of morph targets are linear between keys, and without keys those of the mesh") {
    aiMeshMorphAnim channel;
    CHECK(morph_weights(channel, 0.0).empty());
    channel.mNumKeys = 2;
    channel.mKeys = new aiMeshMorphKey[2];
    for (unsigned k = 0; k < 2; ++k) {
        channel.mKeys[k].mTime = 10.0 * k;
        channel.mKeys[k].mNumValuesAndWeights = 1;
        channel.mKeys[k].mValues = new unsigned[1]{3};
        channel.mKeys[k].mWeights = new double[1]{1.0 + k};
    }
    CHECK(last_key(channel) == 10.0);
    double sum = 0.0;
    for (const auto& [target, weight] : morph_weights(channel, 2.5)) {
        CHECK(target == 3);
        sum += weight;
    }
    CHECK(sum == Approx(1.25));
    aiMesh mesh;
    mesh.mNumAnimMeshes = 1;
    mesh.mAnimMeshes = new aiAnimMesh* [1] { new aiAnimMesh };
    mesh.mAnimMeshes[0]->mWeight = 0.5f;
    REQUIRE(own_morph_weights(mesh).size() == 1);
    CHECK(own_morph_weights(mesh)[0] == std::pair{0u, 0.5});
}

}  // namespace percale::scenes::test::clip_keys_test
