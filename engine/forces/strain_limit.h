#pragma once

#include "force_term.h"
#include "model/strain_limits.h"
#include "springs.h"

namespace percale {

/// Limited edges, after evaluate_springs at the same state: forces += -T/l x, N, and with `with_matrix` dt^2 k along the edge
/// and dt^2 T/l across it, where T > 0. Returns the energy sum T^2/2k, J.
double evaluate_limits(const Compute& compute, const ClothModel& model, const SpringMotion& motion, bool with_matrix,
                       Vec3Arrays& forces, SpringTerms& terms);

/// It follows springs and membranes in the list.
const ForceTerm& strain_limit_term();

}  // namespace percale
