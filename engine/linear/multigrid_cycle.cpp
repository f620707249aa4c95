#include <algorithm>
#include <cmath>
#include <numbers>

#include "multigrid.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Damping of the block Jacobi smoother. It leaves eigenvalues up to 2 for springs and up to about 2.8 on coarser levels: with
/// more than 2/2.8 it would amplify them. (Chebyshev polynomials of degree two need fewer cycles, but each reads the matrix
/// twice as often.)
constexpr float jacobi_damping = 0.7f;

/// Sweeps over contact constraints that filter what multigrid transfers to coarser levels and back, where constraints between
/// cloths are stiff (stiff_constraint_factor). Cost alone.
constexpr int constraint_sweeps = 3;

using FloatBlock = std::array<float, 6>;

FloatVec times(const FloatBlock& m, const FloatVec& u) {
    return {m[0] * u[0] + m[1] * u[1] + m[2] * u[2], m[1] * u[0] + m[3] * u[1] + m[4] * u[2],
            m[2] * u[0] + m[4] * u[1] + m[5] * u[2]};
}

FloatVec at(const FloatVec3Arrays& v, int i) { return {v.data[i], v.data[v.padded + i], v.data[2 * v.padded + i]}; }

void set(const FloatVec3Arrays& v, int i, const FloatVec& value) {
    for (int axis = 0; axis < 3; ++axis) v.data[axis * v.padded + i] = value[axis];
}

FloatVec sum(const FloatVec& a, const FloatVec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
FloatVec difference(const FloatVec& a, const FloatVec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
FloatVec scaled(float factor, const FloatVec& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }

/// 1/l with the roots l of the polynomial F(l), F(0) = 1, for which l F(l)^2 is nowhere above 1/(2 n + 1)^2 in 0 ... 1:
/// up to its sign T(sqrt l)/((2 n + 1) sqrt l) with the Chebyshev polynomial T of degree 2 n + 1.
std::array<float, constraint_sweeps> constraint_sweep_factors() {
    std::array<float, constraint_sweeps> factors;
    for (int k = 0; k < constraint_sweeps; ++k) {
        const double root = std::cos((2 * k + 1) * std::numbers::pi / (2 * (2 * constraint_sweeps + 1)));
        factors[k] = static_cast<float>(1.0 / (root * root));
    }
    return factors;
}

/// K sum w x of a coupled block.
FloatVec row_force(const CoupledBlock& block, const FloatVec3Arrays& x) {
    FloatVec u{};
    for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k)
        u = sum(u, scaled(static_cast<float>(block.weight[k]), at(x, block.vertex[k])));
    FloatBlock k;
    for (int entry = 0; entry < 6; ++entry) k[entry] = static_cast<float>(block.k[entry]);
    return times(k, u);
}

/// g . x of an outer block, three times.
FloatVec row_force(const OuterBlocks::Block& block, const FloatVec3Arrays& x) {
    float along = 0.0f;
    for (std::size_t k = 0; k < block.vertex.size(); ++k) {
        const FloatVec u = at(x, block.vertex[k]);
        for (int axis = 0; axis < 3; ++axis) along += static_cast<float>(block.gradient[k][axis]) * u[axis];
    }
    return {along, along, along};
}

}  // namespace

FloatVec3Arrays Multigrid::view(const AlignedVector<float>& data, const Level& level) {
    return {const_cast<float*>(data.data()), level.padded};
}

/// Calls work(vertex, its number) for the filtered vertices of a range of the finest level.
template <class Work>
void Multigrid::for_filtered(Slices range, Work work) {
    const auto vertex = [&](int number) { return filtered_[number].vertex; };
    const auto first = std::ranges::lower_bound(by_vertex_, range.first * slice_lanes, {}, vertex);
    for (auto it = first; it != by_vertex_.end() && vertex(*it) < range.last * slice_lanes; ++it) work(filtered_[*it], *it);
}

