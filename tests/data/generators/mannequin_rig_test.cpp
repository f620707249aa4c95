#include "data/generators/mannequin_rig.h"

#include <map>
#include <random>
#include <set>
#include <tuple>

#include "data/generators/mannequin.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mannequin_rig_test {
namespace {

const Rig& rig() {
    static const Rig made = make_mannequin_rig(make_mannequin(0.02));
    return made;
}

Rotation turn(const Vec3& axis, double degrees) {
    const double half = 0.5 * degrees * EIGEN_PI / 180.0;
    const Vec3 v = std::sin(half) * axis.normalized();
    return {std::cos(half), v[0], v[1], v[2]};
}

double weight_of(const VertexWeights& vertex, int index) {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += vertex.joints[k] == index ? vertex.weights[k] : 0.0;
    return sum;
}

std::map<int, double> as_map(const VertexWeights& vertex) {
    std::map<int, double> all;
    for (int k = 0; k < 4; ++k)
        if (vertex.weights[k] > 0.0) all[vertex.joints[k]] += vertex.weights[k];
    return all;
}

/// Whether a vertex follows none but these.
bool only(const VertexWeights& vertex, const std::set<int>& joints) {
    for (const auto& [index, weight] : as_map(vertex))
        if (!joints.contains(index)) return false;
    return true;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

/// Some turn of every joint, the same at every call.
MannequinPose bent_pose() {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    MannequinPose pose;
    pose.root_translation = {0.1, -0.2, 0.3};
    for (Rotation& r : pose.rotations) r = turn({share(random), share(random), share(random)}, 30.0 * share(random));
    return pose;
}

}  // namespace

TEST_CASE("joints lie inside the body, after their parents, in pairs") {
    const std::vector<Joint> joints = mannequin_joints();
    REQUIRE(joints.size() == joint_count);
    std::set<std::string> names;
    for (int j = 0; j < joint_count; ++j) {
        INFO(joints[j].name);
        CHECK(names.insert(joints[j].name).second);
        CHECK(joints[j].parent < j);
        CHECK((joints[j].parent < 0) == (j == 0));
        CHECK(mannequin_distance(joints[j].position) < -0.015);
        const Joint& image = joints[mirrored_joint(j)];
        CHECK(mirrored_joint(mirrored_joint(j)) == j);
        CHECK(image.position == Vec3(-joints[j].position[0], joints[j].position[1], joints[j].position[2]));
        CHECK((joints[j].position[0] == 0.0) == (mirrored_joint(j) == j));
        if (j > 0) CHECK(image.parent == mirrored_joint(joints[j].parent));
    }
    CHECK(joints[joint::elbow].name == "left_elbow");
    CHECK(joints[mirrored_joint(joint::elbow)].name == "right_elbow");
    CHECK(joints[joint::elbow].position[0] > 0.0);
}

TEST_CASE("weights are multiples of 2^-16 that sum to 1 exactly, as floats too, the unused last") {
    for (const VertexWeights& vertex : rig().weights) {
        float sum = 0.0f;
        for (int k = 0; k < 4; ++k) {
            const double steps = vertex.weights[k] * 65536.0;
            REQUIRE(steps == std::round(steps));
            REQUIRE(steps >= 0.0);
            REQUIRE((k == 0 || vertex.weights[k] == 0.0 || vertex.weights[k - 1] > 0.0));
            REQUIRE((vertex.weights[k] > 0.0 || vertex.joints[k] == 0));
            REQUIRE((vertex.joints[k] >= 0 && vertex.joints[k] < joint_count));
            sum += static_cast<float>(vertex.weights[k]);
        }
        REQUIRE(sum == 1.0f);
    }
}

TEST_CASE("the mirror image of a vertex has the weights of the mirrored joints, to the last bit") {
    for (const Vec3& x : rig().mesh.vertices) {
        std::map<int, double> mirrored;
        for (const auto& [index, weight] : as_map(mannequin_weights(x))) mirrored[mirrored_joint(index)] = weight;
        REQUIRE(as_map(mannequin_weights({-x[0], x[1], x[2]})) == mirrored);
    }
}

TEST_CASE("no vertex follows a part of the body that it does not belong to") {
    using namespace joint;
    int hands = 0, waists = 0, feet = 0, heads = 0;
    for (std::size_t v = 0; v < rig().weights.size(); ++v) {
        const Vec3& x = rig().mesh.vertices[v];
        const VertexWeights& vertex = rig().weights[v];
        INFO(x.transpose());
        if (x[0] > 0.56) REQUIRE((only(vertex, {wrist}) && ++hands));
        if (std::abs(x[0]) < 0.17 && x[1] > 1.05 && x[1] < 1.22) REQUIRE((only(vertex, {hips, spine, chest}) && ++waists));
        if (x[0] > 0.0 && x[1] < 0.03) REQUIRE((only(vertex, {ankle, toes}) && ++feet));
        if (x[1] > 1.67) REQUIRE((only(vertex, {head}) && ++heads));
        if (x[0] > 0.02)
            REQUIRE((weight_of(vertex, mirrored_joint(hip)) == 0.0 && weight_of(vertex, mirrored_joint(shoulder)) == 0.0));
        if (x[0] > 0.35) REQUIRE(only(vertex, {shoulder, upper_arm, elbow, wrist}));
        if (x[0] > 0.0 && x[1] < 0.7) REQUIRE(only(vertex, {hip, knee, ankle, toes}));
    }
    CHECK(hands > 50);
    CHECK(waists > 300);
    CHECK(feet > 50);
    CHECK(heads > 100);
}

TEST_CASE("weights change gently along the surface") {
    double steepest = 0.0;
    for (const Triangle& triangle : rig().mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = triangle[k], b = triangle[(k + 1) % 3];
            const double length = (rig().mesh.vertices[a] - rig().mesh.vertices[b]).norm();
            for (int j = 0; j < joint_count; ++j)
                steepest = std::max(steepest, std::abs(weight_of(rig().weights[a], j) - weight_of(rig().weights[b], j)) / length);
        }
    INFO("steepest change " << steepest << " a metre");
    CHECK(steepest < 50.0);  // from 0 to 1 within no less than an edge of 0.02 m
}

TEST_CASE("without any turn the mesh is where it was made") {
    CHECK(largest_difference(pose_mannequin(rig(), {}), rig().mesh.vertices) < 1e-14);
}

TEST_CASE("the root moves everything as a rigid body") {
    MannequinPose pose;
    pose.root_translation = {0.3, 0.1, -0.2};
    pose.rotations[joint::hips] = turn({1, 2, 3}, 50.0);
    const std::vector<Vec3> posed = pose_mannequin(rig(), pose);
    const Vec3 root = mannequin_joints()[joint::hips].position;
    std::vector<Vec3> moved;
    for (const Vec3& x : rig().mesh.vertices)
        moved.push_back(transform(Pose{root + pose.root_translation, pose.rotations[joint::hips], 1.0}, x - root));
    CHECK(largest_difference(posed, moved) < 1e-13);
}

TEST_CASE("a bent elbow moves the forearm beyond its transition as a rigid body, and nothing before it") {
    MannequinPose pose;
    pose.rotations[joint::elbow] = turn({1, 1, 0}, 65.0);
    const std::vector<Vec3> posed = pose_mannequin(rig(), pose);
    const Vec3 elbow = mannequin_joints()[joint::elbow].position;
    int rigid = 0, still = 0, between = 0;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const Vec3& x = rig().mesh.vertices[v];
        const double weight = weight_of(rig().weights[v], joint::elbow) + weight_of(rig().weights[v], joint::wrist);
        const Vec3 turned = transform(Pose{elbow, pose.rotations[joint::elbow], 1.0}, x - elbow);
        REQUIRE((posed[v] - (1.0 - weight) * x - weight * turned).norm() < 1e-13);
        rigid += weight == 1.0 ? 1 : 0;
        still += weight == 0.0 ? 1 : 0;
        if (weight > 0.0 && weight < 1.0) REQUIRE(((x - elbow).norm() < 0.09 && ++between));
    }
    CHECK(rigid > 300);
    CHECK(between > 50);
    CHECK(rigid + still + between == static_cast<int>(posed.size()));
}

