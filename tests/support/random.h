#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "percale/mesh.h"

namespace percale::test {

/// Random geometry from a seed.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    int index(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
    /// A random number uniform over the orders of magnitude.
    double decades(double low, double high) { return std::pow(10.0, number(std::log10(low), std::log10(high))); }
    Vec3 point(double size) {
        const double x = number(-size, size), y = number(-size, size);
        return {x, y, number(-size, size)};
    }
    Vec3 unit() {
        Vec3 x = point(1.0);
        while (x.norm() < 0.1) x = point(1.0);
        return x.normalized();
    }
    Rotation rotation(double max_angle = std::numbers::pi) {
        const double angle = number(0.0, max_angle);
        const Vec3 axis = std::sin(0.5 * angle) * unit();
        return {std::cos(0.5 * angle), axis.x(), axis.y(), axis.z()};
    }
    Pose pose(double reach, double max_angle = std::numbers::pi) {
        return {.translation = point(reach), .rotation = rotation(max_angle), .scale = 1.0};
    }

private:
    std::mt19937 engine_;
};

}  // namespace percale::test