/// Calls work(vertex, its number) for all vertices with rows that are taken exactly, in any order.
template <class Work>
void Multigrid::for_exact(Work work) {
    const int count = static_cast<int>(exact_.size());
    parallel_for_chunks(compute_, count, constraint_grain, count >= min_shared_constraints, [&](int first, int last, int) {
        for (int k = first; k < last; ++k) work(filtered_[exact_[k]], exact_[k]);
    });
}

void Multigrid::place(int k, const AlignedVector<float>& x, Slices range) {
    Level& level = levels_[k];
    const BandPattern* bands = level.pattern.bands;
    if (!bands) return compute_.kernels->pack_float_points(view(x, level), level.points.data(), range);
    const std::size_t first = static_cast<std::size_t>(range.first) * slice_lanes;
    const std::size_t count = static_cast<std::size_t>(range.last - range.first) * slice_lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* source = x.data() + axis * bands->padded + first;
        std::copy_n(source, count, &guarded_[axis * (bands->padded + 2 * bands->guard) + bands->guard + first]);
    }
}

/// The same for x of one vertex of the finest level.
void Multigrid::place_vertex(int vertex) {
    Level& level = levels_[0];
    const BandPattern* bands = level.pattern.bands;
    const FloatVec value = at(view(level.x, level), vertex);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t i = static_cast<std::size_t>(vertex);
        (bands ? guarded_[axis * (bands->padded + 2 * bands->guard) + bands->guard + i] : level.points[4 * i + axis]) =
            value[axis];
    }
}

/// y = A x, or right - A x, with x in its place; springs and ground only.
void Multigrid::multiply_level(int k, const AlignedVector<float>& x, const float* right, AlignedVector<float>& y, Slices range) {
    Level& level = levels_[k];
    const FloatPass pass{.pattern = level.pattern,
                         .values = level.values,
                         .ground = level.ground.data(),
                         .x = view(x, level),
                         .y = view(y, level),
                         .points = level.pattern.bands ? guarded_.data() : level.points.data(),
                         .right = right};
    (k == 0 ? compute_.kernels->multiply_fine : compute_.kernels->multiply_coarse)(pass, range);
    if (!level.corners) return;
    const CornerProduct corners{adjacency_.membrane.corners(), level.corners};
    compute_.kernels->multiply_float_corners(corners, pass, range);
}

/// Sets row_force_ of the rows number row_at(0), row_at(1) ...
template <class RowAt>
void Multigrid::set_forces(const AlignedVector<float>& x, std::size_t rows, RowAt row_at) {
    const FloatVec3Arrays from = view(x, levels_[0]);
    const int count = static_cast<int>(rows);
    parallel_for_chunks(compute_, count, constraint_grain, count >= min_shared_constraints, [&](int first, int last, int) {
        for (int k = first; k < last; ++k) {
            const std::size_t row = row_at(k);
            row_force_[row] =
                row < coupled_.size() ? row_force(coupled_[row], from) : row_force(outer_[row - coupled_.size()], from);
        }
    });
}

void Multigrid::set_row_forces(const AlignedVector<float>& x) {
    set_forces(x, row_force_.size(), [](int k) { return k; });
}

/// Sets those of rows that are taken exactly.
void Multigrid::set_exact_forces(const AlignedVector<float>& x) {
    set_forces(x, exact_rows_.size(), [this](int k) { return exact_rows_[k]; });
}

/// value + factor times the forces of the first rows of a vertex.
FloatVec Multigrid::add_rows(const Filtered& vertex, int rows, float factor, FloatVec value) const {
    for (int k = vertex.first_row; k < vertex.first_row + rows; ++k) {
        const FloatVec &at = row_ends_[k].factor, &force = row_force_[row_ends_[k].row];
        for (int axis = 0; axis < 3; ++axis) value[axis] += factor * at[axis] * force[axis];
    }
    return value;
}

/// D^-1 u at a vertex of the finest level.
FloatVec Multigrid::by_inverse(int vertex, const FloatVec& u) const {
    const Level& level = levels_[0];
    FloatBlock inverse;
    for (std::size_t entry = 0; entry < inverse.size(); ++entry) inverse[entry] = level.inverse[entry * level.padded + vertex];
    return times(inverse, u);
}

