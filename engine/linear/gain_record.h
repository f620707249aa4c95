#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>

#include "../tolerances.h"
#include "support/deadline.h"

namespace percale {

/// Vertices that nothing holds. What a solve leaves of their common motion is the sum of their residuals: it may be `most`, kg
/// m/s.
struct NetLimit {
    int first = 0, count = 0;
    double most = 0.0;
};

/// When to stop. A rule is off where its number is 0; the first that holds ends the solve.
struct SolveTarget {
    double relative_residual = 0.0;  // |r| <= this |r at the start|, over free vertices
    /// Energy norm of the error, estimated by the gains alpha_k (r.z)_k of the last iterations (Hestenes and Stiefel's error
    /// formula) and by how fast they fall: <= relative_gain^2 (sum of all gains), or <= absolute_gain (J s^2).
    double relative_gain = 0.0;
    double absolute_gain = 0.0;
    std::span<const NetLimit> net = {};  // gains are small enough only where these hold too
    int most_iterations = 2000;
    Deadline deadline = {};  // behind it no iteration begins but the first

    bool goes_on(int iterations) const { return iterations < most_iterations && (iterations == 0 || !is_past(deadline)); }
};

/// Whether residuals, whose axes lie one after the other, keep these limits. `unit` is the size of a residual of 1, kg m/s.
template <typename Number>
bool net_is_small(std::span<const NetLimit> limits, std::array<const Number*, 3> residual, double unit) {
    return std::all_of(limits.begin(), limits.end(), [&](const NetLimit& limit) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = limit.first; i < limit.first + limit.count; ++i) sum[axis] += residual[axis][i];
        }
        return unit * sum.norm() <= limit.most;
    });
}

struct SolveReport {
    int iterations = 0;
    bool converged = false;
};

/// The gains of a solve: all, and those of the last four windows of some iterations (at most 10) each.
class GainRecord {
public:
    explicit GainRecord(int window) : window_(window) {}
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
    /// What is likely to come. Where gains fall fast it is less than those of the last window, but the more the longer the way
    /// has been. Else the matrix is badly conditioned and they come in bursts: then as from windows like the last four, of which
    /// each has as large a share of the one before as the slowest of these.
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
        const double bounded = std::min(ratio, most_gain_ratio);
        return all * bounded / (1.0 - bounded);
    }

    std::array<double, 40> recent_{};
    int window_;
    double total_ = 0.0;
    int count_ = 0;
};

}  // namespace percale
