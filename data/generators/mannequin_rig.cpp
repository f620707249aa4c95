#include "generators/mannequin_rig.h"

#include <algorithm>
#include <cmath>

#include "generators/mannequin_parts.h"

namespace percale::scenes {

namespace {

constexpr double weight_steps = 65536.0;

/// 0 up to -half, 1 from +half on, with slopes 0 at both: 3 s^2 - 2 s^3.
double ramp(double value, double half) {
    const double s = std::clamp(0.5 + 0.5 * value / half, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

/// Shares of all joints; those of the left side are the near side's.
using Shares = std::array<double, joint_count>;

/// Gives `child` a share of what its parent has.
void pass_on(Shares& shares, int parent, int child, double share) {
    shares[child] += share * shares[parent];
    shares[parent] *= 1.0 - share;
}

/// How far a point lies beyond a joint along a direction, m.
double beyond(const std::vector<Joint>& joints, int index, const Vec3& direction, const Vec3& point) {
    return (point - joints[index].position).dot(direction);
}

Vec3 bone(const std::vector<Joint>& joints, int from, int to) {
    return (joints[to].position - joints[from].position).normalized();
}

/// Along the spine by height; neck and head across the tilted neck, so that the chin goes with the head.
void share_core(const std::vector<Joint>& joints, const Vec3& x, Shares& shares) {
    pass_on(shares, joint::hips, joint::spine, ramp(beyond(joints, joint::spine, Vec3::UnitY(), x), 0.08));
    pass_on(shares, joint::spine, joint::chest, ramp(beyond(joints, joint::chest, Vec3::UnitY(), x), 0.08));
    pass_on(shares, joint::chest, joint::neck, ramp(beyond(joints, joint::neck, Vec3(0.0, 0.9, 0.4).normalized(), x), 0.045));
    pass_on(shares, joint::neck, joint::head, ramp(beyond(joints, joint::head, Vec3(0.0, 0.95, 0.3).normalized(), x), 0.04));
    const double girdle = ramp(x[0] - 0.08, 0.05) * ramp(x[1] - 1.385, 0.055);
    pass_on(shares, joint::chest, joint::clavicle, girdle);
}

/// Elbow: across the plane that halves the angle of the bones. The upper arm's own joint takes over along all of the bone.
void share_arm(const std::vector<Joint>& joints, const Vec3& x, Shares& shares) {
    const Vec3 upper = bone(joints, joint::shoulder, joint::elbow), fore = bone(joints, joint::elbow, joint::wrist);
    pass_on(shares, joint::shoulder, joint::upper_arm, ramp(beyond(joints, joint::upper_arm, upper, x), 0.10));
    pass_on(shares, joint::upper_arm, joint::elbow, ramp(beyond(joints, joint::elbow, (upper + fore).normalized(), x), 0.045));
    pass_on(shares, joint::elbow, joint::wrist, ramp(beyond(joints, joint::wrist, fore, x), 0.03));
}

/// The ankle's plane rises towards the heel, so that the instep goes with the foot.
void share_leg(const std::vector<Joint>& joints, const Vec3& x, Shares& shares) {
    pass_on(shares, joint::hip, joint::knee, ramp(-beyond(joints, joint::knee, Vec3::UnitY(), x), 0.07));
    pass_on(shares, joint::knee, joint::ankle, ramp(beyond(joints, joint::ankle, Vec3(0.0, -0.95, 0.3).normalized(), x), 0.04));
    pass_on(shares, joint::ankle, joint::toes, ramp(beyond(joints, joint::toes, Vec3::UnitZ(), x), 0.03));
}

/// The shares of a point with x >= 0. The arm begins where the distances to it and to the trunk are equal: at the armpit, where
/// its far side is not near. The leg begins at the crease from the crotch up to the side of the hip; the middle stays with the
/// hips.
Shares shares_of(const Vec3& x) {
    static const std::vector<Joint> joints = mannequin_joints();
    const double arm = ramp(core_distance(x) - parts_distance(arm_parts(), x), 0.05);
    const double crease = joints[joint::hip].position[1] + 0.6 * (x[0] - joints[joint::hip].position[0]);
    const double leg = (1.0 - arm) * ramp(crease - x[1], 0.07) * ramp(x[0] - 0.01, 0.01);
    Shares shares{};
    shares[joint::hips] = 1.0 - arm - leg;
    shares[joint::shoulder] = arm;
    shares[joint::hip] = leg;
    share_core(joints, x, shares);
    share_arm(joints, x, shares);
    share_leg(joints, x, shares);
    return shares;
}

/// The four largest shares, in steps of 2^-16; what rounding leaves goes to the largest.
VertexWeights largest_four(const Shares& shares) {
    std::array<int, joint_count> order{};
    for (int j = 0; j < joint_count; ++j) order[j] = j;
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return shares[a] > shares[b]; });
    double total = 0.0, rest = weight_steps;
    for (int k = 0; k < 4; ++k) total += shares[order[k]];
    VertexWeights result;
    for (int k = 0; k < 4; ++k) {
        const double steps = std::round(shares[order[k]] / total * weight_steps);
        if (steps == 0.0) break;
        result.joints[k] = order[k];
        result.weights[k] = steps / weight_steps;
        rest -= steps;
    }
    result.weights[0] += rest / weight_steps;
    return result;
}

Eigen::Quaterniond quaternion(const Rotation& r) { return {r.w, r.x, r.y, r.z}; }

/// T_j of all joints.
std::vector<Eigen::Isometry3d> joint_transforms(const std::vector<Joint>& joints, const MannequinPose& pose) {
    std::vector<Eigen::Isometry3d> transforms;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const Eigen::Translation3d centre(joints[j].position);
        Eigen::Isometry3d turn = centre * quaternion(pose.rotations[j]) * centre.inverse();
        if (joints[j].parent < 0) turn.pretranslate(pose.root_translation);
        transforms.push_back(joints[j].parent < 0 ? turn : transforms[joints[j].parent] * turn);
    }
    return transforms;
}

}  // namespace

