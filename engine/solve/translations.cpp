#include "translations.h"

#include <algorithm>
#include <numeric>

namespace percale {
namespace {

/// Whether a body that is solved for is held by nothing.
bool drifts(const StepScene& scene, const BodyStates& states, std::size_t number) {
    if (states.settled(number)) return false;
    const Body& body = scene.model.bodies[number];
    for (int i = body.first; i < body.first + body.count; ++i) {
        if (!scene.is_free(i)) return false;
    }
    return true;
}

/// Weights sum to 1 against an obstacle and to 0 between cloths.
bool is_between_cloths(const CoupledBlock& block) {
    return std::abs(std::accumulate(block.weight.begin(), block.weight.end(), 0.0)) < 0.5;
}

}  // namespace

void Translations::find(const StepScene& scene, const BodyStates& states, const std::vector<CoupledBlock>& blocks) {
    const std::vector<Body>& bodies = scene.model.bodies;
    group_.resize(bodies.size());
    known_ = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        group_[b] = !drifts(scene, states, b) ? held : scene.plan.wind ? touching : static_cast<int>(b);
        known_ += group_[b] >= 0;
    }
    for (const CoupledBlock& block : blocks) {
        if (known_ == 0) return;
        const int first = body_of(bodies, block.vertex[0]);
        if (!is_between_cloths(block)) join(first, -1);
        for (int k = 1; k < 4 && block.vertex[k] >= 0; ++k) join(first, body_of(bodies, block.vertex[k]));
    }
}

/// These two, or one and what is held (-1), touch each other: so do their groups.
void Translations::join(int first, int second) {
    const int a = group_[first], b = second < 0 ? held : group_[second];
    if (a == b) return;
    const int together = a >= 0 && b >= 0 ? std::min(a, b) : touching;
    for (int& group : group_) {
        if (group < 0 || (group != a && group != b)) continue;
        group = together;
        known_ -= together < 0;
    }
}

bool Translations::shared(std::size_t body) const { return std::count(group_.begin(), group_.end(), group_[body]) > 1; }

void Translations::correct(const ClothModel& model, const Vectors& residual, Vectors& direction) const {
    for (std::size_t first = 0; first < group_.size(); ++first) {
        if (group_[first] != static_cast<int>(first)) continue;
        Vec3 missing = Vec3::Zero();
        double mass = 0.0;
        const auto for_each_vertex = [&](const auto& f) {
            for (std::size_t b = first; b < group_.size(); ++b) {
                if (group_[b] != static_cast<int>(first)) continue;
                const Body& body = model.bodies[b];
                for (int i = body.first; i < body.first + body.count; ++i) f(i);
            }
        };
        for (std::size_t b = first; b < group_.size(); ++b)
            mass += group_[b] == static_cast<int>(first) ? model.bodies[b].mass : 0.0;
        for_each_vertex([&](int i) { missing -= residual.at(i) + model.mass[i] * direction.at(i); });
        for_each_vertex([&](int i) { direction.add(i, missing / mass); });
    }
}

}  // namespace percale
