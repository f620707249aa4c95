#include "body_states.h"

#include <algorithm>

namespace percale {
void BodyStates::settle_small() { std::replace(states_.begin(), states_.end(), BodyState::small, BodyState::settled); }

void BodyStates::release_joined(const ClothModel& model, const ContactConstraints& constraints) {
    if (std::count(states_.begin(), states_.end(), BodyState::settled) == 0) return;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        if (constraints.obstacle[constraint] >= 0) continue;
        const int first = body_of(model.bodies, constraints.vertex[constraint][0]);
        for (int k = 1; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
            const int other = body_of(model.bodies, constraints.vertex[constraint][k]);
            if (other != first) states_[first] = states_[other] = BodyState::moving;
        }
    }
}

}  // namespace percale
