#pragma once

#include "force_term.h"
#include "model/membrane.h"
#include "springs.h"

namespace percale {

/// Triangles of membranes, after evaluate_springs at the same state: forces += those of the triangles, N, and with `with_matrix`
/// their part of the matrix in terms. With s_e = l_e^2 - L_e^2 and t_e = 2 (K s)_e an edge pulls with t_e x_e; -dt^2 Jq is dt^2
/// t_e I on the edge, taken as 0 where t_e < 0, which makes the sum positive definite, and 4 dt^2 K_ef x_e x_f^T between the
/// edges of a triangle. Returns the energy sum 1/2 s.K s, J. A triangle that is compressed to less than about 0.58 of its length
/// resists less and less (St. Venant-Kirchhoff), and not at all when it turns inside out.
double evaluate_membrane(const Compute& compute, const Adjacency& adjacency, const SpringMotion& motion, bool with_matrix,
                         Vec3Arrays& forces, SpringTerms& terms);

/// Elastic energy of all triangles, J.
double membrane_energy(const std::vector<MembraneTriangle>& triangles, const Vec3Arrays& positions);

/// It follows springs in the list.
const ForceTerm& membrane_term();

}  // namespace percale
