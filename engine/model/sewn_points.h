#pragma once

#include <span>
#include <vector>

#include "hinges.h"
#include "percale/stitch.h"
#include "spring_network.h"
#include "vec3_arrays.h"

namespace percale {

/// A vertex sewn to a point between two others. With u = x_i - (1 - t) x_j - t x_k it stores 1/2 k |u - l d|^2: l is the length
/// that closing has left, d the direction of u when closing began. As the weights of u sum to 0, 1/2 k |u|^2 = 1/2 sum b |x_a -
/// x_b|^2 over its three pairs: (i, j) has b = k (1 - t), (i, k) k t and (j, k) -k t (1 - t).
struct SewnPoint {
    Stitch stitch;                  // in the numbers of the system
    double stiffness = 0.0;         // k, N/m
    Vec3 direction = Vec3::Zero();  // d, unit; zero where there was nothing to close
    int spring = -1;                // of the network, pair (i, j): its rest length is l
    int pair = -1;                  // pair (i, k); (j, k) is the next
};

/// The vector from the point of a stitch to its vertex, m.
Vec3 stitch_gap(const Stitch& stitch, const Vec3Arrays& positions);

/// u of a point, m.
Vec3 sewn_gap(const SewnPoint& point, const Vec3Arrays& positions);

/// Energy of a point whose target distance is `length` (l), J.
double sewn_energy(const SewnPoint& point, double length, const Vec3Arrays& positions);

/// network.bending += b of all pairs, N/m.
void add_sewn_pairs(std::span<const SewnPoint> points, SpringNetwork& network);

/// Removes all stiffness of springs between vertices that the stitches of their cloth join to one, and of hinges of triangles
/// with such an edge: at length 0 a spring has no direction and pushes where rounding decides, and triangles without area do not
/// bend. Part of finish_model.
void leave_out_sewn_edges(std::span<const int> cloth_of_vertex, SpringNetwork& springs, Hinges& hinges);

}  // namespace percale
