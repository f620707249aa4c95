#pragma once

#include <array>
#include <memory>
#include <span>

#include "percale/report.h"
#include "plan/scene.h"

namespace percale {

std::shared_ptr<const CompliantMesh> compliant_mesh(const TriangleMesh& mesh);

/// Whether an obstacle may have these deflections: finite, equal for vertices at one place, and none if it is not compliant.
bool are_deflections_of(const ObstacleState& obstacle, std::span<const Vec3> deflection, std::span<const Vec3> aim);

/// Whether some obstacle is compliant.
bool any_compliant(const Script& script);

/// Called before a step of which the detector knows the wanted motion: where cloth would be left less room than is kept, the ends
/// of compliant obstacles are moved apart (pinch.h). Around the points that press the surface goes along, (1 - (s/R)^2)^2 at a
/// distance s. Deflections return by a quarter of a thickness, in each part of a divided step, where nothing prevents it, and
/// stay where nothing moves. The detector knows the new ends afterwards.
struct Pinches {
    int count = 0;                         // pressing points at which a surface gave way
    std::array<int, 2> obstacles{-1, -1};  // between which there is the smallest room
};
Pinches comply_with_cloth(StepScene& scene, const ClothState& cloth);

/// Whether a compliant obstacle that closes on the cloth failed a step.
bool complies_in_vain(const Script& script, const StepReport& report);

/// Largest deflection, m, world: how far the farthest vertex of an obstacle is from where it should be.
double largest_deflection(const Script& script);

}  // namespace percale
