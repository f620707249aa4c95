#pragma once

#include "percale/mesh.h"
#include "potential.h"

namespace percale {

/// What the stiffness of a vertex in contact follows from: nothing that changes with the state, the step or the scheme.
struct ContactScale {
    double weight = 0.0;   // N, mass times gravity; that of the earth where the scene has none
    double modulus = 0.0;  // N/m, E of the cloth: the larger one of warp and weft
    double length = 0.0;   // m, L: root of the vertex' area
};

/// m/s^2, for ContactScale::weight, in a scene with that gravity.
double contact_gravity(const Vec3& gravity);

/// The stiffness of a vertex against an obstacle, and of one side of a contact between cloths (potential.h):
///     a = 1500 weight/h,   b = 4 E L/h.
/// By a, n sheets that lie on a floor rest at h (1 - sqrt(n/1500)) or more. By b, cloth stretched by e, which presses with
/// E e L^2/R on a body of radius R and with 1.4 E e L on a square edge, rests at h/2 or more where L < R/(4 e), and at
/// h/(1.5 + 2.9 e) or more on the edge.
ContactStiffness contact_stiffness(const ContactScale& vertex, double thickness);

/// Of both sides of a contact between cloths, in series.
ContactStiffness in_series(const ContactStiffness& first, const ContactStiffness& second);

}  // namespace percale
