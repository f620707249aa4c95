#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "percale/mesh.h"
#include "tests/support/random.h"

namespace percale::test {

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.vertices) x += by;
    return mesh;
}

inline TriangleMesh placed(TriangleMesh mesh, const Pose& pose) {
    mesh.vertices = transform(pose, mesh.vertices);
    return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
    const int offset = static_cast<int>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    return a;
}

/// An open tube about the y axis, its middle at the origin, wound so that normals point at the axis or all away from it.
struct TubeShape {
    double low = 1.0, top = 1.0;  // m, radii at both ends
    double height = 1.0;          // m
    int around = 24, rows = 8;    // vertices
};
inline TriangleMesh make_tube(const TubeShape& shape) {
    const auto& [low, top, height, around, rows] = shape;
    TriangleMesh mesh;
    for (int i = 0; i < around * rows; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i % around) / around, up = (i / around) / (rows - 1.0);
        const double radius = std::lerp(low, top, up);
        mesh.vertices.emplace_back(radius * std::cos(angle), height * (up - 0.5), radius * std::sin(angle));
        if (i / around == rows - 1) continue;
        const int next = i - i % around + (i + 1) % around;
        mesh.triangles.push_back({i, next, i + around});
        mesh.triangles.push_back({next, next + around, i + around});
    }
    return mesh;
}

/// A frame: a closed bar of square section around the y axis, with a hole that cloth goes through.
inline TriangleMesh make_frame(double radius, double bar, int around) {
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / around;
        for (const auto& [out, up] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
            const double reach = radius + out * bar;
            mesh.vertices.emplace_back(reach * std::cos(angle), up * bar, reach * std::sin(angle));
        }
    }
    for (int i = 0; i < around; ++i) {
        const int here = 4 * i, next = 4 * ((i + 1) % around);
        for (int k = 0; k < 4; ++k) {
            const int other = (k + 1) % 4;
            mesh.triangles.push_back({here + k, here + other, next + k});
            mesh.triangles.push_back({here + other, next + other, next + k});
        }
    }
    return mesh;
}

/// A ball whose vertices are pulled out and pushed in along their radii: closed, not convex, no self-intersections.
inline TriangleMesh spiky_ball(double radius, int level, double amplitude, unsigned seed) {
    TriangleMesh ball = make_sphere(radius, level);
    Random random(seed);
    for (Vec3& x : ball.vertices) x *= 1.0 + random.number(-amplitude, amplitude);
    return ball;
}

/// A ball whose vertices are moved anywhere by up to `amplitude` along each axis: closed, self-intersecting, and inside out in
/// places.
inline TriangleMesh tangled_ball(double radius, int level, double amplitude, unsigned seed) {
    TriangleMesh ball = make_sphere(radius, level);
    Random random(seed);
    for (Vec3& x : ball.vertices) x += random.point(amplitude);
    return ball;
}

/// Unconnected triangles of very different sizes.
inline TriangleMesh soup(int count, unsigned seed) {
    Random random(seed);
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 centre = random.point(0.5);
        const double size = random.decades(1e-3, 0.5);
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + random.point(size));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// An L of height 1 along z: squares of side 1 at (0, 0), (1, 0) and (0, 1). Its valley is the edge at (1, 1), vertices 3 and 9.
inline TriangleMesh l_solid() {
    constexpr double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    TriangleMesh mesh;
    for (const double z : {0.0, 1.0}) {
        for (const auto& [x, y] : outline) mesh.vertices.emplace_back(x, y, z);
    }
    for (int i = 1; i + 1 < 6; ++i) {
        mesh.triangles.push_back({6, 6 + i, 7 + i});
        mesh.triangles.push_back({0, i + 1, i});
    }
    for (int i = 0; i < 6; ++i) {
        const int j = (i + 1) % 6;
        mesh.triangles.push_back({i, j, 6 + j});
        mesh.triangles.push_back({i, 6 + j, 6 + i});
    }
    return mesh;
}

/// A square sheet with random bumps.
inline TriangleMesh crumpled_sheet(double size, int count, double amplitude, Random& random) {
    TriangleMesh sheet = make_grid(size, size, count, count);
    for (Vec3& x : sheet.vertices) x += random.point(amplitude);
    return sheet;
}

/// Moves some vertices far through the body: long spikes that leave it on the other side, inside out around their feet.
inline TriangleMesh pierced_ball(double radius, Random& random) {
    TriangleMesh ball = make_sphere(radius, 1);
    for (Vec3& x : ball.vertices) x *= random.index(3) == 0 ? random.number(-1.5, -0.5) : random.number(0.6, 1.4);
    return ball;
}

/// A tube that is bent so far that it intersects itself, closed at both ends.
inline TriangleMesh bent_tube(Random& random) {
    TriangleMesh tube = make_capsule(0.08, 0.6, 12);
    const double bend = random.number(4.0, 9.0), shift = random.number(-0.06, 0.06);
    for (Vec3& x : tube.vertices) {
        const double angle = bend * x.y(), reach = 0.15 + x.x();
        x = Vec3(reach * std::cos(angle) - 0.15, reach * std::sin(angle), x.z() + shift * angle);
    }
    return tube;
}

/// Boxes that stand on each other, share planes and corners.
inline TriangleMesh touching_boxes(Random& random) {
    const double side = 0.125 * (1 + random.index(3));
    TriangleMesh all = make_box({0.5, 0.25, 0.5});
    all = joined(all, moved(make_box({side, 0.25, side}), {0.125 * random.index(3) - 0.125, 0.25, 0.0625}));
    return joined(all, moved(make_box({0.125, side, 0.125}), {0.25, 0.125 + 0.5 * side, -0.1875}));
}

}  // namespace percale::test