void Multigrid::product(const AlignedVector<float>& x, AlignedVector<float>& y, Slices range) {
    multiply_level(0, x, nullptr, y, range);
    const FloatVec3Arrays result = view(y, levels_[0]);
    for_filtered(range, [&](const Filtered& vertex, int number) {
        const FloatVec value = add_rows(vertex, vertex.rows, 1.0f, at(result, vertex.vertex));
        set(result, vertex.vertex, number < prescribed_ ? FloatVec{} : value);
    });
}

void Multigrid::multiply(const AlignedVector<float>& x, AlignedVector<float>& y) {
    for_chunks(compute_, slices(), [&](Slices range) { place(x, range); });
    set_row_forces(x);
    for_chunks(compute_, slices(), [&](Slices range) { product(x, y, range); });
}

/// x += omega D^-1 r, or x = omega D^-1 b.
void Multigrid::smooth(int k, bool fresh, Slices range) {
    Level& level = levels_[k];
    const SmoothPass pass{.inverse = level.inverse.data(),
                          .r = view(fresh ? level.b : level.r, level),
                          .x = view(level.x, level),
                          .factor = jacobi_damping,
                          .fresh = fresh};
    compute_.kernels->smooth(pass, range);
}

/// From x = 0; x in its place.
void Multigrid::begin(int k, Slices range) {
    smooth(k, true, range);
    place(k, levels_[k].x, range);
}

/// r = b - A x; row_force_ must be of x where rows are taken exactly.
void Multigrid::set_residual(int k, Slices range) {
    Level& level = levels_[k];
    multiply_level(k, level.x, level.b.data(), level.r, range);
    if (k > 0) return;
    const FloatVec3Arrays x = view(level.x, level), r = view(level.r, level);
    for_filtered(range, [&](const Filtered& vertex, int) {
        const FloatVec rest = difference(at(r, vertex.vertex), times(vertex.contact, at(x, vertex.vertex)));
        set(r, vertex.vertex, vertex.exact > 0 ? add_rows(vertex, vertex.exact, -1.0f, rest) : rest);
    });
}

/// The residual, filtered at the finest level, is restricted to the coarser one.
void Multigrid::hand_down(int k, Slices range) {
    Level& level = levels_[k];
    set_residual(k, range);
    const FloatVec3Arrays r = view(level.r, level);
    if (k == 0) {
        for_filtered(range, [&](const Filtered& vertex, int) {
            if (!sweeps_ || vertex.exact == 0) set(r, vertex.vertex, times(vertex.filter, at(r, vertex.vertex)));
        });
    }
    compute_.kernels->pack_float_points(r, level.handed.data(), range);
}

/// Between cloths r -= tau C D^-1 r, sweep by sweep, and then S r, is restricted.
void Multigrid::sweep_residual() {
    Level& level = levels_[0];
    const FloatVec3Arrays r = view(level.r, level), change = view(change_, level);
    const auto set_change = [&](const Filtered& vertex, int) {
        set(change, vertex.vertex, by_inverse(vertex.vertex, at(r, vertex.vertex)));
    };
    for_exact(set_change);
    for (const float factor : constraint_sweep_factors()) {
        set_exact_forces(change_);
        for_exact([&](const Filtered& vertex, int number) {
            set(r, vertex.vertex, add_rows(vertex, vertex.exact, -factor, at(r, vertex.vertex)));
            set_change(vertex, number);
        });
    }
    for_exact([&](const Filtered& vertex, int) {
        const FloatVec filtered = times(vertex.filter, at(r, vertex.vertex));
        std::ranges::copy(filtered, &level.handed[4 * static_cast<std::size_t>(vertex.vertex)]);
    });
}

/// The last sweep; a coarser level prolongs its x.
void Multigrid::finish(int k, Slices range) {
    Level& level = levels_[k];
    set_residual(k, range);
    smooth(k, false, range);
    if (k > 0) compute_.kernels->pack_float_points(view(level.x, level), level.handed.data(), range);
}

