#pragma once

#include "percale/mesh.h"

namespace percale::certificate {

// Signs of determinants, exact: a forward error bound on the double result decides nearly always, floating-point expansions
// (Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates) decide the rest.
// Range: finite coordinates; within one call the nonzero magnitudes may span up to 190 powers of ten. Needs IEEE doubles in
// round-to-nearest with subnormals, compiled without contraction or fast-math.

/// Sign (-1, 0, 1) of (b - a) x (c - a) in the plane of the two axes that follow `axis` cyclically (0 -> y z, 1 -> z x, 2 -> x
/// y): the sign of component `axis` of the normal of abc. axis 0 ... 2.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

/// Sign (-1, 0, 1) of ((b - a) x (c - a)) . (d - a): 1 where d lies on the side to which the normal of abc points.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// An axis along which abc projects to a triangle with area; -1 where the three points are collinear.
int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace percale::certificate
