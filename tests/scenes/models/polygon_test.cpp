#include "scenes/models/polygon.h"

#include <algorithm>
#include <sstream>

#include "scenes/meshes/mesh_import.h"
#include "scenes/meshes/obj_file.h"
#include "scenes/meshes/off_file.h"
#include "scenes/meshes/ply_file.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::scenes::test::polygon_test {
namespace {

/// An L; its fan from the fourth corner on, which is the one at the inner angle, is right, others are not.
const std::vector<Vec3> ell = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};

/// Half the cross products, in all: no triangle may lie on its back.
double area_of(const std::vector<Triangle>& triangles, std::span<const Vec3> x, const Vec3& normal) {
    double area = 0.0;
    for (const Triangle& t : triangles) {
        const double part = 0.5 * normal.dot((x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]));
        CHECK(part > 0.0);
        area += part;
    }
    return area;
}

std::vector<Vec3> turned(std::vector<Vec3> corners, int by) {
    std::rotate(corners.begin(), corners.begin() + by, corners.end());
    return corners;
}

}  // namespace

TEST_CASE("an L is divided without a fold, whichever corner comes first") {
    for (int by = 0; by < 6; ++by) {
        CAPTURE(by);
        const std::vector<Vec3> corners = turned(ell, by);
        const std::vector<Triangle> triangles = polygon_triangles(corners);
        CHECK(triangles.size() == 4);
        CHECK(area_of(triangles, corners, Vec3::UnitZ()) == Approx(3.0));
    }
    CHECK(polygon_triangles(turned(ell, 3)) == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

TEST_CASE("any simple polygon, anywhere in space, is covered once") {
    Random random(8);
    int folded = 0;
    for (int round = 0; round < 60; ++round) {
        const std::vector<Point2> outline = bumpy_outline(random, 0.3, 0.03);
        const Pose pose = random.pose(2.0);
        std::vector<Vec3> corners;
        double twice = 0.0;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Point2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
            corners.push_back(transform(pose, Vec3(a.x(), a.y(), 0.001 * random.number(-1.0, 1.0))));  // nearly in a plane
            twice += a.x() * b.y() - a.y() * b.x();
            folded += k > 1 && turn_left(outline[0], outline[k - 1], a) < 0.0 ? 1 : 0;
        }
        const Vec3 normal = transform(Pose{.rotation = pose.rotation}, Vec3::UnitZ());
        const std::vector<Triangle> triangles = polygon_triangles(corners);
        CHECK(triangles.size() == outline.size() - 2);
        CHECK(area_of(triangles, corners, normal) == Approx(0.5 * twice));
    }
    CHECK(folded > 60);  // fans would not do
}

TEST_CASE("where corners lie on a line no triangle is without area") {
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    CHECK(area_of(polygon_triangles(corners), corners, Vec3::UnitZ()) == Approx(2.0));
}

TEST_CASE("polygons that cross themselves or have no area are fanned, those with too few corners are nothing") {
    const std::vector<Triangle> two = {{0, 1, 2}, {0, 2, 3}};
    CHECK(polygon_triangles(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0.9, 0}}) == two);
    CHECK(polygon_triangles(std::vector<Vec3>(4, Vec3(1, 2, 3))) == two);
    CHECK(polygon_triangles(std::vector<Vec3>(2, Vec3(1, 2, 3))).empty());
}

TEST_CASE("two lists are of the same polygons if every polygon is, however it is cut") {
    const std::vector<Triangle> fan = {{0, 1, 2}, {0, 2, 3}}, other = {{3, 0, 1}, {1, 2, 3}}, tail = {{3, 2, 4}};
    const auto joined = [](std::vector<Triangle> first, const std::vector<Triangle>& second) {
        first.insert(first.end(), second.begin(), second.end());
        return first;
    };
    CHECK(are_same_polygons(fan, fan));
    CHECK(are_same_polygons(joined(fan, tail), joined(other, tail)));
    CHECK(are_same_polygons(joined(tail, fan), joined(tail, other)));
    CHECK_FALSE(are_same_polygons(joined(fan, tail), fan));
    CHECK_FALSE(are_same_polygons(joined(fan, tail), joined(other, {{2, 3, 4}})));  // on its back
    CHECK_FALSE(are_same_polygons(fan, std::vector<Triangle>{{0, 1, 2}, {0, 2, 4}}));
    // Two closed surfaces of the same vertices are two surfaces.
    const std::vector<Triangle> solid = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                                inside_out = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    CHECK_FALSE(are_same_polygons(solid, inside_out));
}

TEST_CASE("every format divides a concave face alike, texture coordinates with it") {
    const std::vector<Vec3> corners = turned(ell, 1);
    const std::vector<Triangle> expected = polygon_triangles(corners);
    std::string obj, off = "OFF\n6 1 0\n",
                     ply =
                         "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                         "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                         "end_header\n6 0 1 2 3 4 5\n";
    for (const Vec3& x : corners) {
        std::ostringstream line;
        line << x.x() << " " << x.y() << " " << x.z() << "\n";
        obj += "v " + line.str() + "vt " + line.str();
        off += line.str();
        ply += line.str();
    }
    std::istringstream obj_in(obj + "f 1/1 2/2 3/3 4/4 5/5 6/6\n"), off_in(off + "6 0 1 2 3 4 5\n"), ply_in(ply);
    const TexturedMesh textured = read_textured_obj(obj_in, "ell.obj");
    CHECK(textured.mesh.triangles == expected);
    CHECK(read_off(off_in, "ell.off").triangles == expected);
    CHECK(read_ply(ply_in, "ell.ply").triangles == expected);  // its face stands before its vertices
    REQUIRE(textured.uv.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
        for (int c = 0; c < 3; ++c) CHECK(textured.uv[k][c] == corners[expected[k][c]].head<2>());
    }
}

}  // namespace percale::scenes::test::polygon_test
