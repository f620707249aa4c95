#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "percale/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::shapes_test {
namespace {

double signed_volume(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
    return volume;
}

/// Every edge is used once each way, so the surface is closed and wound in one sense.
bool is_closed(const TriangleMesh& mesh) {
    std::map<std::pair<int, int>, int> uses;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        if (count != 1 || back == uses.end() || back->second != 1) return false;
    }
    return true;
}

int euler_characteristic(const TriangleMesh& mesh) {
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    }
    return static_cast<int>(mesh.vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size());
}

void check_ball_like(const TriangleMesh& mesh) {
    CHECK(is_closed(mesh));
    CHECK(euler_characteristic(mesh) == 2);
    CHECK(signed_volume(mesh) > 0.0);
    CHECK_NOTHROW(check_mesh(mesh, "shape", true));
    CHECK_FALSE(mesh.is_grid());
}

Vec3 normal(const TriangleMesh& mesh, const Triangle& t) {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

double polygon_area(double radius, int corners) {
    return 0.5 * corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners);
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("A grid numbers its vertices row by row over the stated rectangle") {
    const TriangleMesh grid = make_grid(2.0, 3.0, 5, 7);
    REQUIRE(grid.vertices.size() == 35);
    CHECK(grid.grid_columns == 5);
    CHECK(grid.grid_rows == 7);
    for (int r = 0; r < 7; ++r) {
        for (int c = 0; c < 5; ++c) {
            const Vec3& x = grid.vertices[r * 5 + c];
            CHECK(x.x() == Approx(-1.0 + c * 2.0 / 4).margin(1e-15));
            CHECK(x.y() == 0.0);
            CHECK(x.z() == Approx(-1.5 + r * 3.0 / 6).margin(1e-15));
        }
    }
}

TEST_CASE("Grid cells are split along alternating diagonals and face up") {
    const int columns = 5, rows = 4;
    const TriangleMesh grid = make_grid(1.0, 1.0, columns, rows);
    REQUIRE(grid.triangles.size() == 2 * (columns - 1) * (rows - 1));
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : grid.triangles) {
        CHECK(normal(grid, t).y() > 0.0);
        CHECK(normal(grid, t).x() == 0.0);
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    }
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c + 1 < columns; ++c) {
            const int a = r * columns + c;
            CHECK(edges.count({a, a + columns + 1}) == ((c + r) % 2 == 0));
            CHECK(edges.count({a + 1, a + columns}) == ((c + r) % 2 == 1));
        }
    }
    CHECK_NOTHROW(check_mesh(grid, "grid", true));
    CHECK(euler_characteristic(grid) == 1);
}

TEST_CASE("Spheres are closed, outward, on their radius and grow towards the ball's volume") {
    const double radius = 0.3, ball = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    const double edge = 4.0 * radius / std::sqrt(10.0 + 2.0 * std::sqrt(5.0));
    const double icosahedron = 5.0 / 12.0 * (3.0 + std::sqrt(5.0)) * edge * edge * edge;
    CHECK(signed_volume(make_sphere(radius, 0)) == Approx(icosahedron).epsilon(1e-13));
    double missing = ball - icosahedron;
    for (int level = 0; level <= 4; ++level) {
        const TriangleMesh sphere = make_sphere(radius, level);
        check_ball_like(sphere);
        CHECK(sphere.triangles.size() == 20u << (2 * level));
        for (const Vec3& x : sphere.vertices) CHECK(std::abs(x.norm() - radius) < 1e-15);
        if (level == 0) continue;
        // The volume error falls with the square of the edge length.
        const double now = ball - signed_volume(sphere);
        CHECK(missing / now == Approx(4.0).epsilon(level == 1 ? 0.25 : 0.1));
        missing = now;
    }
}

TEST_CASE("A box has its exact volume and extent") {
    const TriangleMesh box = make_box({1.0, 2.0, 0.5});
    check_ball_like(box);
    CHECK(box.triangles.size() == 12);
    CHECK(signed_volume(box) == Approx(1.0).epsilon(1e-15));
    for (const Vec3& x : box.vertices) CHECK(x.cwiseAbs() == Vec3(0.5, 1.0, 0.25));
}

