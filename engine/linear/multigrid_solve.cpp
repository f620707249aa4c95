#include "multigrid_solve.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Fraction of the residual down to which floats are trusted. Smaller: iterations that gain nothing. Larger: more refinements.
constexpr double float_residual = 1e-4;

/// Refinements of a solve in floats by residuals in doubles; the fraction of the wanted residual that one aims at; and the
/// fraction of the previous residual that it may leave: with more, floats have broken down.
constexpr int max_refinements = 12;
constexpr double float_aim_ratio = 0.5, max_refined_ratio = 0.5;

/// One solve: functions that share the system and its work space.
class MixedSolve {
public:
    MixedSolve(const BlockMatrix& matrix, Multigrid& multigrid, MultigridSpace& space)
        : matrix_(matrix), multigrid_(multigrid), compute_(multigrid.compute()), space_(space) {}

    SolveReport run(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x) {
        size_space(b);
        const double first = set_residual(b, x);
        if (first == 0.0) return {.iterations = 0, .converged = true};
        double norm = first;
        for (int k = 0; k < max_refinements && std::isfinite(norm); ++k) {
            const bool by_gain = solve_floats(norm, target.relative_residual * first / norm, target);
            for_chunks(compute_, multigrid_.slices(),
                       [&](Slices range) { compute_.kernels->add_float(norm, view(space_.x), x.axes(), range); });
            report_.converged = by_gain;
            if (by_gain || report_.iterations >= target.max_iterations) return report_;
            const double before = norm;
            norm = set_residual(b, x);
            report_.converged = norm <= target.relative_residual * first;
            if (report_.converged || norm > max_refined_ratio * before) return report_;
        }
        return report_;
    }

private:
    FloatVec3Arrays view(AlignedVector<float>& data) const { return {data.data(), multigrid_.padded()}; }

    static std::array<const float*, 3> axes_of(FloatVec3Arrays a) { return {a.data, a.data + a.padded, a.data + 2 * a.padded}; }

    void size_space(const Vec3Arrays& b) {
        for (auto* list : {&space_.x, &space_.p, &space_.q}) list->resize(3 * multigrid_.padded());
        if (space_.r.padded_size() == b.padded_size()) return;
        space_.r.resize(static_cast<int>(b.padded_size()));
    }

    /// r = b - A x on the free vertices, in double precision; returns its norm.
    double set_residual(const Vec3Arrays& b, const Vec3Arrays& x) {
        percale::set_residual(matrix_, b, x, space_.points, space_.r);
        return std::sqrt(dot(compute_, space_.r, space_.r));
    }

    const Kernels& kernels() const { return *compute_.kernels; }

    static void fill(FloatVec3Arrays a, float value, Slices range) {
        const std::size_t first = static_cast<std::size_t>(range.first) * slice_lanes;
        const std::size_t count = static_cast<std::size_t>(range.last - range.first) * slice_lanes;
        for (std::size_t axis = 0; axis < 3; ++axis) std::fill_n(a.data + axis * a.padded + first, count, value);
    }

    /// The rest of a cycle that has begun; returns r . z.
    double end_cycle(FloatVec3Arrays r, FloatVec3Arrays z) {
        multigrid_.correct();
        return sum_chunks(compute_, multigrid_.slices(), [&](Slices range) {
            multigrid_.finish(range);
            return kernels().float_dot(r, z, range);
        });
    }

    /// space.x = A^-1 r/norm in single precision, until the residual is at `wanted` or at that precision, or the gains are small:
    /// true then.
    bool solve_floats(double norm, double wanted, const SolveTarget& target) {
        const FloatVec3Arrays r = view(multigrid_.residual()), z = view(multigrid_.correction());
        const FloatVec3Arrays x = view(space_.x), p = view(space_.p), q = view(space_.q);
        const SolveTarget scaled{.relative_residual = std::max(float_aim_ratio * wanted, float_residual),
                                 .relative_gain = target.relative_gain,
                                 .absolute_gain = target.absolute_gain / (norm * norm)};
        for_chunks(compute_, multigrid_.slices(), [&](Slices range) {
            fill(x, 0.0f, range);
            fill(p, 0.0f, range);
            kernels().to_float(1.0 / norm, space_.r.axes(), r, range);
            multigrid_.begin(range);
        });
        double rz = end_cycle(r, z);
        float beta = 0.0f;
        EnergyErrorEstimate gains(1);
        while (target.goes_on(report_.iterations)) {
            ++report_.iterations;
            for_chunks(compute_, multigrid_.slices(), [&](Slices range) {
                kernels().float_turn(beta, z, p, range);
                multigrid_.place(space_.p, range);
            });
            multigrid_.set_row_forces(space_.p);
            const double curvature = sum_chunks(compute_, multigrid_.slices(), [&](Slices range) {
                multigrid_.product(space_.p, space_.q, range);
                return kernels().float_dot(p, q, range);
            });
            if (!(curvature > 0.0) || !std::isfinite(rz)) return false;
            const double alpha = rz / curvature;
            gains.add(alpha * rz);
            const double square = sum_chunks(compute_, multigrid_.slices(), [&](Slices range) {
                const double part = kernels().float_advance(static_cast<float>(alpha), p, q, x, r, range);
                multigrid_.begin(range);
                return part;
            });
            if (gains.small_enough(scaled) && net_is_small<float>(target.net, axes_of(r), norm)) return true;
            if (square <= scaled.relative_residual * scaled.relative_residual) return false;
            const double next = end_cycle(r, z);
            beta = static_cast<float>(next / rz);
            rz = next;
        }
        return false;
    }

    const BlockMatrix& matrix_;
    Multigrid& multigrid_;
    const Compute& compute_;
    MultigridSpace& space_;
    SolveReport report_;
};

}  // namespace

SolveReport solve_multigrid(const BlockMatrix& matrix, Multigrid& multigrid, const Vec3Arrays& b, const SolveTarget& target,
                            MultigridSpace& space, Vec3Arrays& x) {
    return MixedSolve(matrix, multigrid, space).run(b, target, x);
}

}  // namespace percale
