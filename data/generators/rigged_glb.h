#pragma once

#include <span>
#include <string>
#include <vector>

#include "generators/mannequin_rig.h"

// A rigged mesh and how it moves, as a file that other programs read.
namespace percale::scenes {

/// Poses at times, between which players interpolate: translations on straight lines, rotations by the shortest turn.
struct Clip {
    std::string name;
    std::vector<double> times;  // s, ascending, the first 0
    std::vector<MannequinPose> poses;
};

/// A clip of poses at even times from 0 to `duration` (s, > 0), both included; keys >= 2.
template <class PoseAt>
Clip sampled_clip(const std::string& name, double duration, int keys, PoseAt pose_at) {
    Clip clip{name, {}, {}};
    for (int k = 0; k < keys; ++k) {
        clip.times.push_back(duration * k / (keys - 1));
        clip.poses.push_back(pose_at(clip.times.back()));
    }
    return clip;
}

/// The bytes of a binary glTF 2.0 file: one skinned mesh of that name, its vertices in their order, the joints as nodes, and
/// every clip as an animation that sets the rotation of every joint and the translation of the root, so that nothing of another
/// clip stays. The rig must have one root, its first joint. Rotations and the root's places are rounded to 1e-6: the same bytes
/// from every compiler. Throws SceneError for more than 65535 vertices.
std::string rigged_glb(const std::string& name, const Rig& rig, std::span<const Clip> clips);

/// Walk and wave of the mannequin, as data/meshes/mannequin.glb has them: a key every 1/40 s, between which they are within 3 mm
/// of the motion.
std::vector<Clip> mannequin_clips();

}  // namespace percale::scenes
