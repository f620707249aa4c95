#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>

#include "support/deadline.h"

namespace percale {

/// Ratio of energy gains from one window to the next. Below it they fall fast, and the last window alone gives the estimate of
/// future gains. Larger: badly conditioned systems count as solved too early. (Inline, as a header reads it.)
inline constexpr double slow_gain_ratio = 0.8;

/// The largest ratio in the sum of the future gains. 1: no bound.
inline constexpr double max_gain_ratio = 0.99;

/// Vertices that nothing holds. Their unbalanced momentum after a solve is the sum of their residuals; it may be at most
/// `max_momentum`, kg m/s.
struct NetLimit {
    int first = 0, count = 0;
    double max_momentum = 0.0;
};

/// The stopping rules of a solve. A rule is off where its number is 0; the first that holds ends the solve.
struct SolveTarget {
    double relative_residual = 0.0;  // |r| <= this |r at the start|, over free vertices
    /// Energy norm of the error, estimated by the gains alpha_k (r.z)_k of the last iterations (Hestenes and Stiefel's error
    /// formula) and by how fast they fall: <= relative_gain^2 (sum of all gains), or <= absolute_gain (J s^2).
    double relative_gain = 0.0;
    double absolute_gain = 0.0;
    std::span<const NetLimit> net = {};  // gains are small enough only where these hold too
    int max_iterations = 2000;
    Deadline deadline = {};  // after it only a first iteration begins

    bool goes_on(int iterations) const { return iterations < max_iterations && (iterations == 0 || !is_past(deadline)); }
};

/// Whether residuals, stored axis after axis, satisfy these limits. `unit` is the size of a residual of 1, kg m/s.
template <typename Number>
bool net_is_small(std::span<const NetLimit> limits, std::array<const Number*, 3> residual, double unit) {
    return std::all_of(limits.begin(), limits.end(), [&](const NetLimit& limit) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = limit.first; i < limit.first + limit.count; ++i) sum[axis] += residual[axis][i];
        }
        return unit * sum.norm() <= limit.max_momentum;
    });
}

struct SolveReport {
    int iterations = 0;
    bool converged = false;
};

/// Estimates the error from the gains of a solve: all, and those of the last four windows of some iterations (at most 10) each.
class EnergyErrorEstimate {
public:
    explicit EnergyErrorEstimate(int window) : window_(window) {}
    void add(double gain) {
        recent_[count_++ % recent_.size()] = gain;
        total_ += gain;
    }
    bool small_enough(const SolveTarget& target) const {
        if ((target.relative_gain <= 0.0 && target.absolute_gain <= 0.0) || count_ < window_) return false;
        return ahead() <= std::max(target.relative_gain * target.relative_gain * total_, target.absolute_gain);
    }

private:
    double in_window(int number) const {
        double sum = 0.0;
        for (int k = count_ - (number + 1) * window_; k < count_ - number * window_; ++k) sum += recent_[k % recent_.size()];
        return sum;
    }
    /// The sum of the gains to be expected. Where gains fall fast it is less than the last window, but grows with the number of
    /// iterations. Else the matrix is badly conditioned and gains come in bursts: the sum is then that of the last four windows,
    /// continued as a geometric series with their slowest ratio.
    double ahead() const {
        const int windows = std::min(4, count_ / window_);
        const double last = in_window(0);
        double ratio = 0.0, all = last;
        for (int k = 1; k < windows; ++k) {
            const double before = in_window(k);
            ratio = std::max(ratio, in_window(k - 1) / before);
            all += before;
        }
        if (ratio < slow_gain_ratio) return last * std::max(1.0, count_ / (4.0 * window_));
        const double bounded = std::min(ratio, max_gain_ratio);
        return all * bounded / (1.0 - bounded);
    }

    std::array<double, 40> recent_{};
    int window_;
    double total_ = 0.0;
    int count_ = 0;
};

}  // namespace percale
