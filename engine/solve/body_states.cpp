#include "body_states.h"

#include <algorithm>

namespace percale {
namespace {

int body_of(const ClothModel& model, int vertex) {
    const auto ends_before = [&](const Body& body) { return body.first + body.count <= vertex; };
    return static_cast<int>(std::partition_point(model.bodies.begin(), model.bodies.end(), ends_before) - model.bodies.begin());
}

}  // namespace

void BodyStates::settle_small() { std::replace(states_.begin(), states_.end(), BodyState::small, BodyState::settled); }

void BodyStates::release_joined(const ClothModel& model, const ContactRows& rows) {
    if (std::count(states_.begin(), states_.end(), BodyState::settled) == 0) return;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows.obstacle[row] >= 0) continue;
        const int first = body_of(model, rows.vertex[row][0]);
        for (int k = 1; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const int other = body_of(model, rows.vertex[row][k]);
            if (other != first) states_[first] = states_[other] = BodyState::moving;
        }
    }
}

}  // namespace percale
