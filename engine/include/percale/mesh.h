#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string>
#include <vector>

namespace percale {

using Vec3 = Eigen::Vector3d;
using Triangle = std::array<int, 3>;  // vertex indices, counter-clockwise seen from outside

/// A triangle mesh: garment, panel or obstacle. Lengths in m.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    /// Vertices per row and rows of a regular grid made by make_grid; 0 for a free mesh.
    /// A grid has structural, shear and bending springs, a free mesh has structural and bending springs.
    int grid_columns = 0;
    int grid_rows = 0;

    bool is_grid() const { return grid_columns > 0 && grid_rows > 0; }
};

/// Unit quaternion as four plain doubles (no alignment demands on the host program).
struct Rotation {
    double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

/// x -> translation + rotation (scale x).
struct Pose {
    Vec3 translation = Vec3::Zero();  // m
    Rotation rotation = {};           // unit quaternion
    double scale = 1.0;               // > 0
};

/// Whether two poses are the same number for number.
bool operator==(const Pose& a, const Pose& b);

/// The image of a point under a pose. Every part of Percale uses this one function, so that the
/// solver, the frames on disk and the certificate see the same bits.
Vec3 transform(const Pose& pose, const Vec3& point);
std::vector<Vec3> transform(const Pose& pose, std::span<const Vec3> points);
/// The point whose image under the pose is `x`.
Vec3 inverse_transform(const Pose& pose, const Vec3& x);

/// The rotation by `first`, then by `second`.
Rotation product(const Rotation& second, const Rotation& first);
/// The angle of the shortest rotation from one to the other, rad, 0 ... pi.
double angle_between(const Rotation& a, const Rotation& b);
/// The pose at a fraction `share`, 0 ... 1, between two poses: on the straight line, by the shortest rotation at an even rate
/// (Shoemake 1985, Animating rotation with quaternion curves), at the scale of the first.
Pose interpolate(const Pose& from, const Pose& to, double share);

/// Flat grid in the plane y = 0, centred, normals +y. Vertex (column c, row r) has index r * columns + c and lies at
/// x = -width/2 + c width/(columns-1), z = -depth/2 + r depth/(rows-1). Cell (c, r) is split along its
/// (c, r)-(c+1, r+1) diagonal where c + r is even, else along the other.
/// width, depth > 0 in m; columns, rows >= 2. Throws SceneError.
TriangleMesh make_grid(double width, double depth, int columns, int rows);

/// Icosahedron subdivided `level` times (20 * 4^level triangles), vertices on the sphere; radius > 0 in m, level 0 ... 8.
TriangleMesh make_sphere(double radius, int level);

/// Axis-parallel box, centred, 12 triangles; edge lengths > 0 in m.
TriangleMesh make_box(const Vec3& size);

/// Closed cylinder about the y axis, centred; radius, height > 0 in m, segments >= 3 around.
TriangleMesh make_cylinder(double radius, double height, int segments);

/// Capsule about the y axis, centred; `height` is the length between the centres of its two half spheres.
/// radius > 0, height >= 0 in m, segments >= 4 (a multiple of 4) around.
TriangleMesh make_capsule(double radius, double height, int segments);

/// Horizontal square of two triangles at y = 0, normals +y; half_size > 0 in m.
TriangleMesh make_plane(double half_size);

/// Checks that a mesh can be simulated or collided with. Throws SceneError naming `name`, the index and the value: not finite,
/// index out of range, no triangles. With `for_cloth`: also duplicate triangles, zero-area triangles, edges with three or more
/// triangles, vertices without a triangle.
void check_mesh(const TriangleMesh& mesh, const std::string& name, bool for_cloth);

}  // namespace percale
