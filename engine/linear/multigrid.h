#pragma once

#include <vector>

#include "block_matrix.h"
#include "hierarchy.h"

namespace percale {

/// One V-cycle as a preconditioner, in single precision: a sweep of damped block Jacobi before and after each coarse
/// correction; dense at the bottom. Symmetric and positive definite. Coarser levels take the triangles of membranes as the
/// springs on their edges alone, which is within a factor of about three.
///
/// Contacts and prescribed vertices leave the hierarchy as it is. The transfers are filtered at such vertices: by 0 where the
/// motion is prescribed, by S = d (d I + K)^-1 where contact adds K to a vertex whose own block has the size d along K; coarser
/// diagonals get the parallel sum S K instead of K, since a stiff contact at one vertex does not hold its neighbours.
class Multigrid {
public:
    /// The springs of `pattern` in rest positions (m, one a vertex). Everything given is viewed.
    Multigrid(const Compute& compute, const Adjacency& pattern, std::span<const Vec3> rest);

    enum class Coarser { filled, kept };
    /// Takes the values of a matrix with that pattern; coarser levels may be kept from an earlier one, which is as good a
    /// preconditioner where little has changed.
    void fill(const BlockMatrix& matrix, Coarser coarser);

    /// One cycle for A z = r at the finest level: r in residual(), z in correction(). r should be of about unit size.
    void cycle() { cycle(0); }
    AlignedVector<float>& residual() { return levels_[0].b; }
    AlignedVector<float>& correction() { return levels_[0].x; }

    /// y = A x at the finest level, contact rows exact; x and y are 0 at prescribed vertices.
    void multiply(const AlignedVector<float>& x, AlignedVector<float>& y);

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
        AlignedVector<float> blocks;      // eight numbers a pair (six used), one zero block more
        AlignedVector<float> ground;      // the mass alone (finest), or six arrays
        AlignedVector<float> inverse;
        AlignedVector<float> x, b, r, points;
        std::vector<int> eased;  // vertices, ascending: damped more in smoothing
    };
    /// A vertex of the finest level whose transfers are filtered.
    struct Filtered {
        int vertex;
        std::array<float, 6> filter;   // S
        std::array<float, 6> contact;  // K, kg; applied by the smoother
        std::array<double, 6> ground;  // kg, for the next level
    };

    void add_level(const LevelPattern& pattern);
    void find_eased();
    void ease(Level& level) const;
    Level sized_level(EntryPattern pattern, int slices) const;
    void set_filters(const BlockMatrix& matrix);
    void expand_blocks(const SpringTerms& springs);
    void expand_stretch(const SpringTerms& springs, int first_pair, int last_pair);
    void fill_level(int k);
    void restrict_ground(int k);
    void scatter_ground();
    void fill_bottom();
    void cycle(int k);
    void smooth(int k, bool fresh);
    void multiply_level(int k, const AlignedVector<float>& x, const float* right, AlignedVector<float>& y);
    void set_residual(int k);
    void solve_bottom(Level& level);
    void transfer(const TransferLists& lists, int slices, const AlignedVector<float>& points, FloatVectors to, bool add) const;
    void filter_residual();
    void prolong(int k);
    FloatVectors view(const AlignedVector<float>& data, const Level& level) const;
    void copy_guarded(const BandPattern& bands, const AlignedVector<float>& from);
    void pack(Level& level, const AlignedVector<float>& from) const;

    const Compute& compute_;
    const Adjacency& adjacency_;
    std::vector<Adjacency::ValuePlace> pair_value_;  // of the finest level: where each pair's block stands
    AlignedVector<float> guarded_;                   // work space of products with bands
    std::vector<LevelPattern> patterns_;
    std::vector<Level> levels_;
    std::span<const CoupledBlock> contacts_;
    std::vector<Filtered> filtered_;  // prescribed vertices first
    std::size_t prescribed_ = 0;
    std::vector<std::array<float, 3>> before_;  // work space of prolong
    AlignedVector<double> bottom_;
    AlignedVector<float> bottom_inverse_, bottom_x_, bottom_y_;
    int bottom_size_ = 0, bottom_stride_ = 0;
};

}  // namespace percale
