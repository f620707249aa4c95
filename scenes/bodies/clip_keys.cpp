#include "bodies/clip_keys.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

namespace percale::scenes {
namespace {

/// The keys before and after a tick, the weight of the second one, and the time between them.
struct Between {
    std::size_t before = 0, after = 0;
    double share = 0.0, time = 0.0;
};

/// `times`: at least one.
Between keys_at(std::span<const double> times, double tick) {
    const auto later = std::upper_bound(times.begin(), times.end(), tick);
    const auto number = static_cast<std::size_t>(later - times.begin());
    if (later == times.begin()) return {0, 0, 0.0, 0.0};
    if (later == times.end()) return {number - 1, number - 1, 0.0, 0.0};
    const double time = times[number] - times[number - 1];
    return {number - 1, number, (tick - times[number - 1]) / time, time};
}

/// Weights of value and outgoing tangent of the key before, value and incoming tangent of the key after: the cubic that has both
/// (Hermite), h00 x0 + h10 m0 + h01 x1 + h11 m1. Tangents are per tick.
struct Hermite {
    explicit Hermite(const Between& at)
        : x0((1.0 + 2.0 * at.share) * (1.0 - at.share) * (1.0 - at.share)),
          m0(at.time * at.share * (1.0 - at.share) * (1.0 - at.share)),
          x1(1.0 - x0),
          m1(at.time * at.share * at.share * (at.share - 1.0)) {}
    double x0, m0, x1, m1;
};

Eigen::Vector4d value(const ModelTrack& track, std::size_t number) { return Eigen::Vector4d::Map(track.values[number].data()); }

Eigen::Vector4d spline_at(const ModelTrack& track, const Between& at) {
    const Hermite h(at);
    return h.x0 * value(track, 3 * at.before + 1) + h.m0 * value(track, 3 * at.before + 2) +
           h.x1 * value(track, 3 * at.after + 1) + h.m1 * value(track, 3 * at.after);
}

Eigen::Vector3d vector_at(const ModelTrack& track, double tick, const Eigen::Vector3d& without) {
    if (track.times.empty()) return without;
    const Between at = keys_at(track.times, tick);
    if (track.interpolation == Interpolation::cubic) return spline_at(track, at).head<3>();
    const Eigen::Vector3d a = value(track, at.before).head<3>(), b = value(track, at.after).head<3>();
    return track.interpolation == Interpolation::step ? a : Eigen::Vector3d(a + at.share * (b - a));
}

Eigen::Quaterniond rotation_at(const ModelTrack& track, double tick) {
    if (track.times.empty()) return Eigen::Quaterniond::Identity();
    const Between at = keys_at(track.times, tick);
    const auto unit = [](const Eigen::Vector4d& q) { return Eigen::Quaterniond(q).normalized(); };
    if (track.interpolation == Interpolation::cubic) return unit(spline_at(track, at));
    const Eigen::Quaterniond before = unit(value(track, at.before));
    return track.interpolation == Interpolation::step ? before : before.slerp(at.share, unit(value(track, at.after)));
}

double last_of(const std::vector<double>& times) { return times.empty() ? 0.0 : times.back(); }

}  // namespace

Eigen::Matrix4d node_transform(const ModelChannel& channel, double tick) {
    const Eigen::Vector3d translation = vector_at(channel.translation, tick, Eigen::Vector3d::Zero());
    const Eigen::Vector3d scale = vector_at(channel.scale, tick, Eigen::Vector3d::Ones());
    return (Eigen::Translation3d(translation) * rotation_at(channel.rotation, tick) * Eigen::Scaling(scale)).matrix();
}

std::vector<double> morph_weights(const ModelMorphs& morphs, double tick) {
    if (morphs.times.empty()) return {};
    const Between at = keys_at(morphs.times, tick);
    const bool cubic = morphs.interpolation == Interpolation::cubic;
    const Hermite h(at);
    const double before = cubic ? h.x0 : morphs.interpolation == Interpolation::step ? 1.0 : 1.0 - at.share;
    std::vector<double> weights;
    const auto add = [&](std::size_t key, double share) {
        const std::vector<double>& values = morphs.weights[key];
        weights.resize(std::max(weights.size(), values.size()));
        for (std::size_t k = 0; k < values.size(); ++k) weights[k] += share * values[k];
    };
    add(cubic ? 3 * at.before + 1 : at.before, before);
    add(cubic ? 3 * at.after + 1 : at.after, 1.0 - before);
    if (cubic) add(3 * at.before + 2, h.m0);
    if (cubic) add(3 * at.after, h.m1);
    return weights;
}

double last_key(const ModelClip& clip) {
    double last = 0.0;
    for (const ModelChannel& channel : clip.channels)
        for (const ModelTrack* track : {&channel.translation, &channel.rotation, &channel.scale})
            last = std::max(last, last_of(track->times));
    for (const ModelMorphs& morphs : clip.morphs) last = std::max(last, last_of(morphs.times));
    return last;
}

}  // namespace percale::scenes
