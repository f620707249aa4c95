#pragma once

#include <array>
#include <memory>
#include <span>

#include "world.h"

namespace percale {

std::shared_ptr<const YieldingMesh> yielding_mesh(const TriangleMesh& mesh);

/// Whether an obstacle may have these: finite, vertices at one place together, and neither if it does not yield.
bool are_dents_of(const ObstacleState& obstacle, std::span<const Vec3> dent, std::span<const Vec3> aim);

/// Whether some obstacle yields.
bool any_yields(const Script& script);

/// Before a step of which the detector knows the motion that is wanted: where cloth would be left less room than kept_room, the
/// ends of obstacles that yield are moved apart. At a vertex of cloth that is pressed from A along a and from B along b, a . b <
/// -0.5, also through layers of cloth in between, the room at the end is r = d_A + d_B + a . (u_B - u_A), d the distances and u
/// the displacements of the points that press; what it lacks is taken off, half from each where both yield. Around these points
/// the surface goes along, (1 - (s/R)^2)^2 at a distance s. Dents go back by a quarter of a thickness, in each part of a divided
/// step, where nothing hinders them, and stay where nothing moves. The detector knows what becomes of it.
struct Pinches {
    int count = 0;                         // pressing points at which a surface gave way
    std::array<int, 2> obstacles{-1, -1};  // between which there is least room
};
Pinches yield_to_cloth(World& world);

/// m, world: how far the farthest vertex of an obstacle is from where it should be.
double deepest_dent(const Script& script);

}  // namespace percale
