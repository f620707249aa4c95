#include "generators/mannequin_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace percale::scenes {

namespace {

using Eigen::Quaterniond;

constexpr double pi = std::numbers::pi;
constexpr double stance = 0.6;  // fraction of the period in which a foot stands

struct PhaseKey {
    double phase, degrees;
};

// The pitch, toes up, of a foot that comes down at phase 0: it rolls over the heel until it is flat and over the toes from
// heel-off on; the toes stay flat meanwhile.
constexpr PhaseKey foot_pitch[] = {{0.0, 16.0}, {0.11, 0.0}, {0.34, 0.0}, {stance, -36.0}, {1.0, 16.0}};
constexpr PhaseKey toe_pitch[] = {{0.0, 0.0}, {0.34, 0.0}, {stance, 36.0}, {0.85, 0.0}, {1.0, 0.0}};

// m, in the mesh as it was made: what the foot rolls over, and by how much a swinging ankle rises above its line.
const Vec3 heel(0.109, 0.038, -0.055);
constexpr double ankle_rise = 0.05;

double radians(double degrees) { return degrees * pi / 180.0; }

/// 0 ... 1 with slopes 0 at both ends: 3 s^2 - 2 s^3.
double eased(double s) { return s * s * (3.0 - 2.0 * s); }

/// Eased from key to key, so that the slope is 0 at each; phase 0 ... 1.
double angle_at(std::span<const PhaseKey> keys, double phase) {
    std::size_t next = 1;
    while (next + 1 < keys.size() && keys[next].phase < phase) ++next;
    const PhaseKey from = keys[next - 1], to = keys[next];
    return radians(from.degrees + (to.degrees - from.degrees) * eased((phase - from.phase) / (to.phase - from.phase)));
}

Quaterniond turn(const Vec3& axis, double angle) { return Quaterniond(Eigen::AngleAxisd(angle, axis)); }
Quaterniond turn_x(double angle) { return turn(Vec3::UnitX(), angle); }
Quaterniond turn_y(double angle) { return turn(Vec3::UnitY(), angle); }
Quaterniond turn_z(double angle) { return turn(Vec3::UnitZ(), angle); }

Rotation rotation(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

const std::vector<Joint>& joints() {
    static const std::vector<Joint> all = mannequin_joints();
    return all;
}

const Vec3& place(int index) { return joints()[index].position; }

Vec3 bone(int from, int to) { return (place(to) - place(from)).normalized(); }

/// Turns the straight arm's forearm forwards.
Vec3 elbow_axis() { return bone(joint::shoulder, joint::elbow).cross(Vec3::UnitZ()).normalized(); }

struct Pelvis {
    Vec3 translation;
    Quaterniond rotation;
    double yaw;
};

/// The pelvis is highest over the standing leg, towards which it shifts, and lower at the side of the swinging leg; the side of
/// the leading leg is in front.
Pelvis pelvis_at(double phase) {
    const double rise = -0.031 - 0.021 * std::cos(4.0 * pi * (phase - 0.05)), roll = radians(2.5) * std::sin(2.0 * pi * phase);
    const double yaw = -radians(4.0) * std::cos(2.0 * pi * phase);
    return {{0.014 * std::sin(2.0 * pi * phase), rise, 0.0}, turn_y(yaw) * turn_z(roll), yaw};
}

/// Where the ankle of the standing left foot is. What it rolls over, the heel or the toes' joint, passes backwards at walk_speed.
Vec3 standing_ankle(double phase, double pitch) {
    const Vec3 centre = pitch > 0.0 ? heel : place(joint::toes);
    const Vec3 passed(0.0, 0.0, 0.285 - walk_speed * walk_period * phase);
    return centre + passed + turn_x(-pitch) * (place(joint::ankle) - centre);
}

/// The swinging foot's ankle goes on a cubic from where it stood last to where it comes down, at both ends at the floor's
/// velocity since the pitch does not change there, and a bump above it.
Vec3 left_ankle(double phase) {
    const double pitch = angle_at(foot_pitch, phase);
    if (phase < stance) return standing_ankle(phase, pitch);
    const Vec3 from = standing_ankle(stance, angle_at(foot_pitch, stance)), to = standing_ankle(0.0, angle_at(foot_pitch, 0.0));
    const double s = (phase - stance) / (1.0 - stance), bump = 16.0 * s * s * (1.0 - s) * (1.0 - s);
    const Vec3 floor(0.0, 0.0, -walk_speed * walk_period * (1.0 - stance));
    const double start = s * (1.0 - s) * (1.0 - s), end = -s * s * (1.0 - s);
    return from + eased(s) * (to - from) + (start + end) * floor + Vec3(0.0, ankle_rise * bump, 0.0);
}

/// Turns of the left hip and knee that bring the ankle to a place. With u the thigh and w the shank, a knee turned by k about x
/// makes the leg v = u + R_x(k) w, of the length that is asked for where u.R_x(k) w = u_x w_x + p cos(k - k0) has its value. The
/// hip first swings it about x to the right z, then spreads it about z. Returns how the shank is turned in the world.
Quaterniond place_left_leg(const Pelvis& pelvis, const Vec3& ankle, MannequinPose& pose) {
    const Vec3 root = place(joint::hips), thigh = place(joint::knee) - place(joint::hip);
    const Vec3 shank = place(joint::ankle) - place(joint::knee);
    const Vec3 wanted = pelvis.rotation.inverse() * (ankle - root - pelvis.translation) - (place(joint::hip) - root);
    const double c = thigh[1] * shank[1] + thigh[2] * shank[2], s = thigh[2] * shank[1] - thigh[1] * shank[2];
    const double product = 0.5 * (wanted.squaredNorm() - thigh.squaredNorm() - shank.squaredNorm()) - thigh[0] * shank[0];
    const double knee = std::atan2(s, c) + std::acos(product / std::hypot(c, s));
    const Vec3 leg = thigh + turn_x(knee) * shank;
    const double swing = std::atan2(leg[2], -leg[1]) - std::asin(wanted[2] / std::hypot(leg[1], leg[2]));
    const Vec3 swung = turn_x(swing) * leg;
    const double spread = std::atan2(wanted[1], wanted[0]) - std::atan2(swung[1], swung[0]);
    const Quaterniond hip = turn_z(spread) * turn_x(swing);
    pose.rotations[joint::hip] = rotation(hip);
    pose.rotations[joint::knee] = rotation(turn_x(knee));
    return pelvis.rotation * hip * turn_x(knee);
}

/// Only the left side's joints are turned.
MannequinPose left_side(double phase) {
    const Pelvis pelvis = pelvis_at(phase);
    MannequinPose pose;
    const Quaterniond shank = place_left_leg(pelvis, left_ankle(phase), pose);
    pose.rotations[joint::ankle] = rotation(shank.inverse() * turn_x(-angle_at(foot_pitch, phase)));
    pose.rotations[joint::toes] = rotation(turn_x(-angle_at(toe_pitch, phase)));
    const double forwards = -std::cos(2.0 * pi * (phase - 0.03));
    pose.rotations[joint::shoulder] = rotation(turn_x(-radians(3.0 + 19.0 * forwards)) * turn_z(-radians(18.0)));
    pose.rotations[joint::elbow] = rotation(turn(elbow_axis(), radians(20.0 + 9.0 * forwards)));
    return pose;
}

/// The trunk leans forwards, its upper half turns against the pelvis, and the head looks ahead.
void place_trunk(const Pelvis& pelvis, MannequinPose& pose) {
    const double lean = radians(3.0);
    pose.root_translation = pelvis.translation;
    pose.rotations[joint::hips] = rotation(pelvis.rotation);
    pose.rotations[joint::spine] = rotation(pelvis.rotation.inverse() * turn_x(lean));
    pose.rotations[joint::chest] = rotation(turn_y(-pelvis.yaw));
    pose.rotations[joint::neck] = rotation(turn_y(pelvis.yaw) * turn_x(-lean));
}

/// 0 ... 1: how far the arm is up.
double raised(double time) {
    const double s = std::clamp(std::min(time, wave_duration - time) / 0.75, 0.0, 1.0);
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

}  // namespace

MannequinPose walk_pose(double phase) {
    phase -= std::floor(phase);
    const double other = phase < 0.5 ? phase + 0.5 : phase - 0.5;
    const MannequinPose right = mirrored_pose(left_side(other));
    MannequinPose pose = left_side(phase);
    for (int j = joint::clavicle; j <= joint::toes; ++j) pose.rotations[mirrored_joint(j)] = right.rotations[mirrored_joint(j)];
    place_trunk(pelvis_at(phase), pose);
    return pose;
}

MannequinPose wave_pose(double time) {
    const double up = raised(time), swing = std::sin(2.0 * pi * 3.0 * (time - 0.5) / 1.5);
    const Vec3 axis = bone(joint::shoulder, joint::elbow);
    MannequinPose pose;  // of the left arm
    pose.rotations[joint::clavicle] = rotation(turn_z(radians(20.0) * up));
    pose.rotations[joint::shoulder] = rotation(turn_z(radians(60.0) * up) * turn(axis, -radians(30.0) * up));
    pose.rotations[joint::upper_arm] = rotation(turn(axis, -radians(45.0) * up));
    pose.rotations[joint::elbow] = rotation(turn(elbow_axis(), radians(48.0 + 17.0 * swing) * up));
    return mirrored_pose(pose);
}

}  // namespace percale::scenes
