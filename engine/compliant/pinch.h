#pragma once

#include <array>
#include <limits>
#include <vector>

#include "plan/scene.h"

namespace percale {

/// h of room more than is kept that deflections leave unused. 0: deflections go back and forth for ever. Larger: they stay larger
/// than necessary.
constexpr double deflection_slack = 0.2;

/// How far the pressing points of constraints have to go back, m; below 0: how much nearer they may come.
struct Retreats {
    std::vector<double> by_constraint;     // -infinity: nothing presses from the other side
    std::array<int, 2> obstacles{-1, -1};  // between which there is the smallest room
    double min_room = std::numeric_limits<double>::infinity();
};

/// At a vertex of cloth that is pressed from A along a and from B along b, a . b < -0.5, also through layers of cloth in between,
/// the room at the end of the step is r = d_A + d_B + a . (u_B - u_A), d the distances and u the displacements of the points that
/// press; what it lacks is taken off, half from each where both obstacles are compliant.
Retreats retreats_of(const ContactConstraints& constraints, const Script& script);

}  // namespace percale
