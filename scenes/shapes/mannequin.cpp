#include "shapes/mannequin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "percale/error.h"
#include "shapes/mesh_relax.h"
#include "shapes/surface_net.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// The hull of two spheres. `blend`: reach of the smooth minimum with the parts before it in its list, m.
struct BodyPart {
    Vec3 from, axis;  // axis: unit, towards the second sphere
    double length, radius_from, radius_to;
    double sine, cosine;  // of the slope of its side
    double blend;
};

BodyPart part(const Vec3& from, const Vec3& to, double radius_from, double radius_to, double blend) {
    const double length = (to - from).norm(), sine = (radius_from - radius_to) / length;
    return {from, (to - from) / length, length, radius_from, radius_to, sine, std::sqrt(1.0 - sine * sine), blend};
}

// Lengths in m. Lists with x > 0 are the left half of the body (it faces +z) and are mirrored.
const BodyPart head[] = {
    part({0, 1.694, -0.026}, {0, 1.690, 0.014}, 0.086, 0.081, 0.0),    // skull
    part({0, 1.660, 0.020}, {0, 1.600, 0.040}, 0.070, 0.046, 0.06),    // face
    part({0, 1.470, -0.030}, {0, 1.610, -0.012}, 0.062, 0.055, 0.04),  // neck
};
const BodyPart trunk[] = {
    part({0.078, 1.345, 0.002}, {0.058, 1.180, 0.006}, 0.106, 0.090, 0.0),     // rib cage
    part({0.054, 1.200, 0.006}, {0.054, 1.040, 0.004}, 0.088, 0.090, 0.10),    // waist
    part({0.056, 1.050, 0.004}, {0.080, 0.930, 0.000}, 0.092, 0.098, 0.10),    // pelvis
    part({0.070, 0.930, -0.034}, {0.078, 0.890, -0.030}, 0.084, 0.078, 0.08),  // seat
    part({0.030, 1.482, -0.028}, {0.172, 1.424, -0.018}, 0.040, 0.050, 0.08),  // shoulder girdle
    part({0.090, 1.345, 0.048}, {0.080, 1.300, 0.052}, 0.058, 0.056, 0.08),    // breast
};
const BodyPart arm[] = {
    part({0.186, 1.418, -0.016}, {0.371, 1.203, -0.024}, 0.057, 0.041, 0.0),   // upper arm
    part({0.371, 1.203, -0.024}, {0.521, 1.005, 0.010}, 0.041, 0.029, 0.03),   // forearm
    part({0.400, 1.167, -0.012}, {0.432, 1.122, -0.004}, 0.039, 0.035, 0.05),  // its muscle
    part({0.530, 0.992, 0.022}, {0.566, 0.938, 0.036}, 0.020, 0.019, 0.04),    // palm, thumb's side
    part({0.530, 0.992, 0.006}, {0.568, 0.938, 0.008}, 0.020, 0.019, 0.04),    // palm, little finger's side
    part({0.566, 0.938, 0.034}, {0.612, 0.862, 0.036}, 0.019, 0.018, 0.03),    // fingers, closed
    part({0.568, 0.938, 0.010}, {0.612, 0.866, 0.017}, 0.019, 0.018, 0.04),
    part({0.536, 0.982, 0.034}, {0.550, 0.930, 0.068}, 0.020, 0.018, 0.03),  // thumb
};
const BodyPart leg[] = {
    part({0.092, 0.890, -0.004}, {0.103, 0.500, 0.004}, 0.087, 0.053, 0.0),    // thigh
    part({0.103, 0.500, 0.004}, {0.109, 0.090, -0.022}, 0.051, 0.034, 0.05),   // shank
    part({0.104, 0.400, -0.020}, {0.107, 0.290, -0.022}, 0.046, 0.036, 0.08),  // calf
    part({0.106, 0.036, -0.044}, {0.112, 0.028, 0.135}, 0.038, 0.029, 0.05),   // foot, inner side
    part({0.112, 0.034, -0.040}, {0.148, 0.026, 0.112}, 0.036, 0.027, 0.05),   // foot, outer side
    part({0.109, 0.085, -0.012}, {0.118, 0.040, 0.085}, 0.036, 0.026, 0.06),   // instep
};

/// C2 smooth minimum: min(a, b) - h^3 blend / 6 with h = max(0, 1 - |a - b| / blend). Symmetric in a and b.
double smooth_minimum(double a, double b, double blend) {
    if (blend <= 0.0) return std::min(a, b);
    const double h = std::max(0.0, 1.0 - std::abs(a - b) / blend);
    return std::min(a, b) - h * h * h * blend / 6.0;
}

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

double joined(std::span<const BodyPart> parts, const Vec3& point) {
    double nearest = distance(parts[0], point);
    for (const BodyPart& part : parts.subspan(1)) nearest = smooth_minimum(nearest, distance(part, point), part.blend);
    return nearest;
}

double both_sides(std::span<const BodyPart> parts, const Vec3& point, double blend) {
    return smooth_minimum(joined(parts, point), joined(parts, {-point[0], point[1], point[2]}), blend);
}

Vec3 gradient(const Vec3& point) {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 offset = normal_step * Vec3::Unit(axis);
        slope[axis] = (mannequin_distance(point + offset) - mannequin_distance(point - offset)) / (2.0 * normal_step);
    }
    return slope;
}

/// Newton's method along the gradient: x <- x - d grad d / |grad d|^2.
Vec3 on_surface(Vec3 x) {
    for (int round = 0; round < most_surface_steps; ++round) {
        const double d = mannequin_distance(x);
        if (std::abs(d) < surface_error) break;
        const Vec3 slope = gradient(x);
        x -= d / slope.squaredNorm() * slope;
    }
    return x;
}

}  // namespace

double mannequin_distance(const Vec3& point) {
    const double core = smooth_minimum(both_sides(trunk, point, 0.10), joined(head, point), 0.07);
    const double upper = smooth_minimum(core, both_sides(arm, point, 0.0), 0.05);
    const double body = smooth_minimum(upper, both_sides(leg, point, 0.02), 0.06);
    return -smooth_minimum(-body, point[1], 0.012);  // soles cut flat at the floor
}

TriangleMesh make_mannequin(double spacing) {
    if (!(spacing >= 0.008 && spacing <= 0.02))
        throw SceneError("mannequin: spacing is " + std::to_string(spacing) + " m, allowed are 0.008 ... 0.02");
    const Vec3 lowest(0.0, -0.01, -0.20), highest(0.68, mannequin_height + 0.01, 0.24);  // m, beyond every part
    TriangleMesh half = half_surface_net(mannequin_distance, {lowest, highest}, spacing);
    // Moves along the surface only, so that tips stay where they are; the seam stays in its plane.
    const Projection project = [&](std::size_t v, const Vec3& moved) {
        const Vec3 before = half.vertices[v], normal = gradient(before).normalized();
        const bool seam = before[0] == 0.0;
        Vec3 x = moved - normal.dot(moved - before) * normal;
        if (seam) x[0] = 0.0;
        x = on_surface(x);
        if (seam) x[0] = 0.0;
        return x;
    };
    relax(half, mannequin_first_rounds, project);
    for (int round = 0; round < mannequin_merges; ++round) {
        collapse_short_edges(half, mannequin_merge_share * spacing);
        relax(half, mannequin_rounds, project);
    }
    return mirrored(half);
}

}  // namespace percale::scenes
