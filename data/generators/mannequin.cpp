#include "generators/mannequin.h"

#include <cmath>

#include "generators/mannequin_parts.h"
#include "generators/mesh_relax.h"
#include "generators/surface_net.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

/// m. Step of the differences for the mannequin's normals. Smaller: rounding. Larger: corners are rounded.
constexpr double normal_step = 1e-5;

/// Maximum number of Newton steps to the mannequin's surface, and the distance in m at which they end.
constexpr int max_surface_steps = 20;
constexpr double surface_error = 1e-12;

/// Rounds of relaxing the mannequin first and after each merge, merges, and the fraction of the spacing below which edges merge.
/// Other values give another mesh than the shipped one.
constexpr int mannequin_first_rounds = 4, mannequin_rounds = 5, mannequin_merges = 3;
constexpr double mannequin_merge_ratio = 0.5;

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
    for (int round = 0; round < max_surface_steps; ++round) {
        const double d = mannequin_distance(x);
        if (std::abs(d) < surface_error) break;
        const Vec3 slope = gradient(x);
        x -= d / slope.squaredNorm() * slope;
    }
    return x;
}

}  // namespace

double mannequin_distance(const Vec3& point) {
    const double upper = smooth_minimum(core_distance(point), both_sides_distance(arm_parts(), point, 0.0), 0.05);
    const double body = smooth_minimum(upper, both_sides_distance(leg_parts(), point, 0.02), 0.06);
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
        collapse_short_edges(half, mannequin_merge_ratio * spacing);
        relax(half, mannequin_rounds, project);
    }
    return mirrored(half);
}

}  // namespace percale::scenes
