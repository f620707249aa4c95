#include "collision/obstacle/internal_faces.h"

#include <algorithm>
#include <cmath>

#include "collision/certificate/inside_test.h"
#include "collision/obstacle/obstacle_surface.h"
#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/skip.h"

namespace percale::test::internal_faces_test {
namespace {

std::vector<bool> internal(const TriangleMesh& mesh) { return internal_faces(mesh.vertices, mesh.triangles); }

int count(const std::vector<bool>& flags) { return static_cast<int>(std::count(flags.begin(), flags.end(), true)); }

}  // namespace

TEST_CASE("a mesh without overlap has no internal face, whichever way it faces") {
    for (const TriangleMesh& mesh : {make_box({1, 1, 1}), make_sphere(1, 2), l_solid()}) {
        CHECK(count(internal(mesh)) == 0);
        CHECK(count(internal(inside_out(mesh))) == 0);
    }
    CHECK(count(internal(joined(make_box({1, 1, 1}), moved(make_box({1, 1, 1}), {3, 0, 0})))) == 0);
}

TEST_CASE("a part wholly inside another is internal, a cavity is not") {
    const TriangleMesh outer = make_box({2, 2, 2}), inner = make_sphere(0.5, 1);
    const std::vector<bool> nested = internal(joined(outer, inner));
    for (std::size_t i = 0; i < nested.size(); ++i) CHECK(nested[i] == (i >= 12));
    CHECK(count(internal(joined(outer, inside_out(inner)))) == 0);
}

TEST_CASE("of overlapping spheres the faces wholly inside the other go, those that are crossed stay") {
    const TriangleMesh a = make_sphere(1.0, 3), b = moved(make_sphere(0.8, 3), {0.9, 0.05, 0.02}), both = joined(a, b);
    const std::vector<bool> dropped = internal(both);
    for (std::size_t i = 0; i < dropped.size(); ++i) {
        const bool first = i < a.triangles.size();
        const Vec3 centre = first ? Vec3(0.9, 0.05, 0.02) : Vec3(0, 0, 0);
        const double radius = first ? 0.8 : 1.0;
        double nearest = 1e300, farthest = 0.0;
        for (const int v : both.triangles[i]) {
            const double distance = (both.vertices[v] - centre).norm();
            nearest = std::min(nearest, distance);
            farthest = std::max(farthest, distance);
        }
        if (farthest < 0.95 * radius) CHECK(dropped[i]);
        if (nearest > radius) CHECK_FALSE(dropped[i]);
    }
    CHECK(count(dropped) > 200);
}

TEST_CASE("boxes that share a face exactly keep it, as their other faces") {
    // Faces that lie in each other count as crossed.
    CHECK(count(internal(joined(make_box({1, 1, 1}), moved(make_box({1, 1, 1}), {1, 0, 0})))) == 0);
}

TEST_CASE("make_surface drops and counts internal faces of closed meshes and leaves open ones alone") {
    const TriangleMesh nested = joined(make_box({2, 2, 2}), make_sphere(0.5, 1));
    const ObstacleSurface surface = make_surface(nested.vertices, nested.triangles);
    CHECK(surface.triangles.size() == 12);
    CHECK(surface.vertices.size() == 8);
    CHECK(surface.watertight);
    CHECK(surface.cleaning.internal_triangles == 80);
    CHECK(surface.cleaning.triangles == 12);
    CHECK(surface.cleaning.unreferenced_vertices == 0);
    CHECK(cleaning_report(nested).internal_triangles == 80);

    TriangleMesh open = nested;
    open.triangles.erase(open.triangles.begin());
    const ObstacleSurface two_sided = make_surface(open.vertices, open.triangles);
    CHECK(two_sided.triangles.size() == 91);
    CHECK_FALSE(two_sided.watertight);
    CHECK(two_sided.cleaning.internal_triangles == 0);
}

TEST_CASE("what is left of overlapping parts is connected consistently") {
    const TriangleMesh both = joined(make_sphere(1.0, 3), moved(make_sphere(0.8, 3), {0.9, 0.05, 0.02}));
    const ObstacleSurface surface = make_surface(both.vertices, both.triangles);
    CHECK(surface.watertight);
    CHECK(surface.triangle_edges.size() == surface.triangles.size());
    std::size_t corners = 0;
    for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
        corners += surface.opposites(e).size();
        if (surface.opposites(e).size() == 1) CHECK(surface.edges[e].can_touch);
    }
    CHECK(corners == 3 * surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
        for (const int v : t) REQUIRE(v < static_cast<int>(surface.vertices.size()));
    }
}

TEST_CASE("what is dropped of a body scan that passes through itself has the solid on both sides, triangle by triangle") {
    const auto scan = read_off(real_mesh_folder() / "man.off");
    if (!scan) {
        skip("no man.off in " + real_mesh_folder().string() + " (PERCALE_REAL_MESHES)");
        return;
    }
    const std::vector<bool> dropped = internal(*scan);
    const std::vector<certificate::Corners> corners = certificate::corners_of(*scan);
    const certificate::BoxTree tree{std::span<const certificate::Corners>(corners)};
    int wrong = 0;
    for (std::size_t i = 0; i < dropped.size(); ++i) {
        if (!dropped[i]) continue;
        const certificate::Corners& t = corners[i];
        const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0, normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        for (const double side : {1e-7, -1e-7}) wrong += certificate::winding_number(middle + side * normal, corners, tree) == 0;
    }
    CHECK(count(dropped) > 100);
    CHECK(wrong == 0);
    CHECK(cleaning_report(*scan).internal_triangles == count(dropped));
}

namespace {

/// Two cones of n triangles each on one rim, with a small ball inside.
TriangleMesh spindle_with_ball(int n) {
    TriangleMesh mesh = make_sphere(0.1, 1);
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {Vec3(0, 1, 0), Vec3(0, -1, 0)});
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / n;
        mesh.vertices.emplace_back(std::cos(angle), 0.0, std::sin(angle));
        const int a = first + 2 + i, b = first + 2 + (i + 1) % n;
        mesh.triangles.push_back({first, b, a});
        mesh.triangles.push_back({first + 1, a, b});
    }
    return mesh;
}

}  // namespace

TEST_CASE("where too many triangles lie side by side the search ends, and all stay") {
    CHECK(count(internal(spindle_with_ball(100))) == 80);
    CHECK(count(internal(spindle_with_ball(2500))) == 0);
    CHECK(cleaning_report(spindle_with_ball(2500)).triangles == 5080);
}

}  // namespace percale::test::internal_faces_test
