#pragma once

#include <algorithm>
#include <array>

namespace percale {

/// When to stop. A rule is off where its number is 0; the first that holds ends the solve.
struct SolveTarget {
    double relative_residual = 0.0;  // |r| <= this |r at the start|, over free vertices
    /// Energy norm of the error, estimated by the gains alpha_k (r.z)_k of the last iterations (Hestenes and Stiefel's error
    /// formula), scaled up after many iterations: <= relative_gain^2 (sum of all gains), or <= absolute_gain (J s^2).
    double relative_gain = 0.0;
    double absolute_gain = 0.0;
    int most_iterations = 2000;
};

struct SolveReport {
    int iterations = 0;
    bool converged = false;
};

/// The sum of all gains and of those of the last `window` iterations, at most 10.
class GainRecord {
public:
    explicit GainRecord(int window) : window_size_(window) {}
    void add(double gain) {
        window_[count_++ % window_size_] = gain;
        total_ += gain;
    }
    bool small_enough(const SolveTarget& target) const {
        if ((target.relative_gain <= 0.0 && target.absolute_gain <= 0.0) || count_ < window_size_) return false;
        double recent = 0.0;
        for (int k = 0; k < window_size_; ++k) recent += window_[k];
        // The longer the way so far, the more is likely to come after the window.
        const double ahead = recent * std::max(1.0, count_ / (4.0 * window_size_));
        return ahead <= std::max(target.relative_gain * target.relative_gain * total_, target.absolute_gain);
    }

private:
    std::array<double, 10> window_{};
    int window_size_;
    double total_ = 0.0;
    int count_ = 0;
};

}  // namespace percale
