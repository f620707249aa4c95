#include "generators/funnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "percale/error.h"

namespace percale::scenes {

namespace {

void check_size(double value, const char* field, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(std::string("funnel: ") + field + " is " + std::to_string(value) + ", allowed are " +
                     std::to_string(lowest) + " ... " + std::to_string(highest));
}

void check(const Funnel& funnel) {
    check_size(funnel.tube, "tube", 1e-3, 100.0);
    check_size(funnel.mouth, "mouth", funnel.tube, 100.0);
    check_size(funnel.cone_height, "cone_height", 1e-3, 100.0);
    check_size(funnel.tube_length, "tube_length", 1e-3, 100.0);
    check_size(funnel.wall, "wall", 1e-4, 100.0);
    check_size(funnel.edge_length, "edge_length", 1e-3, 100.0);
    check_size(funnel.segments_around, "segments_around", 3, 1000);
}

/// A point of the wall's cross-section: distance from the axis and height, m.
struct ProfilePoint {
    double radius = 0.0, height = 0.0;
};

/// The closed cross-section, down inside and up outside.
std::vector<ProfilePoint> profile_of(const Funnel& funnel) {
    const std::vector<ProfilePoint> corners = {
        {funnel.mouth, funnel.cone_height}, {funnel.tube, 0.0},
        {funnel.tube, -funnel.tube_length}, {funnel.tube + funnel.wall, -funnel.tube_length},
        {funnel.tube + funnel.wall, 0.0},   {funnel.mouth + funnel.wall, funnel.cone_height}};
    std::vector<ProfilePoint> points;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const ProfilePoint a = corners[i], b = corners[(i + 1) % corners.size()];
        const double length = std::hypot(b.radius - a.radius, b.height - a.height);
        const int pieces = std::max(1, static_cast<int>(std::lround(length / funnel.edge_length)));
        for (int k = 0; k < pieces; ++k) {
            const double f = static_cast<double>(k) / pieces;
            points.push_back({a.radius + f * (b.radius - a.radius), a.height + f * (b.height - a.height)});
        }
    }
    return points;
}

}  // namespace

TriangleMesh make_funnel(const Funnel& funnel) {
    check(funnel);
    const std::vector<ProfilePoint> profile = profile_of(funnel);
    const int n = static_cast<int>(profile.size()), around = funnel.segments_around;
    TriangleMesh mesh;
    for (int s = 0; s < around; ++s) {
        const double angle = 2.0 * std::numbers::pi * s / around;
        for (const ProfilePoint& p : profile)
            mesh.vertices.emplace_back(p.radius * std::cos(angle), p.height, p.radius * std::sin(angle));
    }
    for (int s = 0; s < around; ++s)
        for (int i = 0; i < n; ++i) {
            const int next = (i + 1) % n, other = (s + 1) % around;
            const int a = s * n + i, b = s * n + next, c = other * n + next, d = other * n + i;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

}  // namespace percale::scenes
