#pragma once

#include <span>
#include <vector>

#include "body_states.h"
#include "forces/blocks.h"
#include "plan/scene.h"

namespace percale {

/// Motion of whole bodies in one linear system. Springs, and contact of a body with itself or with others that nothing
/// holds, do not resist a common translation: it is known exactly before the system is solved,
///
///     sum m dv = -sum r.
///
/// It is not known for bodies in contact with an obstacle or with cloth that is pinned or settled, nor in wind; for bodies in
/// contact with each other only the common one is known. A block resists where it acts on a common translation.
class RigidModeCorrection {
public:
    /// Sorts the bodies into groups; the blocks are those of the system.
    void find(const StepScene& scene, const BodyStates& states, const CoupledBlocks& coupled, const OuterBlocks& outer);

    /// Adds to the direction dv, m/s, what it lacks of each known translation. r is the residual, kg m/s.
    void correct(const ClothModel& model, const Vec3Arrays& residual, Vec3Arrays& direction);

    /// Calls `f(body)` for bodies that nothing holds and whose translation is not known.
    template <typename F>
    void for_each_open(const ClothModel& model, const F& f) const {
        for (std::size_t b = 0; b < group_.size(); ++b) {
            if (group_[b] == resisted || (group_[b] >= 0 && members_[group_[b]] > 1)) f(model.bodies[b]);
        }
    }

private:
    static constexpr int held = -1, resisted = -2;

    void join_all(const std::vector<Body>& bodies, std::span<const int> vertices);
    void resist(int body);
    void join(int first, int second);
    void replace(int group, int by);

    std::vector<int> group_;  // of each body: the lowest number in its group, if the translation is known; else held or resisted
    std::vector<int> members_;   // of each group
    std::vector<double> mass_;   // kg, likewise
    std::vector<Vec3> missing_;  // kg m/s, momentum that dv lacks, likewise
    int known_ = 0;              // number of bodies with a known translation
};

}  // namespace percale
