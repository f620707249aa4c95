#include "rigid_mode_correction.h"

#include <algorithm>

#include "linear/block_matrix.h"

namespace percale {
namespace {

/// Rounding of the sum of a block's parts that counts as 0, over the sum of their lengths.
constexpr double zero_sum_ratio = 1e-9;

bool resists_translation(const OuterBlocks::Block& block) {
    Vec3 sum = Vec3::Zero();
    double length = 0.0;
    for (const Vec3& g : block.gradient) {
        sum += g;
        length += g.norm();
    }
    return sum.norm() > zero_sum_ratio * length;
}

/// Whether a body that is being solved is held by nothing.
bool drifts(const StepScene& scene, const BodyStates& states, std::size_t number) {
    if (states.settled(number)) return false;
    const Body& body = scene.model.bodies[number];
    for (int i = body.first; i < body.first + body.count; ++i) {
        if (!scene.is_free(i)) return false;
    }
    return true;
}

}  // namespace

void RigidModeCorrection::find(const StepScene& scene, const BodyStates& states, const CoupledBlocks& coupled,
                               const OuterBlocks& outer) {
    const std::vector<Body>& bodies = scene.model.bodies;
    const int count = static_cast<int>(bodies.size());
    group_.resize(bodies.size());
    known_ = 0;
    for (int b = 0; b < count; ++b) {
        group_[b] = drifts(scene, states, b) ? b : held;
        known_ += group_[b] >= 0;
    }
    for (std::size_t number = 0; number < coupled.size() && known_ > 0; ++number) {
        const CoupledBlock& block = coupled[number];
        if (!between_cloths(block)) resist(body_of(bodies, block.vertex[0]));
        join_all(bodies, {block.vertex.begin(), std::ranges::find(block.vertex, -1)});
    }
    for (int number = 0; number < outer.size() && known_ > 0; ++number) {
        const OuterBlocks::Block block = outer[number];
        if (resists_translation(block)) resist(body_of(bodies, block.vertex[0]));
        join_all(bodies, block.vertex);
    }
    members_.assign(bodies.size(), 0);
    for (const int group : group_) {
        if (group >= 0) ++members_[group];
    }
}

void RigidModeCorrection::join_all(const std::vector<Body>& bodies, std::span<const int> vertices) {
    const int first = body_of(bodies, vertices[0]);
    for (const int vertex : vertices.subspan(1)) join(first, body_of(bodies, vertex));
}

/// Something resists the translation of a body, and thus that of its group.
void RigidModeCorrection::resist(int body) {
    if (group_[body] >= 0) replace(group_[body], resisted);
}

/// Two bodies are in contact with each other.
void RigidModeCorrection::join(int first, int second) {
    const int a = group_[first], b = group_[second];
    if (a == b) return;
    if (a >= 0 && b >= 0) return replace(std::max(a, b), std::min(a, b));
    resist(first);
    resist(second);
}

void RigidModeCorrection::replace(int group, int by) {
    for (int& of : group_) {
        if (of != group) continue;
        of = by;
        known_ -= by < 0;
    }
}

void RigidModeCorrection::correct(const ClothModel& model, const Vec3Arrays& residual, Vec3Arrays& direction) {
    mass_.assign(group_.size(), 0.0);
    missing_.assign(group_.size(), Vec3::Zero());
    const auto for_each_known = [&](const auto& f) {
        for (std::size_t b = 0; b < group_.size(); ++b) {
            const Body& body = model.bodies[b];
            if (group_[b] < 0) continue;
            for (int i = body.first; i < body.first + body.count; ++i) f(i, group_[b]);
        }
    };
    for_each_known([&](int i, int group) { missing_[group] -= residual.at(i) + model.mass[i] * direction.at(i); });
    for (std::size_t b = 0; b < group_.size(); ++b) {
        if (group_[b] >= 0) mass_[group_[b]] += model.bodies[b].mass;
    }
    for_each_known([&](int i, int group) { direction.add(i, missing_[group] / mass_[group]); });
}

}  // namespace percale
