#pragma once

#include <cstddef>

namespace percale {

/// Vertices a slice: the lanes of the widest pack of floats. All arrays of the kernels are padded to whole slices and aligned to
/// 64 bytes.
constexpr int slice_lanes = 16;

/// Kernels work on ranges of slices; sums are made chunk by chunk and added up in the chunks' order, so they have the same bits
/// for any number of threads and any instruction set.
constexpr int chunk_slices = 64;

enum class InstructionSet { baseline, avx2, avx512 };

/// A range of slices.
struct Slices {
    int first = 0, last = 0;
};

/// Three arrays of doubles, one value a vertex.
struct ConstAxes {
    const double *x, *y, *z;
};
struct Axes {
    double *x, *y, *z;
    [[gnu::always_inline]] operator ConstAxes() const { return {x, y, z}; }
};

/// Springs whose ends are one of a few numbers of vertices apart, as on a grid. Place i of a band is the spring between vertices
/// i and i + offset; its numbers stand at band * padded + i. Positions and the like are then not packed as points but copied to
/// three arrays of guard + padded + guard numbers, zero outside; blocks stand at 4 arrays a band of guard + padded numbers each.
struct BandPattern {
    static constexpr int max = 8;
    int count = 0;
    int offset[max] = {};  // > 0
    std::size_t padded = 0, guard = 0;
};

/// Entries in slices (sliced ELL): entry e of lane l of slice s stands at start[s] + e * slice_lanes + l. Padding refers to the
/// vertex itself.
struct EntryPattern {
    const int* start;  // slices + 1
    const int* other;
    const BandPattern* bands = nullptr;  // instead, if not null
};

/// The springs as every vertex sees them, one entry a spring end.
struct SpringEntries {
    EntryPattern pattern;
    const double *stiffness, *rest_length, *damping;  // N/m, m, N s/m
    const double* bending = nullptr;                  // N/m, b of the pair, of either sign; null: none
};

/// Springs with damping as a length rate: k = ks + kd/dt, l = (ks l0 + kd l_n/dt)/k.
struct StartPass {
    SpringEntries springs;
    ConstAxes positions;       // m, at the start of the step
    const double* points;      // the same, x y z 0 a vertex
    double dt;                 // s
    double *stiffness, *rest;  // results
};

/// One evaluation of all springs: T = k (l - l_rest) + c (v_ij . d), force -T d - b x.
struct SpringPass {
    SpringEntries springs;
    ConstAxes positions, velocities;  // m, m/s
    const double* points;             // positions as x y z 0 a vertex
    const double* motion;             // velocities likewise; null without damping by velocity
    double dt;                        // s
    Axes forces;                      // N, added to
    float* values;                    // kg: a wx wy wz, slice_lanes each, for every slice_lanes entries; null without matrix
    double* scratch;                  // with bands: 3 * count arrays of guard + the range's vertices
};

/// The block matrix D + sum over entries of (a I + w w^T) acting on differences x_i - x_j: y = A x.
struct BlockPass {
    EntryPattern pattern;
    const float* values;   // a and w of each entry
    const double* ground;  // D, one number a vertex
};

/// Vec3 arrays of floats: x, y, z one after the other, `padded` apart.
struct FloatVec3Arrays {
    float* data;
    std::size_t padded;
};

/// Like BlockPass, in single precision: y = A x, or y = b - A x; blocks of 4 numbers (a, w) or 6 (symmetric). `ground` has six
/// arrays, `padded` apart, or with 4-number values one.
struct FloatPass {
    EntryPattern pattern;
    const float* values;
    const float* ground;
    FloatVec3Arrays x, y;
    const float* points;  // x as x y z 0 a vertex
    const float* right;   // b, or null
};

/// x += factor D^-1 r, or x = factor D^-1 r with `fresh`.
struct SmoothPass {
    const float* inverse;  // six arrays, `padded` apart
    FloatVec3Arrays r, x;
    float factor;
    bool fresh;
};

/// y = P x or y += P x, P scalar weights in slices, three numbers a vertex.
struct TransferPass {
    EntryPattern pattern;
    const float* weights;
    const float* points;  // x as x y z 0 a vertex
    FloatVec3Arrays y;
    bool add;
};

/// Block diagonals of a matrix and their inverses, six arrays each, `padded` apart.
struct DiagonalPass {
    EntryPattern pattern;
    const float* values;   // 4 or 6 numbers an entry
    const double* ground;  // one number a vertex (4), or
    const float* blocks;   // six arrays (6); the other one is null
    double* diagonal;      // null if not wanted
    float* inverse;
    std::size_t padded;
};

/// Galerkin sums: block[e] = sum of coefficient * fine[pair], eight floats a block (six used).
struct GalerkinPass {
    const int *start, *pair;
    const float* coefficient;
    const float* fine;
    float* coarse;
};

/// The edges of membrane triangles, at the entries of their springs. With the length l of an edge and those of the edges from
/// its two ends to the vertex opposite in each of its (at most two) triangles, near_k from the own vertex and far_k from the
/// other: half its pull is t/2 = n1 l^2 + (n2 near_0^2 + n3 far_0^2) + (n4 near_1^2 + n5 far_1^2) - n6, and s = l^2 - n0.
struct MembraneEdges {
    const int* opposite[2];
    const double* numbers[7];  // n0 m^2, n1 ... n5 N/m^3, n6 N/m
};

/// The triangles as their vertices see them, in slices. From the own vertex edge p goes to the first of the others and q to the
/// second; r between these. `coupling` has K_pq, K_pr, K_qr in N/m^3, slice_lanes each, for every slice_lanes corners.
struct MembraneCorners {
    const int* start;
    const int* other[2];
    const double* coupling;
};

/// One evaluation of all edges, after that of the springs: the force on the own vertex is -t x.
struct MembranePass {
    EntryPattern pattern;  // in slices
    MembraneEdges edges;
    ConstAxes positions;   // m
    const double* points;  // the same as x y z 0 a vertex
    double dt;             // s
    Axes forces;           // N, added to
    float* values;         // SpringPass::values, added to; null without matrix
};

/// Edges that resist beyond a length, at the entries of their springs: T = max(0, h + k (l - L)). No edge shorter than the root
/// of `slack_square` pulls; that is the largest number where nothing is limited.
struct LimitEntries {
    const double *slack_square, *length, *stiffness, *hold;  // m^2, L m, k N/m, h N
};

/// One evaluation of them, after that of the springs: the force on the own vertex is -T/l x.
struct LimitPass {
    EntryPattern pattern;  // in slices
    LimitEntries limits;
    ConstAxes positions;   // m
    const double* points;  // the same as x y z 0 a vertex
    double dt;             // s
    Axes forces;           // N, added to
    float* values;         // SpringPass::values, added to; null without matrix
};

/// Number of floats a corner.
constexpr int corner_values = 12;

/// p, q, r in m, then 4 dt^2 times the coupling: corner_values floats, slice_lanes each, for every slice_lanes corners.
struct CornerFillPass {
    MembraneCorners corners;
    ConstAxes positions;
    const double* points;
    double dt;
    float* values;
};

/// The part of the matrix that couples different edges of triangles.
struct CornerProduct {
    MembraneCorners corners;
    const float* values;
};

/// A product in double precision that is added to y at free vertices.
struct WideProduct {
    ConstAxes x;
    const double* points;  // x as x y z 0 a vertex
    const double* free;
    Axes y;
};

/// Diagonal blocks that receive sums, and their inverses; six arrays each.
struct DiagonalSums {
    double* diagonal;
    float* inverse;
    std::size_t padded;
};

/// The kernels of one instruction set. All of them give the same bits.
struct Kernels {
    InstructionSet set;
    void (*pack_points)(ConstAxes from, double* points, Slices range);
    void (*pack_float_points)(FloatVec3Arrays from, float* points, Slices range);
    void (*start_springs)(const StartPass& pass, Slices range);
    double (*springs)(const SpringPass& pass, Slices range);  // returns their energy, J
    /// y = A x, 0 at prescribed vertices (`free` = 0); returns x . y.
    double (*multiply)(const BlockPass& pass, ConstAxes x, const double* points, const double* free, Axes y, Slices range);
    double (*dot)(ConstAxes a, ConstAxes b, Slices range);
    double (*advance)(double alpha, ConstAxes p, ConstAxes q, Axes x, Axes r, Slices range);  // x += alpha p, r -= alpha q; r . r
    void (*turn)(double beta, ConstAxes z, Axes p, Slices range);                             // p = z + beta p
    void (*jacobi)(const float* inverse, std::size_t padded, ConstAxes r, Axes z, Slices range);  // z = D^-1 r
    void (*to_float)(double scale, ConstAxes from, FloatVec3Arrays to, Slices range);
    void (*add_float)(double scale, FloatVec3Arrays from, Axes to, Slices range);  // to += scale * from
    double (*float_dot)(FloatVec3Arrays a, FloatVec3Arrays b, Slices range);
    double (*float_advance)(float alpha, FloatVec3Arrays p, FloatVec3Arrays q, FloatVec3Arrays x, FloatVec3Arrays r,
                            Slices range);
    void (*float_turn)(float beta, FloatVec3Arrays z, FloatVec3Arrays p, Slices range);
    void (*multiply_fine)(const FloatPass& pass, Slices range);    // 4 numbers an entry
    void (*multiply_coarse)(const FloatPass& pass, Slices range);  // 6 numbers an entry
    void (*smooth)(const SmoothPass& pass, Slices range);
    void (*transfer)(const TransferPass& pass, Slices range);
    void (*fine_diagonal)(const DiagonalPass& pass, Slices range);
    void (*coarse_diagonal)(const DiagonalPass& pass, Slices range);
    void (*galerkin)(const GalerkinPass& pass, int first, int last);
    double (*membrane)(const MembranePass& pass, Slices range);  // returns their energy, J
    double (*limits)(const LimitPass& pass, Slices range);       // returns their energy, J
    void (*fill_corners)(const CornerFillPass& pass, Slices range);
    double (*multiply_corners)(const CornerProduct& pass, const WideProduct& product,
                               Slices range);  // returns the increase of x . y
    void (*multiply_float_corners)(const CornerProduct& pass, const FloatPass& product, Slices range);
    void (*corner_diagonal)(const CornerProduct& pass, const DiagonalSums& sums, Slices range);
    void (*invert)(double* matrix, int size, int stride);  // symmetric positive definite, in place
    void (*dense_multiply)(const float* matrix, int size, int stride, const float* x, float* y);
};

}  // namespace percale
