#include "conjugate_gradient.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace percale {
namespace {

constexpr int gain_window = 10;

/// The sum of all gains and of those of the last few iterations.
class GainRecord {
public:
    void add(double gain) {
        window_[count_++ % gain_window] = gain;
        total_ += gain;
    }
    bool small_enough(const SolveTarget& target) const {
        if ((target.relative_gain <= 0.0 && target.absolute_gain <= 0.0) || count_ < gain_window) return false;
        double recent = 0.0;
        for (const double gain : window_) recent += gain;
        return recent <= std::max(target.relative_gain * target.relative_gain * total_, target.absolute_gain);
    }

private:
    std::array<double, gain_window> window_{};
    double total_ = 0.0;
    int count_ = 0;
};

void size_space(SolveSpace& space, std::size_t padded) {
    if (space.r.padded_size() == padded) return;
    for (auto* vectors : {&space.r, &space.z, &space.p, &space.q}) vectors->resize(static_cast<int>(padded));
}

/// r = b - A x on the free vertices.
void start_residual(const BlockMatrix& matrix, const Vectors& b, const Vectors& x, SolveSpace& space) {
    multiply(matrix, x, space.q);
    space.r = b;
    add_scaled(space.r, -1.0, space.q);
    filter(matrix, space.r);
}

}  // namespace

SolveReport solve_cg(const BlockMatrix& matrix, const Vectors& b, const SolveTarget& target, SolveSpace& space, Vectors& x) {
    size_space(space, b.padded_size());
    start_residual(matrix, b, x, space);
    SolveReport report;
    const double first_square = dot(space.r, space.r);
    if (first_square == 0.0) return {.iterations = 0, .converged = true};
    precondition(matrix, space.r, space.z);
    space.p = space.z;
    double rz = dot(space.r, space.z);
    GainRecord gains;
    while (report.iterations < target.most_iterations) {
        ++report.iterations;
        multiply(matrix, space.p, space.q);
        filter(matrix, space.q);
        const double curvature = dot(space.p, space.q);
        if (!(curvature > 0.0)) return report;
        const double alpha = rz / curvature;
        add_scaled(x, alpha, space.p);
        add_scaled(space.r, -alpha, space.q);
        gains.add(alpha * rz);
        const double square = dot(space.r, space.r);
        const double tolerance = target.relative_residual * target.relative_residual * first_square;
        if (square <= tolerance || square == 0.0 || gains.small_enough(target)) {
            report.converged = true;
            return report;
        }
        precondition(matrix, space.r, space.z);
        const double next = dot(space.r, space.z);
        const double beta = next / rz;
        rz = next;
        for (std::size_t i = 0; i < x.padded_size(); ++i) {
            space.p.x[i] = space.z.x[i] + beta * space.p.x[i];
            space.p.y[i] = space.z.y[i] + beta * space.p.y[i];
            space.p.z[i] = space.z.z[i] + beta * space.p.z[i];
        }
    }
    return report;
}

}  // namespace percale
