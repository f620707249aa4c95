#pragma once

#include <vector>

#include "body_states.h"
#include "forces/blocks.h"
#include "plan/scene.h"

namespace percale {

/// How bodies move as a whole in one linear system. Springs, and contact of a body with itself or with others that nothing
/// holds, do not resist a common translation: it is known exactly before the system is solved,
///
///     sum m dv = -sum r.
///
/// That of what touches an obstacle, or cloth that something holds, is not; nor is that of one body beside those it touches.
class Translations {
public:
    /// `blocks` are those of contact in the system.
    void find(const StepScene& scene, const BodyStates& states, const std::vector<CoupledBlock>& blocks);

    /// Adds to the direction dv, m/s, what is missing of the translations that are known. r is the residual, kg m/s.
    void correct(const ClothModel& model, const Vectors& residual, Vectors& direction) const;

    /// Calls `f(body)` for bodies that nothing holds and whose translation is not known.
    template <typename F>
    void for_each_open(const ClothModel& model, const F& f) const {
        for (std::size_t b = 0; b < group_.size(); ++b) {
            if (group_[b] == touching || (group_[b] >= 0 && shared(b))) f(model.bodies[b]);
        }
    }

private:
    static constexpr int held = -1, touching = -2;

    bool shared(std::size_t body) const;
    void join(int first, int second);

    std::vector<int> group_;  // of each body: the first of those it touches, if their translation is known; else held or touching
    int known_ = 0;           // how many are known
};

}  // namespace percale
