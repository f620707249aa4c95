#pragma once

#include <array>
#include <vector>

#include "friction.h"
#include "model/vectors.h"
#include "percale/contact.h"
#include "forces/symmetric_block.h"

namespace percale {

/// Potential of one contact in the raw distance d, with thickness h and stiffness k: 0 from h on, 1/2 k (h - d)^2 down to
/// h/2, logarithmic below, so that it grows without bound as d -> 0. Twice continuously differentiable but for the jump of the
/// second derivative at h. `slope` is -dP/dd >= 0, N; `curvature` d2P/dd2 >= 0, N/m.
struct ContactPotential {
    double energy = 0.0, slope = 0.0, curvature = 0.0;
};
ContactPotential contact_potential(double distance, double thickness, double stiffness);

/// The block diagonal of a step matrix: six arrays xx xy xz yy yz zz, kg.
struct DiagonalBlocks {
    AlignedVector<double> data;
    std::size_t padded = 0;

    void resize(std::size_t padded_size) {
        padded = padded_size;
        data.assign(6 * padded, 0.0);
    }
    const double* operator[](int entry) const { return data.data() + entry * padded; }
    SymmetricBlock block(int i) const {
        SymmetricBlock k;
        for (std::size_t entry = 0; entry < 6; ++entry) k[entry] = data[entry * padded + i];
        return k;
    }
};

/// What the contact term needs of the step it is in.
struct ContactStep {
    double dt = 0.0;                            // s, of the part of the step being solved
    double stiffness_dt = 0.0;                  // s, that the share of the masses is made for, where longer than dt
    double obstacle_rate = 0.0;                 // 1/s, obstacle velocity / obstacle_displacement
    double fraction = 0.0;                      // of the whole step, where obstacles are
    Vec3 gravity = Vec3::Zero();                // m/s^2
    const std::vector<double>* mass = nullptr;  // kg, of each vertex
    const DiagonalBlocks* diagonal = nullptr;   // of the elastic step matrix when the step began; frozen
    const Vectors* load = nullptr;              // N, forces without contact when the step began; null: gravity alone
    const FrictionStart* friction = nullptr;    // null: without friction
    const Touches* previous = nullptr;          // of the point that the search came from; null at the first evaluation
};

/// One row's part of the step matrix: weight w_k w_l K between its vertices, K symmetric, kg.
struct ContactBlock {
    std::array<int, 4> vertex;  // -1 = unused
    std::array<double, 4> weight;
    SymmetricBlock k;
    int row = -1;  // -1: friction of a vertex with all its rows
};

struct ContactTerms {
    std::vector<ContactBlock> blocks;  // first `others`, then of the rows, then one of friction for each touch
    std::size_t others = 0;            // blocks of single vertices that other forces put there; contact keeps them
    Touches touches;
    double energy = 0.0;             // J, without friction
    double largest_stiffness = 0.0;  // N/m
    double obstacle_power = 0.0;     // W, of the obstacles on the cloth
    double rubbing_power = 0.0;      // W, that friction between cloths takes
};

/// Penalty springs with Coulomb friction. forces += contact forces, N; fills `terms`. Between cloths the velocity is the relative
/// one, and n.A n and masses are those of both sides in series, 1/sum w^2/a.
/// Stiffness of a row: half of n.A n/dt^2 summed over its vertices by weight, A the frozen diagonal blocks (the share of the
/// masses for `stiffness_dt`, unless the obstacle moves: a step that is suddenly shorter must not throw up what lies there), but
/// at least four times (weight on the row, or what its vertices press with)/thickness, so that cloth rests at no less than 3/4 of
/// the thickness. Friction with obstacles acts on vertices (friction.h), each pressed by its share of all rows with the same
/// obstacle; in the matrix a sliding one is free along its slip.
void add_contact(const ContactRows& rows, const ContactStep& step, const Vectors& positions, Vectors& forces,
                 ContactTerms& terms);

/// Obstacles go on to their ends while the cloth moves: a row's distance changes by n.(dx - dp), dp the way its obstacle point
/// still has, so a Newton direction solves A dv = -r + dt P''(d) n n.dp. Adds the last term where `free` is 1; the blocks of rows
/// hold dt^2 P'' n n^T. `rate`: the part of the whole step still to come over dt, 1/s.
void add_obstacle_advance(const ContactRows& rows, const ContactTerms& terms, double rate, const AlignedVector<double>& free,
                          Vectors& right_side);

}  // namespace percale
