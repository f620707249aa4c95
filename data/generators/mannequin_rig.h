#pragma once

#include <array>
#include <string>
#include <vector>

#include "percale/mesh.h"

// The mannequin's joints, which vertices follow them, and the mesh in a pose: linear blend skinning.
namespace percale::scenes {

/// A joint turns what lies beyond it. Parents come before their children. Those from `clavicle` on are the left side's (x > 0),
/// and the right side's follow in the same order. `upper_arm` lies half-way to the elbow and shares the arm's turn about its own
/// axis with the shoulder, so that the skin does not wring.
namespace joint {
enum Index { hips, spine, chest, neck, head, clavicle, shoulder, upper_arm, elbow, wrist, hip, knee, ankle, toes };
}
inline constexpr int side_joint_count = joint::toes - joint::clavicle + 1;
inline constexpr int joint_count = joint::toes + 1 + side_joint_count;

/// The joint at the other side; itself where it lies in the middle. 0 ... joint_count - 1.
constexpr int mirrored_joint(int index) {
    if (index < joint::clavicle) return index;
    return index <= joint::toes ? index + side_joint_count : index - side_joint_count;
}

struct Joint {
    std::string name;  // "hips", "left_elbow", "right_knee"
    int parent = -1;   // -1: none
    Vec3 position;     // m, in the mesh as it was made
};

/// Joints that a vertex follows, each once, and how much: multiples of 2^-16 with the sum 1, exactly, as doubles and as floats.
/// Unused ones come last, 0 at joint 0.
struct VertexWeights {
    std::array<int, 4> joints{};
    std::array<double, 4> weights{};
};

/// A mesh that follows joints.
struct Rig {
    TriangleMesh mesh;
    std::vector<Joint> joints;
    std::vector<VertexWeights> weights;  // one a vertex
};

/// How joints stand. Without any turn and translation: as the mesh was made.
struct MannequinPose {
    Vec3 root_translation = Vec3::Zero();  // m, of the hips
    std::array<Rotation, joint_count>
        rotations{};  // about each joint, in the frame of its parent, whose axes are at first x, y, z
};

/// The mannequin's joints, in the order of joint::Index, where its body parts meet.
std::vector<Joint> mannequin_joints();

/// What a point of the mannequin's surface follows, m. Continuous but for steps of 2^-16; at the mirror image of a point the same
/// of the mirrored joints. Limbs and trunk do not mix where they are near but not joined: what belongs to a limb is decided by
/// the distances to the limb and to the trunk.
VertexWeights mannequin_weights(const Vec3& point);

/// A mesh of the mannequin in the pose of make_mannequin, of any spacing, with its joints.
Rig make_mannequin_rig(const TriangleMesh& mesh);

/// x -> sum_j w_j T_j x, where T_j turns about joint j and then does what its parent does; m.
std::vector<Vec3> pose_mannequin(const Rig& rig, const MannequinPose& pose);

/// Left and right exchanged.
MannequinPose mirrored_pose(const MannequinPose& pose);

}  // namespace percale::scenes
