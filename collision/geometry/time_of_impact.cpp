#include "geometry/time_of_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/clamp_floor.h"
#include "geometry/triangle_distance.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Times the last digit of the largest coordinate. No clamp leaves less, whatever was there: a smaller distance means nothing.
/// Smaller: features pressed together until rounding decides have crossed. Larger: cloth that is so near cannot move.
constexpr double rounding_of_coordinates = 32.0;

/// Number of advances after which a pair's time-of-impact lower bound is the last one proven. Too few: clamps fall far short
/// where the clearance is tiny against the displacement. No value is unsafe.
constexpr int max_advances = 500;

double squared_distance(const std::array<Vec3, 4>& x, PairShape shape) {
    if (shape == PairShape::point_triangle) return closest_on_triangle(x[0], x[1], x[2], x[3]).distance_squared;
    return closest_on_edges(x[0], x[1], x[2], x[3]).distance_squared;
}

/// A bound of the relative speed of any two points of the pair after the mean motion is subtracted.
double largest_approach(const std::array<Vec3, 4>& motion, PairShape shape) {
    const auto length = [&](int i) { return motion[i].norm(); };
    if (shape == PairShape::point_triangle) return length(0) + std::max({length(1), length(2), length(3)});
    return std::max(length(0), length(1)) + std::max(length(2), length(3));
}

}  // namespace

double time_of_impact_lower_bound(const MovingFour& four, PairShape shape, double floor, double latest) {
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
    for (int advance = 0; advance < max_advances; ++advance) {
        const double next = time + (1.0 - tolerances::clearance_left) * left / speed;
        if (next >= latest) return latest;
        for (int i = 0; i < 4; ++i) x[i] = four.from[i] + next * motion[i];
        left = clearance();
        if (left < tolerances::clearance_left * first) return left > 0.0 ? next : time;
        time = next;
    }
    return time;
}

double rounding_floor(const MovingFour& four) {
    double largest = 0.0;
    for (int i = 0; i < 4; ++i) {
        largest = std::max({largest, four.from[i].cwiseAbs().maxCoeff(), four.to[i].cwiseAbs().maxCoeff()});
    }
    return rounding_of_coordinates * std::numeric_limits<double>::epsilon() * largest;
}

double clamped_distance(const MovingFour& four, double distance, double thickness) {
    return std::max(floor_below(distance, thickness), rounding_floor(four));
}

double gap_along(const MovingFour& four, unsigned side, const Vec3& direction, double time) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (int i = 0; i < 4; ++i) {
        const double height = direction.dot(four.from[i]) + time * direction.dot(four.to[i] - four.from[i]);
        if ((side >> i & 1U) != 0) lowest = std::min(lowest, height);
        if ((side >> i & 1U) == 0) highest = std::max(highest, height);
    }
    return lowest - highest;
}

}  // namespace percale
