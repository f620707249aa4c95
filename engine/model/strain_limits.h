#pragma once

#include <span>
#include <vector>

#include "adjacency.h"
#include "kernels/kernels.h"
#include "spring_network.h"
#include "support/aligned.h"
#include "vec3_arrays.h"

namespace percale {

/// An edge that resists beyond a length L: it pulls with T = max(0, h + k (l - L)) on top of its spring. h is a multiplier of
/// the constraint l <= L, to which each step adds a fraction of k (l - L), so that at rest l is L although k is only a few times
/// the edge's own stiffness (method of multipliers for inequalities: Rockafellar 1973, Mathematical Programming 5). It stores
/// T^2/2k.
struct LimitedEdge {
    int spring = 0;          // of the network
    int entry[2] = {0, 0};   // in the slices, at both ends
    double length = 0.0;     // L, m
    double stiffness = 0.0;  // k, N/m
    double max_hold = 0.0;   // N, up to which h grows
    double hold = 0.0;       // h, N
};

/// The limited edges of a model, and the same in the layout of the kernels, one number an entry of the adjacency's slices.
struct StrainLimits {
    std::vector<LimitedEdge> edges;
    AlignedVector<double> slack_square, length, stiffness, hold;  // LimitEntries

    bool empty() const { return edges.empty(); }
    LimitEntries entries() const { return {slack_square.data(), length.data(), stiffness.data(), hold.data()}; }

    /// Sets the hold of an edge, N.
    void set_hold(LimitedEdge& edge, double hold_now);
};

/// T of an edge, N.
double limit_tension(const LimitedEdge& edge, const SpringNetwork& network, const Vec3Arrays& positions);

/// Energy of all, J.
double limit_energy(const StrainLimits& limits, const SpringNetwork& network, const Vec3Arrays& positions);

/// Adds a fraction of k (l - L) to the hold of each edge. Returns the increase of their energy, J.
double tighten(StrainLimits& limits, const SpringNetwork& network, const Vec3Arrays& positions, double fraction);

/// Limits the structural springs whose `strain` is not 0, of the network that the adjacency was made for, which is in slices.
/// The holds of earlier edges stay.
void set_strain_limits(const SpringNetwork& network, std::span<const double> strain, const Adjacency& adjacency,
                       StrainLimits& limits);

}  // namespace percale
