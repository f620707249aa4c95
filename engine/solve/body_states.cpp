#include "body_states.h"

#include <algorithm>

namespace percale {
void BodyStates::settle_small() { std::replace(states_.begin(), states_.end(), BodyState::small, BodyState::settled); }

void BodyStates::release_joined(const ClothModel& model, const ContactRows& rows) {
    if (std::count(states_.begin(), states_.end(), BodyState::settled) == 0) return;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows.obstacle[row] >= 0) continue;
        const int first = body_of(model.bodies, rows.vertex[row][0]);
        for (int k = 1; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const int other = body_of(model.bodies, rows.vertex[row][k]);
            if (other != first) states_[first] = states_[other] = BodyState::moving;
        }
    }
}

}  // namespace percale
