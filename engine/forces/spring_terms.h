#pragma once

#include "kernels/kernels.h"
#include "model/adjacency.h"
#include "model/vectors.h"

namespace percale {

/// What the springs are during one step, in the layout of the adjacency: tension T = k (l - l_rest) + c (v_ij . d), with
/// d = x_ij / |x_ij|.
struct StepSprings {
    const Adjacency* adjacency = nullptr;
    SpringEntries entries;                         // k N/m, l_rest m, c N s/m
    bool velocity_damping = false;                 // there is a c
    AlignedVector<double> stiffness, rest_length;  // of this step, where they are not those of the model
    AlignedVector<double> seam_rest_length;        // m, where seams have changed theirs
    const double* undamped_rest_length = nullptr;  // m, of each place: without damping
    AlignedVector<double> points;                  // work space
};

/// What an evaluation leaves behind: the blocks of the step matrix, and work space.
struct SpringTerms {
    /// kg: -dt^2 Jq - dt Jv between the two vertices of each spring, made positive definite, is a I + w w^T (spring_block).
    AlignedVector<float> values;
    AlignedVector<float> corners;  // what couples the edges of membrane triangles (CornerFillPass); empty without
    AlignedVector<double> points, motion, scratch;
};

/// The state that springs see; dt in s scales the matrix terms.
struct SpringMotion {
    const Vectors& positions;
    const Vectors& velocities;
    double dt;
};

}  // namespace percale
