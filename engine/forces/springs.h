#pragma once

#include <span>

#include "force_term.h"
#include "kernels/compute.h"
#include "model/adjacency.h"
#include "model/spring_network.h"
#include "model/vec3_arrays.h"
#include "percale/settings.h"

namespace percale {

/// The start of a step, and its length.
struct SpringStart {
    const Adjacency& adjacency;
    const Vec3Arrays& positions;  // m, at the start: l_n follows
    DampingForm form;
    double dt;                                 // s
    std::span<const double> rest_length = {};  // ClothState::rest_length, of the springs of `network`
    const SpringNetwork* network = nullptr;    // needed where rest_length is not empty
};

/// DampingForm::velocity: k = ks, l_rest = l0, c = kd.
/// DampingForm::length_rate: damping as the rate of the length over the step, kd (l - l_n)/dt, makes each spring exactly one with
/// k = ks + kd/dt, l_rest = (ks l0 + kd l_n/dt)/k and c = 0: an exact potential with a symmetric Hessian.
/// The result is a view of the adjacency, which must live as long.
void set_step_springs(const Compute& compute, const SpringStart& start, StepSprings& springs);

/// forces += spring forces -T d - b x, N (b: the pair's bending); with `with_matrix` also terms.values. Along d the matrix is
/// dt^2 k + dt c, across it dt^2 T/l, which is taken as 0 where the spring is compressed (T < 0) and capped where damping makes
/// it exceed the first; dt^2 b in all directions. A spring shorter than 1e-18 m has no direction: it exerts no force, its matrix
/// is (dt^2 k + dt c) I. Returns the potential sum 1/2 k (l - l_rest)^2 + 1/2 b l^2, J. The bits are the same for any
/// instruction set and number of threads.
double evaluate_springs(const Compute& compute, const StepSprings& springs, const SpringMotion& motion, bool with_matrix,
                        Vec3Arrays& forces, SpringTerms& terms);

/// The block a I + w w^T of a spring.
struct SpringBlock {
    double a;
    Vec3 w;
};
SpringBlock spring_block(const Adjacency& adjacency, const SpringTerms& terms, int spring);

/// The rest lengths of all springs, m: `changed` (ClothState::rest_length), or, where that is empty, the network's.
inline std::span<const double> rest_lengths(const SpringNetwork& network, std::span<const double> changed) {
    return changed.empty() ? std::span<const double>(network.rest_length) : changed;
}

/// Elastic energy sum 1/2 ks (l - l0)^2 of the network, J. `rest_length`: ClothState::rest_length.
double elastic_energy(const SpringNetwork& network, const Vec3Arrays& positions, std::span<const double> rest_length = {});

/// Largest (l - l0)/l0 over structural springs; 0 without any.
double largest_strain(const SpringNetwork& network, const Vec3Arrays& positions);
/// The same for springs at `count` vertices from number `first` on.
double largest_strain(const SpringNetwork& network, const Vec3Arrays& positions, int first, int count);

/// The term of springs of all kinds, seams among them, and of the flat part of hinges.
const ForceTerm& spring_term();

}  // namespace percale