TEST_CASE("turns of a chain add up: where all joints on the path to the hand turn, the hand goes by each in turn") {
    const MannequinPose pose = bent_pose();
    const std::vector<Joint> joints = mannequin_joints();
    const std::vector<Vec3> posed = pose_mannequin(rig(), pose);
    int checked = 0;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        if (weight_of(rig().weights[v], joint::wrist) != 1.0) continue;
        Vec3 x = rig().mesh.vertices[v];
        for (int j = joint::wrist; j >= 0; j = joints[j].parent)
            x = transform(Pose{joints[j].position, pose.rotations[j], 1.0}, x - joints[j].position);
        REQUIRE((posed[v] - x - pose.root_translation).norm() < 1e-13);
        ++checked;
    }
    CHECK(checked > 100);
}

TEST_CASE("a mirrored pose is the mirror image of the posed mesh") {
    const std::vector<Vec3> posed = pose_mannequin(rig(), bent_pose()), image = pose_mannequin(rig(), mirrored_pose(bent_pose()));
    std::map<std::tuple<double, double, double>, int> place;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const Vec3& x = rig().mesh.vertices[v];
        place[{x[0], x[1], x[2]}] = static_cast<int>(v);
    }
    double largest = 0.0;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const Vec3& x = rig().mesh.vertices[v];
        const Vec3& other = posed[place.at({-x[0], x[1], x[2]})];
        largest = std::max(largest, (image[v] - Vec3(-other[0], other[1], other[2])).norm());
    }
    CHECK(largest < 1e-13);
}

TEST_CASE("bent by 65 degrees, elbows and knees keep the body's volume to 2 %") {
    TriangleMesh bent = rig().mesh;
    MannequinPose pose;
    for (const int index : {static_cast<int>(joint::elbow), mirrored_joint(joint::elbow)})
        pose.rotations[index] = turn({-1, -1, 0}, 65.0);
    for (const int index : {static_cast<int>(joint::knee), mirrored_joint(joint::knee)})
        pose.rotations[index] = turn({1, 0, 0}, 65.0);
    bent.vertices = pose_mannequin(rig(), pose);
    INFO("volume " << volume(rig().mesh) << " m^3, bent " << volume(bent));
    CHECK(volume(bent) == Approx(volume(rig().mesh)).epsilon(0.02));
}

}  // namespace percale::scenes::test::mannequin_rig_test