/// x += P (coarser x), filtered at the finest level; x in its place.
void Multigrid::prolong(int k, Slices range) {
    Level& level = levels_[k];
    const FloatVec3Arrays x = view(level.x, level);
    if (k == 0) for_filtered(range, [&](const Filtered& vertex, int number) { before_[number] = at(x, vertex.vertex); });
    transfer(patterns_[k].prolongation, levels_[k + 1].handed, x, true, range);
    if (k == 0) {
        for_filtered(range, [&](const Filtered& vertex, int number) {
            const FloatVec change = difference(at(x, vertex.vertex), before_[number]);
            set(x, vertex.vertex, sum(times(vertex.filter, change), before_[number]));
        });
    }
    place(k, level.x, range);
}

/// Between cloths the change of x is swept, too: u -= tau D^-1 C u.
void Multigrid::sweep_change() {
    Level& level = levels_[0];
    const FloatVec3Arrays x = view(level.x, level), change = view(change_, level);
    for_exact([&](const Filtered& vertex, int number) {
        set(change, vertex.vertex, difference(at(x, vertex.vertex), before_[number]));
    });
    for (const float factor : constraint_sweep_factors()) {
        set_exact_forces(change_);
        for_exact([&](const Filtered& vertex, int) {
            const FloatVec part = by_inverse(vertex.vertex, add_rows(vertex, vertex.exact, factor, {}));
            set(change, vertex.vertex, difference(at(change, vertex.vertex), part));
        });
    }
    for_exact([&](const Filtered& vertex, int number) {
        set(x, vertex.vertex, sum(before_[number], at(change, vertex.vertex)));
        place_vertex(vertex.vertex);
    });
}

void Multigrid::transfer(const TransferLists& lists, const AlignedVector<float>& points, FloatVec3Arrays to, bool add,
                         Slices range) const {
    compute_.kernels->transfer(
        {.pattern = lists.pattern(), .weights = lists.weight.data(), .points = points.data(), .y = to, .add = add}, range);
}

/// The whole cycle at level k between its first sweep and its last.
void Multigrid::correct(int k) {
    if (k + 1 == levels()) return;
    Level &level = levels_[k], &coarser = levels_[k + 1];
    const int min = k == 0 ? min_shared_slices : min_shared_coarse_slices;
    const bool solves = k + 2 == levels() && bottom_size_ > 0, exact = k == 0 && !exact_.empty(), sweeps = exact && sweeps_;
    if (exact) set_exact_forces(level.x);
    for_chunks(
        compute_, level.slices, [&](Slices range) { hand_down(k, range); }, min);
    if (sweeps) sweep_residual();
    for_chunks(
        compute_, coarser.slices,
        [&](Slices range) {
            transfer(patterns_[k].restriction, level.handed, view(coarser.b, coarser), false, range);
            if (!solves) begin(k + 1, range);
        },
        min_shared_coarse_slices);
    if (solves) {
        solve_bottom(coarser);
    } else {
        correct(k + 1);
        for_chunks(
            compute_, coarser.slices, [&](Slices range) { finish(k + 1, range); }, min_shared_coarse_slices);
    }
    for_chunks(
        compute_, level.slices, [&](Slices range) { prolong(k, range); }, min);
    if (sweeps) sweep_change();
    if (exact) set_exact_forces(level.x);
}

void Multigrid::solve_bottom(Level& level) {
    for (int i = 0; i < bottom_size_; ++i) bottom_x_[i] = level.b[(i % 3) * level.padded + i / 3];
    compute_.kernels->dense_multiply(bottom_inverse_.data(), bottom_size_, bottom_stride_, bottom_x_.data(), bottom_y_.data());
    for (int i = 0; i < bottom_size_; ++i) level.x[(i % 3) * level.padded + i / 3] = bottom_y_[i];
    compute_.kernels->pack_float_points(view(level.x, level), level.handed.data(), {0, level.slices});
}

void Multigrid::cycle() {
    for_chunks(compute_, slices(), [&](Slices range) { begin(range); });
    correct();
    for_chunks(compute_, slices(), [&](Slices range) { finish(range); });
}

}  // namespace percale
