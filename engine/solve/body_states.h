#pragma once

#include <vector>

#include "model/cloth_model.h"
#include "percale/contact.h"

namespace percale {

/// What Newton's method has come to with a body.
enum class BodyState : char {
    moving,   // the last direction changed it by more than is small
    small,    // it did not
    settled,  // it is solved for: it stays where it is while others are solved for
};

/// The bodies of a stage. They share linear systems, whose solver is as exact as the largest changes ask. A body that is solved
/// for already would be stirred up by what that leaves of it.
class BodyStates {
public:
    /// A solve begins: nothing is known.
    void start(const ClothModel& model) { states_.assign(model.bodies.size(), BodyState::moving); }

    bool settled(std::size_t body) const { return body < states_.size() && states_[body] == BodyState::settled; }

    /// Whether `is_small(body)` is true for each that is not settled; marks none.
    template <typename IsSmall>
    bool all_small(const ClothModel& model, const IsSmall& is_small) const {
        for (std::size_t b = 0; b < states_.size(); ++b) {
            if (states_[b] != BodyState::settled && !is_small(model.bodies[b])) return false;
        }
        return true;
    }

    /// Calls `is_small(body)` for those that are not settled; whether it was true for each.
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

    /// The change that was small has been made: these bodies are settled.
    void settle_small();

    /// Bodies that rows join with others are solved for together with them.
    void release_joined(const ClothModel& model, const ContactRows& rows);

private:
    std::vector<BodyState> states_;
};

}  // namespace percale
