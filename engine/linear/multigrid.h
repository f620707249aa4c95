#pragma once

#include <vector>

#include "block_matrix.h"
#include "hierarchy.h"

namespace percale {

using FloatVec = std::array<float, 3>;

/// One V-cycle as a preconditioner, in single precision: a sweep of damped block Jacobi before and after each coarse
/// correction; dense at the bottom. Symmetric and positive definite. Coarser levels take the triangles of membranes as the
/// springs on their edges alone, which is within a factor of about three.
///
/// Contacts and prescribed vertices do not change coarse spaces or interpolation. The transfers of level 0 are filtered at such
/// vertices: by 0 where the motion is prescribed, by S = d (d I + K)^-1 where contact adds K to a vertex whose own block has the
/// size d along K. Coarse diagonals get the spring block of a prescribed vertex, and of a contact the parallel sum S K instead of
/// K, since a stiff contact at one vertex does not hold its neighbours.
///
/// Between cloths contact holds their relative motion alone: their common motion is as soft as without it. Where one of these
/// constraints is stiff, the finest level takes all of them, C = W K W^T, exactly, not by diagonal blocks, and another filter
/// follows the S of all others: a few sweeps of block Jacobi on them, x -= tau D^-1 C x, with the factors tau that minimise the
/// largest energy l F(l)^2 over the eigenvalues l of D^-1 C (smoothed aggregation: Vanek, Mandel and Brezina 1996, Computing 56).
/// Coarser diagonals keep S K of all constraints: without it layers move far apart, and stiff constraints need more iterations.
///
/// Local outer blocks are exact on the finest level, too. Coarser levels take one of n vertices that resists no translation, u =
/// sum g_k . x_k, as springs on the m pairs of them: u = sum h . (x_k - x_l) with h = (g_k - g_l)/n, and u^2 <= m sum (h .
/// (x_k - x_l))^2, which is too stiff by m at most. Pairs that no spring joins are left out.
class Multigrid {
public:
    /// The springs of `pattern` in rest positions (m, one per vertex). All arguments are viewed.
    Multigrid(const Compute& compute, const Adjacency& pattern, std::span<const Vec3> rest);

    enum class Coarser { filled, kept };
    /// Takes the values of a matrix with that pattern; coarser levels may be kept from an earlier matrix, which is as good a
    /// preconditioner where little has changed.
    void fill(const BlockMatrix& matrix, Coarser coarser);

    /// One cycle for A z = r at the finest level: r in residual(), z in correction(). r should be of about unit size.
    void cycle();
    AlignedVector<float>& residual() { return levels_[0].b; }
    AlignedVector<float>& correction() { return levels_[0].x; }

    /// The same in parts, for a caller that fuses its passes over the vectors with them: `begin` for all ranges, once residual()
    /// is set in the range; then `correct`; then `finish` for all ranges, after which correction() is set in the range. Between
    /// `correct` and `finish` no product may be computed.
    void begin(Slices range) { begin(0, range); }
    void correct() { correct(0); }
    void finish(Slices range) { finish(0, range); }

    /// y = A x at the finest level, constraints and local outer blocks exact; x and y are 0 at prescribed vertices.
    void multiply(const AlignedVector<float>& x, AlignedVector<float>& y);
    /// The same in parts: `place` for all ranges, which copies x into the layout that the product reads; then `set_row_forces`;
    /// then `product` for all ranges.
    void place(const AlignedVector<float>& x, Slices range) { place(0, x, range); }
    void set_row_forces(const AlignedVector<float>& x);
    void product(const AlignedVector<float>& x, AlignedVector<float>& y, Slices range);

    std::size_t padded() const { return levels_[0].padded; }
    int slices() const { return levels_[0].slices; }
    const Compute& compute() const { return compute_; }
    int levels() const { return static_cast<int>(levels_.size()); }

private:
    struct Level {
        EntryPattern pattern;
        int slices = 0;
        std::size_t padded = 0;
        const float* values = nullptr;
        const float* corners = nullptr;   // of membranes, at the finest level
        AlignedVector<float> own_values;  // of coarser levels
        AlignedVector<float> blocks;      // eight numbers per pair (six used), and one zero block
        AlignedVector<float> ground;      // the mass alone (finest), or six arrays
        AlignedVector<float> inverse;
        AlignedVector<float> x, b, r;
        AlignedVector<float> points;  // x in the layout of a product, unless that is in bands
        AlignedVector<float> handed;  // as points: the residual for the coarser level, or x for the finer one
        std::vector<int> eased;       // vertices, ascending: under-relaxed in smoothing (sewn_point_easing)
    };
    /// A vertex of the finest level whose transfers are filtered.
    struct Filtered {
        int vertex;
        std::array<float, 6> filter;   // S
        std::array<float, 6> contact;  // kg, a bound of the constraints that are not taken exactly, for the residual of level 0
        std::array<double, 6> ground;  // kg, for the next level
        int first_row = 0, rows = 0;   // in row_ends_
        int exact = 0;                 // the first ones of these, which are taken exactly
    };
    /// The part of a row, a coupled block or a local outer one, at one vertex: factor * row_force_[row], entry by entry; all
    /// entries of `factor` are a weight, or all entries of the force the number g . x.
    struct RowEnd {
        int row;
        FloatVec factor;
    };

