#pragma once

#include <vector>

#include "model/cloth_model.h"
#include "percale/contact.h"

namespace percale {

/// The progress of Newton's method on a body.
enum class BodyState : char {
    moving,   // the last direction changed it by more than is small
    small,    // the last direction changed it by little
    settled,  // it is solved: it stays where it is while others are solved
};

/// The bodies of a stage. They share linear systems, whose solver is as exact as the largest changes ask. The error that this
/// leaves would disturb a body that is already solved.
class BodyStates {
public:
    /// A solve begins with all bodies moving.
    void start(const ClothModel& model) { states_.assign(model.bodies.size(), BodyState::moving); }

    bool settled(std::size_t body) const { return body < states_.size() && states_[body] == BodyState::settled; }

    /// Whether `is_small(body)` is true for each body that is not settled; marks none.
    template <typename IsSmall>
    bool all_small(const ClothModel& model, const IsSmall& is_small) const {
        for (std::size_t b = 0; b < states_.size(); ++b) {
            if (states_[b] != BodyState::settled && !is_small(model.bodies[b])) return false;
        }
        return true;
    }

    /// Calls `is_small(body)` for each body that is not settled and marks it; returns whether it was true for all.
    template <typename IsSmall>
    bool mark(const ClothModel& model, const IsSmall& is_small) {
        bool all = true;
        for (std::size_t b = 0; b < states_.size(); ++b) {
            if (states_[b] == BodyState::settled) continue;
            states_[b] = is_small(model.bodies[b]) ? BodyState::small : BodyState::moving;
            all = all && states_[b] == BodyState::small;
        }
        return all;
    }

    /// The small changes have been made: these bodies are settled.
    void settle_small();

    /// Releases settled bodies that constraints join with others: they are solved together with these.
    void release_joined(const ClothModel& model, const ContactConstraints& constraints);

private:
    std::vector<BodyState> states_;
};

}  // namespace percale