std::vector<Joint> mannequin_joints() {
    const BodyPart skull = head_parts()[0], throat = head_parts()[2], girdle = trunk_parts()[4];
    const BodyPart upper = arm_parts()[0], fore = arm_parts()[1], thigh = leg_parts()[0], shank = leg_parts()[1];
    const BodyPart foot = leg_parts()[4];
    const double hip_height = thigh.from[1];
    std::vector<Joint> joints = {
        {"hips", -1, {0.0, hip_height + 0.05, thigh.from[2]}},
        {"spine", joint::hips, {0.0, 1.04, trunk_parts()[1].to()[2] - 0.02}},
        {"chest", joint::spine, {0.0, 1.20, trunk_parts()[1].from[2] - 0.02}},
        {"neck", joint::chest, throat.from},
        {"head", joint::neck, {0.0, throat.to()[1] - 0.025, skull.from[2] + 0.01}},
        {"clavicle", joint::chest, {girdle.from[0], 1.45, 0.0}},
        {"shoulder", joint::clavicle, upper.from},
        {"upper_arm", joint::shoulder, 0.5 * (fore.from + upper.from)},
        {"elbow", joint::upper_arm, fore.from},
        {"wrist", joint::elbow, fore.to()},
        {"hip", joint::hips, thigh.from},
        {"knee", joint::hip, shank.from},
        {"ankle", joint::knee, shank.to()},
        {"toes", joint::ankle, {0.125, foot.to()[1], 0.075}},
    };
    for (int j = joint::clavicle; j <= joint::toes; ++j) {
        Joint right = joints[j];
        right.name = "right_" + right.name;
        right.parent = mirrored_joint(right.parent);
        right.position[0] *= -1.0;
        joints.push_back(right);
        joints[j].name = "left_" + joints[j].name;
    }
    return joints;
}

VertexWeights mannequin_weights(const Vec3& point) {
    VertexWeights weights = largest_four(shares_of({std::abs(point[0]), point[1], point[2]}));
    if (point[0] < 0.0)
        for (int k = 0; k < 4; ++k)
            if (weights.weights[k] > 0.0) weights.joints[k] = mirrored_joint(weights.joints[k]);
    return weights;
}

Rig make_mannequin_rig(const TriangleMesh& mesh) {
    Rig rig{mesh, mannequin_joints(), {}};
    for (const Vec3& x : mesh.vertices) rig.weights.push_back(mannequin_weights(x));
    return rig;
}

std::vector<Vec3> pose_mannequin(const Rig& rig, const MannequinPose& pose) {
    const std::vector<Eigen::Isometry3d> transforms = joint_transforms(rig.joints, pose);
    std::vector<Vec3> posed;
    for (std::size_t v = 0; v < rig.mesh.vertices.size(); ++v) {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 4; ++k)
            sum += rig.weights[v].weights[k] * (transforms[rig.weights[v].joints[k]] * rig.mesh.vertices[v]);
        posed.push_back(sum);
    }
    return posed;
}

MannequinPose mirrored_pose(const MannequinPose& pose) {
    MannequinPose image;
    image.root_translation = {-pose.root_translation[0], pose.root_translation[1], pose.root_translation[2]};
    for (int j = 0; j < joint_count; ++j) {
        const Rotation& r = pose.rotations[j];
        image.rotations[mirrored_joint(j)] = {r.w, r.x, -r.y, -r.z};
    }
    return image;
}

}  // namespace percale::scenes
