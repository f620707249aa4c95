#include "conjugate_gradient.h"

#include <array>
#include <cmath>

#include "energy_error_estimate.h"

namespace percale {
namespace {

/// One solve: functions that share the system and its work space.
class Solve {
public:
    Solve(const BlockMatrix& matrix, const Preconditioner& preconditioner, SolveSpace& space)
        : matrix_(matrix), preconditioner_(preconditioner), compute_(*matrix.compute), space_(space) {}

    SolveReport run(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x) {
        const double first_square = start(b, x);
        if (first_square == 0.0) return {.iterations = 0, .converged = true};
        const double tolerance = target.relative_residual * target.relative_residual * first_square;
        EnergyErrorEstimate gains(10);
        double rz = apply_preconditioner(), beta = 0.0;
        copy(compute_, space_.z, space_.p);  // set_residual has sized space_.points and set its guards
        SolveReport report;
        while (target.goes_on(report.iterations)) {
            ++report.iterations;
            for_chunks(compute_, matrix_.slices(), [&](Slices range) {
                kernels().turn(beta, view(space_.z), space_.p.axes(), range);
                place_points(compute_, *matrix_.pattern, space_.p, space_.points, range);
            });
            const double curvature = multiply_placed(matrix_, space_.p, space_.points, space_.q);
            if (!(curvature > 0.0) || !std::isfinite(rz)) {
                if (!matrix_.of_forces->loads.empty() && report.iterations == 1) add_scaled(x, 1.0, space_.p);
                return report;
            }
            const double alpha = rz / curvature;
            gains.add(alpha * rz);
            const auto [square, product] = advance(alpha, x);
            report.converged = square <= tolerance || square == 0.0 || (gains.small_enough(target) && keeps_net(target.net));
            if (report.converged) return report;
            const double next = preconditioner_ ? apply_preconditioner() : product;
            beta = next / rz;
            rz = next;
        }
        return report;
    }

private:
    const Kernels& kernels() const { return *compute_.kernels; }
    static ConstAxes view(const Vec3Arrays& vectors) { return vectors.axes(); }

    /// r = b - A x on the free vertices; returns its square.
    double start(const Vec3Arrays& b, const Vec3Arrays& x) {
        if (space_.r.padded_size() != b.padded_size()) {
            for (auto* vectors : {&space_.r, &space_.z, &space_.p, &space_.q}) vectors->resize(static_cast<int>(b.padded_size()));
        }
        set_residual(matrix_, b, x, space_.points, space_.r);
        return dot(compute_, space_.r, space_.r);
    }

    bool keeps_net(std::span<const NetLimit> limits) const {
        return net_is_small<double>(limits, {space_.r.x.data(), space_.r.y.data(), space_.r.z.data()}, 1.0);
    }

    /// x += alpha p, r -= alpha q, and z where the preconditioner is the diagonal; returns r . r and then r . z.
    std::array<double, 2> advance(double alpha, Vec3Arrays& x) {
        return sum_pairs(compute_, matrix_.slices(), chunk_slices, [&](Slices range, int) {
            const double square = kernels().advance(alpha, view(space_.p), view(space_.q), x.axes(), space_.r.axes(), range);
            if (preconditioner_) return std::array<double, 2>{square, 0.0};
            precondition(matrix_, space_.r, space_.z, range);
            return std::array<double, 2>{square, kernels().dot(view(space_.r), view(space_.z), range)};
        });
    }

    /// z = preconditioned r; returns r . z.
    double apply_preconditioner() {
        if (preconditioner_) {
            preconditioner_(space_.r, space_.z);
        } else {
            for_chunks(compute_, matrix_.slices(), [&](Slices range) { precondition(matrix_, space_.r, space_.z, range); });
        }
        return dot(compute_, space_.r, space_.z);
    }

    const BlockMatrix& matrix_;
    const Preconditioner& preconditioner_;
    const Compute& compute_;
    SolveSpace& space_;
};

}  // namespace

SolveReport solve_cg(const BlockMatrix& matrix, const Vec3Arrays& b, const SolveTarget& target, SolveSpace& space, Vec3Arrays& x,
                     const Preconditioner& preconditioner) {
    return Solve(matrix, preconditioner, space).run(b, target, x);
}

}  // namespace percale