    void add_level(const LevelPattern& pattern);
    void find_eased();
    void ease(Level& level) const;
    Level sized_level(EntryPattern pattern, int slices) const;
    void find_exact(const BlockMatrix& matrix);
    bool is_exact(std::size_t row) const;
    void set_held_alone(const BlockMatrix& matrix);
    void set_filters(const BlockMatrix& matrix);
    void set_rows(const BlockMatrix& matrix);
    void expand_blocks(const SpringTerms& springs);
    void expand_stretch(const SpringTerms& springs, int first_pair, int last_pair);
    void expand_outer();
    int pair_between(int first, int second) const;
    void fill_level(int k);
    void restrict_ground(int k);
    void restrict_mass();
    void fill_bottom();
    // These work on one range; what they read of other ranges was written by an earlier pass.
    void begin(int k, Slices range);
    void finish(int k, Slices range);
    void hand_down(int k, Slices range);
    void prolong(int k, Slices range);
    FloatVec add_rows(const Filtered& vertex, int rows, float factor, FloatVec value) const;
    FloatVec by_inverse(int vertex, const FloatVec& u) const;
    void smooth(int k, bool fresh, Slices range);
    void set_residual(int k, Slices range);
    void place(int k, const AlignedVector<float>& x, Slices range);
    void place_vertex(int vertex);
    void multiply_level(int k, const AlignedVector<float>& x, const float* right, AlignedVector<float>& y, Slices range);
    void transfer(const TransferLists& lists, const AlignedVector<float>& points, FloatVec3Arrays to, bool add,
                  Slices range) const;
    template <class Work>
    void for_filtered(Slices range, Work work);
    template <class Work>
    void for_exact(Work work);
    // These work on the finest level as a whole.
    template <class RowAt>
    void set_forces(const AlignedVector<float>& x, std::size_t rows, RowAt row_at);
    void set_exact_forces(const AlignedVector<float>& x);
    void sweep_residual();
    void sweep_change();
    void correct(int k);
    void solve_bottom(Level& level);
    static FloatVec3Arrays view(const AlignedVector<float>& data, const Level& level);

    const Compute& compute_;
    const Adjacency& adjacency_;
    std::vector<Adjacency::ValuePlace> pair_value_;  // of the finest level: the place of each pair's block
    std::vector<int> pair_of_spring_;                // or -1
    AlignedVector<float> guarded_;                   // work space of products with bands
    std::vector<LevelPattern> patterns_;
    std::vector<Level> levels_;
    CoupledBlocks coupled_;
    std::vector<OuterBlocks::Block> outer_;        // local; their rows follow those of coupled blocks
    std::vector<Filtered> filtered_;               // prescribed vertices first
    std::vector<int> by_vertex_, filter_of_slot_;  // of filtered_: ascending by vertex; of BlockMatrix::by_vertex
    int prescribed_ = 0;
    std::vector<RowEnd> row_ends_;
    std::vector<SymmetricBlock> held_;  // work space of set_filters
    bool sweeps_ = false;               // some constraints between cloths are stiff; all of them are then exact
    std::vector<int> exact_rows_;       // these, and all outer blocks, where there are coarser levels
    std::vector<int> exact_;            // their vertices in filtered_
    std::vector<FloatVec> row_force_;   // work space: of the vector that rows last acted on
    std::vector<FloatVec> before_;      // x before prolong
    AlignedVector<float> change_;       // of sweeps, sized on first use
    AlignedVector<double> bottom_;
    AlignedVector<float> bottom_inverse_, bottom_x_, bottom_y_;
    int bottom_size_ = 0, bottom_stride_ = 0;
};

}  // namespace percale
