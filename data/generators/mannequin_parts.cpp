#include "generators/mannequin_parts.h"

#include <algorithm>
#include <cmath>

namespace percale::scenes {

namespace {

BodyPart part(const Vec3& from, const Vec3& to, double radius_from, double radius_to, double blend) {
    const double length = (to - from).norm(), sine = (radius_from - radius_to) / length;
    return {from, (to - from) / length, length, radius_from, radius_to, sine, std::sqrt(1.0 - sine * sine), blend};
}

// Lengths in m. Lists with x > 0 are the left half of the body (it faces +z) and are mirrored.
const BodyPart head_capsules[] = {
    part({0, 1.694, -0.026}, {0, 1.690, 0.014}, 0.086, 0.081, 0.0),    // skull
    part({0, 1.660, 0.020}, {0, 1.600, 0.040}, 0.070, 0.046, 0.06),    // face
    part({0, 1.470, -0.030}, {0, 1.610, -0.012}, 0.062, 0.055, 0.04),  // neck
};
const BodyPart trunk_capsules[] = {
    part({0.078, 1.345, 0.002}, {0.058, 1.180, 0.006}, 0.106, 0.090, 0.0),     // rib cage
    part({0.054, 1.200, 0.006}, {0.054, 1.040, 0.004}, 0.088, 0.090, 0.10),    // waist
    part({0.056, 1.050, 0.004}, {0.080, 0.930, 0.000}, 0.092, 0.098, 0.10),    // pelvis
    part({0.070, 0.930, -0.034}, {0.078, 0.890, -0.030}, 0.084, 0.078, 0.08),  // seat
    part({0.030, 1.482, -0.028}, {0.172, 1.424, -0.018}, 0.040, 0.050, 0.08),  // shoulder girdle
    part({0.090, 1.345, 0.048}, {0.080, 1.300, 0.052}, 0.058, 0.056, 0.08),    // breast
};
const BodyPart arm_capsules[] = {
    part({0.186, 1.418, -0.016}, {0.371, 1.203, -0.024}, 0.057, 0.041, 0.0),   // upper arm
    part({0.371, 1.203, -0.024}, {0.521, 1.005, 0.010}, 0.041, 0.029, 0.03),   // forearm
    part({0.400, 1.167, -0.012}, {0.432, 1.122, -0.004}, 0.039, 0.035, 0.05),  // its muscle
    part({0.530, 0.992, 0.022}, {0.566, 0.938, 0.036}, 0.020, 0.019, 0.04),    // palm, thumb's side
    part({0.530, 0.992, 0.006}, {0.568, 0.938, 0.008}, 0.020, 0.019, 0.04),    // palm, little finger's side
    part({0.566, 0.938, 0.034}, {0.612, 0.862, 0.036}, 0.019, 0.018, 0.03),    // fingers, closed
    part({0.568, 0.938, 0.010}, {0.612, 0.866, 0.017}, 0.019, 0.018, 0.04),
    part({0.536, 0.982, 0.034}, {0.550, 0.930, 0.068}, 0.020, 0.018, 0.03),  // thumb
};
const BodyPart leg_capsules[] = {
    part({0.092, 0.890, -0.004}, {0.103, 0.500, 0.004}, 0.087, 0.053, 0.0),    // thigh
    part({0.103, 0.500, 0.004}, {0.109, 0.090, -0.022}, 0.051, 0.034, 0.05),   // shank
    part({0.104, 0.400, -0.020}, {0.107, 0.290, -0.022}, 0.046, 0.036, 0.08),  // calf
    part({0.106, 0.036, -0.044}, {0.112, 0.028, 0.135}, 0.038, 0.029, 0.05),   // foot, inner side
    part({0.112, 0.034, -0.040}, {0.148, 0.026, 0.112}, 0.036, 0.027, 0.05),   // foot, outer side
    part({0.109, 0.085, -0.012}, {0.118, 0.040, 0.085}, 0.036, 0.026, 0.06),   // instep
};

/// Exact signed distance. In the half plane through the axis (y along it, r off it) the hull's side is a line of slope
/// sine = (r1 - r2) / length that touches both circles.
double distance(const BodyPart& part, const Vec3& point) {
    const Vec3 offset = point - part.from;
    const double y = offset.dot(part.axis), square = offset.squaredNorm();
    const double r = std::sqrt(std::max(0.0, square - y * y));
    const double along = part.cosine * y - part.sine * r;
    if (along < 0.0) return std::sqrt(square) - part.radius_from;
    if (along > part.cosine * part.length) return std::sqrt((y - part.length) * (y - part.length) + r * r) - part.radius_to;
    return part.cosine * r + part.sine * y - part.radius_from;
}

}  // namespace

std::span<const BodyPart> head_parts() { return head_capsules; }
std::span<const BodyPart> trunk_parts() { return trunk_capsules; }
std::span<const BodyPart> arm_parts() { return arm_capsules; }
std::span<const BodyPart> leg_parts() { return leg_capsules; }

double smooth_minimum(double a, double b, double blend) {
    if (blend <= 0.0) return std::min(a, b);
    const double h = std::max(0.0, 1.0 - std::abs(a - b) / blend);
    return std::min(a, b) - h * h * h * blend / 6.0;
}

double parts_distance(std::span<const BodyPart> parts, const Vec3& point) {
    double nearest = distance(parts[0], point);
    for (const BodyPart& part : parts.subspan(1)) nearest = smooth_minimum(nearest, distance(part, point), part.blend);
    return nearest;
}

double both_sides_distance(std::span<const BodyPart> parts, const Vec3& point, double blend) {
    return smooth_minimum(parts_distance(parts, point), parts_distance(parts, {-point[0], point[1], point[2]}), blend);
}

double core_distance(const Vec3& point) {
    return smooth_minimum(both_sides_distance(trunk_capsules, point, 0.10), parts_distance(head_capsules, point), 0.07);
}

}  // namespace percale::scenes
