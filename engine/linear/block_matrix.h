#pragma once

#include <array>
#include <span>
#include <vector>

#include "forces/blocks.h"
#include "forces/springs.h"
#include "model/adjacency.h"
#include "model/vec3_arrays.h"

namespace percale {

/// The place of entry (a, b) of a symmetric block in xx xy xz yy yz zz.
constexpr int symmetric_entry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

/// The sum of all coupled blocks of one vertex in its diagonal block, each taken whole at every vertex by weight (an upper bound
/// that equals the block itself where the vertices move alike, or between cloths where the two sides move against each other);
/// and that of its local outer blocks, (sum_l |g_l|)/|g_k| g_k g_k^T, an upper bound by the Cauchy-Schwarz inequality.
struct VertexBlocks {
    int vertex;
    SymmetricBlock coupled = {}, outer = {};  // kg
};

/// Whether a contact constraint is between cloths, or parts of one, rather than with an obstacle: some weights are negative.
bool between_cloths(const CoupledBlock& block);

/// Vertices up to which an outer block counts as local: in the diagonal blocks and the factor. For larger ones, such as those of
/// gas, that bound is too stiff by their number of vertices; a LowRankUpdate takes them into account.
constexpr std::size_t max_local_vertices = 12;
inline bool is_local(const OuterBlocks::Block& block) { return block.vertex.size() <= max_local_vertices; }

/// The step matrix A = M - dt Jv - dt^2 Jq, kg. Springs act on differences of vertices by blocks a I + w w^T, held in single
/// precision: each is then a spring whose stiffness is exact to 6e-8, and the matrix is exactly symmetric and, without loads,
/// positive definite. The coupling of the edges of a membrane's triangle is added corner by corner (SpringTerms::corners).
/// Masses and all other blocks are in double precision and kept apart.
struct BlockMatrix {
    const Adjacency* pattern = nullptr;
    const Compute* compute = nullptr;
    const SpringTerms* springs = nullptr;    // viewed, not copied
    AlignedVector<double> mass;              // kg; 1 for padding
    AlignedVector<double> free;              // 1, or 0 for a vertex whose motion is prescribed and for padding
    DiagonalBlocks diagonal;                 // mass and springs
    AlignedVector<float> inverse;            // of the diagonal blocks with `by_vertex`, six arrays; 0 at prescribed vertices
    CoupledBlocks coupled;                   // viewed, not copied
    const ForceBlocks* of_forces = nullptr;  // viewed, not copied: outer blocks, and loads, which are in no preconditioner
    std::vector<int> local_outer;            // of these
    std::vector<Vec3Arrays> wide_outer;      // g of the others, at all vertices
    std::vector<VertexBlocks> by_vertex;     // of all coupled and local outer blocks
    std::vector<int> slot;                   // of a vertex in by_vertex, or -1

    std::size_t padded() const { return free.size(); }
    int slices() const { return pattern->slices(); }
};

/// Sizes the matrix for a pattern, which is viewed; all vertices become free.
void set_pattern(const Compute& compute, const Adjacency& pattern, std::span<const double> mass, BlockMatrix& matrix);

/// Makes the diagonal blocks of mass and springs, and their inverses.
void fill_diagonal(const BlockMatrix& matrix, const SpringTerms& springs, DiagonalBlocks& diagonal,
                   AlignedVector<float>& inverse);

/// Takes the blocks of contact and of forces of a state, for products and `by_vertex`.
void set_blocks(std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces, BlockMatrix& matrix);

/// Takes springs and blocks of a state, and makes the block diagonal and its inverse.
void fill_matrix(const SpringTerms& springs, std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces,
                 BlockMatrix& matrix);

/// y += A_b x at all vertices, where A_b are the outer blocks and the loads.
void add_force_product(const BlockMatrix& matrix, const Vec3Arrays& x, Vec3Arrays& y);

/// y = A x on the free vertices, 0 at prescribed ones; returns x . y over the free ones. `points` is work space.
double multiply(const BlockMatrix& matrix, const Vec3Arrays& x, AlignedVector<double>& points, Vec3Arrays& y);

/// The same with x in `points` already (place_points).
double multiply_placed(const BlockMatrix& matrix, const Vec3Arrays& x, const AlignedVector<double>& points, Vec3Arrays& y);

/// r = b - A x on the free vertices, 0 at prescribed ones.
void set_residual(const BlockMatrix& matrix, const Vec3Arrays& b, const Vec3Arrays& x, AlignedVector<double>& points,
                  Vec3Arrays& r);

/// z = D^-1 r for free vertices, 0 for the others (D: block diagonal), on a range.
void precondition(const BlockMatrix& matrix, const Vec3Arrays& r, Vec3Arrays& z, Slices range);

/// x = 0 at prescribed vertices.
void filter(const BlockMatrix& matrix, Vec3Arrays& x);

/// The inverse of a symmetric positive definite 3x3 block xx xy xz yy yz zz, by cofactors.
SymmetricBlock inverse_block(const SymmetricBlock& m);

}  // namespace percale
