#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/support/bench_unit.h"

namespace percale::test {

/// The hanging sheet by classical Runge-Kutta in a straightforward implementation: an array of springs, an array of vertices,
/// one operation after the other. It shares no code with the engine but the type of a 3-vector.
class PlainRk4 {
public:
    explicit PlainRk4(int n) : springs_(plain_springs(n)), x_(static_cast<std::size_t>(n) * n), v_(x_.size(), Vec3::Zero()) {
        const auto share = [n](int i) { return i == 0 || i == n - 1 ? 0.5 : 1.0; };
        for (int i = 0; i < n * n; ++i) {
            x_[i] = {-0.5 + i % n / (n - 1.0), 0.0, -0.5 + i / n / (n - 1.0)};
            mass_.push_back(0.2 / ((n - 1.0) * (n - 1.0)) * share(i % n) * share(i / n));
            held_.push_back(i == 0 || i == n - 1);
        }
        for (auto* stage : {&a_, &stage_x_, &stage_v_, &sum_v_, &sum_a_}) stage->resize(x_.size());
    }

    /// dt in s.
    void step(double dt) {
        stage_x_ = x_;
        stage_v_ = v_;
        add_stage(dt / 6.0, 0.5 * dt, true);
        add_stage(dt / 3.0, 0.5 * dt, false);
        add_stage(dt / 3.0, dt, false);
        add_stage(dt / 6.0, 0.0, false);
        for (std::size_t i = 0; i < x_.size(); ++i) {
            x_[i] += sum_v_[i];
            v_[i] += sum_a_[i];
        }
    }

    const std::vector<Vec3>& positions() const { return x_; }

private:
    void add_stage(double weight, double ahead, bool first) {
        accelerate();
        for (std::size_t i = 0; i < x_.size(); ++i) {
            sum_v_[i] = first ? Vec3(weight * stage_v_[i]) : Vec3(sum_v_[i] + weight * stage_v_[i]);
            sum_a_[i] = first ? Vec3(weight * a_[i]) : Vec3(sum_a_[i] + weight * a_[i]);
            stage_x_[i] = x_[i] + ahead * stage_v_[i];
            stage_v_[i] = v_[i] + ahead * a_[i];
        }
    }

    /// a_ at the stage; 0 where a vertex is held.
    void accelerate() {
        std::fill(a_.begin(), a_.end(), Vec3::Zero());
        for (const PlainSpring& s : springs_) {
            const Vec3 x = stage_x_[s.a] - stage_x_[s.b];
            const double length = x.norm();
            const Vec3 d = x / length;
            const Vec3 f = -(s.stiffness * (length - s.rest) + s.damping * (stage_v_[s.a] - stage_v_[s.b]).dot(d)) * d;
            a_[s.a] += f;
            a_[s.b] -= f;
        }
        for (std::size_t i = 0; i < x_.size(); ++i)
            a_[i] = held_[i] ? Vec3(Vec3::Zero()) : Vec3(a_[i] / mass_[i] + Vec3(0.0, -9.81, 0.0));
    }

    std::vector<PlainSpring> springs_;
    std::vector<double> mass_;  // kg
    std::vector<char> held_;
    std::vector<Vec3> x_, v_, a_, stage_x_, stage_v_, sum_v_, sum_a_;
};

}  // namespace percale::test
