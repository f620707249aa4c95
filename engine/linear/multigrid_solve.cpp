#include "multigrid_solve.h"

#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// One solve: functions that share the system and its work space.
class MixedSolve {
public:
    MixedSolve(const BlockMatrix& matrix, Multigrid& multigrid, MultigridSpace& space)
        : matrix_(matrix), multigrid_(multigrid), compute_(multigrid.compute()), space_(space) {}

    SolveReport run(const Vectors& b, const SolveTarget& target, Vectors& x) {
        size_space(b);
        const double first = set_residual(b, x);
        if (first == 0.0) return {.iterations = 0, .converged = true};
        double norm = first;
        for (int k = 0; k < most_refinements && std::isfinite(norm); ++k) {
            const bool by_gain = solve_floats(norm, target.relative_residual * first / norm, target);
            for_chunks(compute_, multigrid_.slices(),
                       [&](Slices range) { compute_.kernels->add_float(norm, view(space_.x), x.axes(), range); });
            report_.converged = by_gain;
            if (by_gain || report_.iterations >= target.most_iterations) return report_;
            const double before = norm;
            norm = set_residual(b, x);
            report_.converged = norm <= target.relative_residual * first;
            if (report_.converged || norm > most_refined_share * before) return report_;
        }
        return report_;
    }

private:
    FloatVectors view(AlignedVector<float>& data) const { return {data.data(), multigrid_.padded()}; }

    static std::array<const float*, 3> axes_of(FloatVectors a) { return {a.data, a.data + a.padded, a.data + 2 * a.padded}; }

    void size_space(const Vectors& b) {
        for (auto* list : {&space_.x, &space_.p, &space_.q}) list->resize(3 * multigrid_.padded());
        if (space_.r.padded_size() == b.padded_size()) return;
        space_.r.resize(static_cast<int>(b.padded_size()));
    }

    /// r = b - A x on the free vertices, in double precision; returns its norm.
    double set_residual(const Vectors& b, const Vectors& x) {
        percale::set_residual(matrix_, b, x, space_.points, space_.r);
        return std::sqrt(dot(compute_, space_.r, space_.r));
    }

    double sum(FloatVectors a, FloatVectors b) const {
        return sum_chunks(compute_, multigrid_.slices(), [&](Slices range) { return compute_.kernels->float_dot(a, b, range); });
    }

    /// space.x = A^-1 r/norm in floats, until the residual is at `wanted` or what floats reach, or the gains are small: true
    /// then.
    bool solve_floats(double norm, double wanted, const SolveTarget& target) {
        const FloatVectors r = view(multigrid_.residual()), z = view(multigrid_.correction());
        const FloatVectors x = view(space_.x), p = view(space_.p), q = view(space_.q);
        const SolveTarget scaled{.relative_residual = std::max(float_aim_share * wanted, float_residual),
                                 .relative_gain = target.relative_gain,
                                 .absolute_gain = target.absolute_gain / (norm * norm)};
        std::fill(space_.x.begin(), space_.x.end(), 0.0f);
        for_chunks(compute_, multigrid_.slices(),
                   [&](Slices range) { compute_.kernels->to_float(1.0 / norm, space_.r.axes(), r, range); });
        multigrid_.cycle();
        space_.p = multigrid_.correction();
        double rz = sum(r, z);
        GainRecord gains(1);
        while (report_.iterations < target.most_iterations) {
            ++report_.iterations;
            multigrid_.multiply(space_.p, space_.q);
            const double curvature = sum(p, q);
            if (!(curvature > 0.0) || !std::isfinite(rz)) return false;
            const double alpha = rz / curvature;
            gains.add(alpha * rz);
            const double square = sum_chunks(compute_, multigrid_.slices(), [&](Slices range) {
                return compute_.kernels->float_advance(static_cast<float>(alpha), p, q, x, r, range);
            });
            if (gains.small_enough(scaled) && net_is_small<float>(target.net, axes_of(r), norm)) return true;
            if (square <= scaled.relative_residual * scaled.relative_residual) return false;
            multigrid_.cycle();
            const double next = sum(r, z);
            const float beta = static_cast<float>(next / rz);
            rz = next;
            for_chunks(compute_, multigrid_.slices(), [&](Slices range) { compute_.kernels->float_turn(beta, z, p, range); });
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

SolveReport solve_multigrid(const BlockMatrix& matrix, Multigrid& multigrid, const Vectors& b, const SolveTarget& target,
                            MultigridSpace& space, Vectors& x) {
    return MixedSolve(matrix, multigrid, space).run(b, target, x);
}

}  // namespace percale