TEST_CASE("A cylinder is a prism over a regular polygon") {
    for (const int segments : {3, 8, 33}) {
        const TriangleMesh cylinder = make_cylinder(0.4, 1.5, segments);
        check_ball_like(cylinder);
        CHECK(signed_volume(cylinder) == Approx(1.5 * polygon_area(0.4, segments)).epsilon(1e-13));
        for (const Vec3& x : cylinder.vertices) CHECK(std::abs(x.y()) == 0.75);
    }
}

TEST_CASE("A capsule is a stack of frusta between two poles") {
    for (const double height : {0.0, 0.8}) {
        for (const int segments : {4, 8, 24}) {
            const double radius = 0.3;
            const TriangleMesh capsule = make_capsule(radius, height, segments);
            check_ball_like(capsule);
            double volume = height * polygon_area(radius, segments);
            for (int i = 0; i < segments / 4; ++i) {
                const auto angle = [&](int k) { return 2.0 * std::numbers::pi * k / segments; };
                const double low = radius * std::cos(angle(i)), high = radius * std::cos(angle(i + 1));
                const double rise = radius * (std::sin(angle(i + 1)) - std::sin(angle(i)));
                volume +=
                    2.0 * rise / 3.0 *
                    (polygon_area(low, segments) + polygon_area(high, segments) + polygon_area(std::sqrt(low * high), segments));
            }
            CHECK(signed_volume(capsule) == Approx(volume).epsilon(1e-7));
            for (const Vec3& x : capsule.vertices) {
                const Vec3 centre(0.0, std::clamp(x.y(), -height / 2, height / 2), 0.0);
                CHECK((x - centre).norm() == Approx(radius).epsilon(1e-14));
            }
        }
    }
}

TEST_CASE("A plane is two triangles that face up") {
    const TriangleMesh plane = make_plane(2.5);
    REQUIRE(plane.triangles.size() == 2);
    double area = 0.0;
    for (const Triangle& t : plane.triangles) {
        CHECK(normal(plane, t).y() == normal(plane, t).norm());
        area += 0.5 * normal(plane, t).norm();
    }
    CHECK(area == 25.0);
}

TEST_CASE("Shapes refuse impossible sizes and name the value") {
    CHECK(mentions(scene_error([] { make_grid(-1.5, 1.0, 3, 3); }), {"make_grid", "-1.5", "m"}));
    CHECK(mentions(scene_error([] { make_grid(1.0, nan_value, 3, 3); }), {"make_grid", "nan"}));
    CHECK(mentions(scene_error([] { make_grid(1.0, 1.0, 1, 3); }), {"make_grid", "1 x 3", "at least 2"}));
    CHECK(mentions(scene_error([] { make_grid(1.0, 1.0, 100000, 100000); }), {"make_grid", "100000 x 100000", "1073741823"}));
    CHECK(mentions(scene_error([] { make_sphere(-0.25, 2); }), {"make_sphere", "-0.25"}));
    CHECK(mentions(scene_error([] { make_sphere(1.0, 9); }), {"make_sphere", "0 ... 8", "9"}));
    CHECK(mentions(scene_error([] { make_sphere(1.0, -1); }), {"make_sphere", "-1"}));
    CHECK(mentions(scene_error([] { make_box({1.0, -2.5, 1.0}); }), {"make_box", "-2.5"}));
    CHECK(mentions(scene_error([] { make_cylinder(-0.75, 1.0, 8); }), {"make_cylinder", "-0.75"}));
    CHECK(mentions(scene_error([] { make_cylinder(1.0, 1.0, 2); }), {"make_cylinder", "at least 3", "2"}));
    CHECK(mentions(scene_error([] { make_capsule(1.0, -0.125, 8); }), {"make_capsule", "-0.125"}));
    CHECK(mentions(scene_error([] { make_capsule(1.0, 1.0, 6); }), {"make_capsule", "multiple of 4", "6"}));
    CHECK(mentions(scene_error([] { make_plane(0.0); }), {"make_plane", "0.0"}));
}

}  // namespace percale::test::shapes_test
