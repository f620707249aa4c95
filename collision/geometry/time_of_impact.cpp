#include "geometry/time_of_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/triangle_distance.h"

namespace percale {
namespace {

double squared_distance(const std::array<Vec3, 4>& x, PairShape shape) {
    if (shape == PairShape::point_triangle) return closest_on_triangle(x[0], x[1], x[2], x[3]).distance_squared;
    return closest_on_edges(x[0], x[1], x[2], x[3]).distance_squared;
}

/// A bound of the relative speed of any two points of the pair, once the mean motion is taken off.
double largest_approach(const std::array<Vec3, 4>& motion, PairShape shape) {
    const auto length = [&](int i) { return motion[i].norm(); };
    if (shape == PairShape::point_triangle) return length(0) + std::max({length(1), length(2), length(3)});
    return std::max(length(0), length(1)) + std::max(length(2), length(3));
}

}  // namespace

double safe_time(const MovingFour& four, PairShape shape, double floor, double latest) {
    constexpr double kept = 0.1;  // share of the clearance left at the end
    constexpr int most_advances = 500;
    std::array<Vec3, 4> x = four.from, motion;
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < 4; ++i) mean += 0.25 * (four.to[i] - four.from[i]);
    for (int i = 0; i < 4; ++i) motion[i] = four.to[i] - four.from[i] - mean;
    const double speed = largest_approach(motion, shape);
    if (speed == 0.0) return latest;
    // Clearance d - floor, as (d^2 - floor^2)/(d + floor) to keep digits where both are near.
    const auto clearance = [&] {
        const double square = squared_distance(x, shape);
        return (square - floor * floor) / (std::sqrt(square) + floor);
    };
    const double first = clearance();
    if (!(first > 0.0)) return 0.0;
    double time = 0.0, left = first;
    for (int advance = 0; advance < most_advances; ++advance) {
        const double next = time + (1.0 - kept) * left / speed;
        if (next >= latest) return latest;
        for (int i = 0; i < 4; ++i) x[i] = four.from[i] + next * motion[i];
        left = clearance();
        if (left < kept * first) return left > 0.0 ? next : time;
        time = next;
    }
    return time;
}

double gap_along(const MovingFour& four, unsigned side, const Vec3& direction, double time) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int i = 0; i < 4; ++i) {
        const double height = direction.dot(four.from[i]) + time * direction.dot(four.to[i] - four.from[i]);
        if ((side >> i & 1U) != 0) least = std::min(least, height);
        if ((side >> i & 1U) == 0) most = std::max(most, height);
    }
    return least - most;
}

}  // namespace percale
