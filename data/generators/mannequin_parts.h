#pragma once

#include <span>

#include "percale/mesh.h"

// What the mannequin is put together from. Lengths in m; it stands on y = 0 and faces +z.
namespace percale::scenes {

/// The hull of two spheres. `blend`: range of the smooth minimum with the parts before it in its list, m.
struct BodyPart {
    Vec3 from, axis;  // axis: unit, towards the second sphere
    double length, radius_from, radius_to;
    double sine, cosine;  // of the slope of its side
    double blend;

    Vec3 to() const { return from + length * axis; }
};

/// Skull, face, neck; on the plane x = 0.
std::span<const BodyPart> head_parts();
/// Rib cage, waist, pelvis, seat, shoulder girdle, breast; the left half, x > 0, as arm and leg.
std::span<const BodyPart> trunk_parts();
/// Upper arm, forearm, its muscle, and the hand.
std::span<const BodyPart> arm_parts();
/// Thigh, shank, calf, and the foot.
std::span<const BodyPart> leg_parts();

/// C2 smooth minimum: min(a, b) - h^3 blend / 6 with h = max(0, 1 - |a - b| / blend). Symmetric in a and b; blend >= 0.
double smooth_minimum(double a, double b, double blend);

/// Signed distance to parts, joined in their order; not empty.
double parts_distance(std::span<const BodyPart> parts, const Vec3& point);

/// The same of parts and their mirror image at x = 0, joined with `blend`.
double both_sides_distance(std::span<const BodyPart> parts, const Vec3& point, double blend);

/// Distance to head and trunk: the mannequin without its limbs.
double core_distance(const Vec3& point);

}  // namespace percale::scenes
