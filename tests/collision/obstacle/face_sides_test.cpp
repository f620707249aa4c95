#include "collision/obstacle/face_sides.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/certificate/inside_test.h"
#include "collision/obstacle/obstacle_surface.h"
#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"
#include "tests/support/skip.h"

namespace percale::test::face_sides_test {
namespace {

std::vector<FaceSides> sides_of(const TriangleMesh& mesh) { return face_sides(mesh.vertices, mesh.triangles); }

std::vector<bool> internal(const TriangleMesh& mesh) {
    std::vector<bool> result;
    for (const FaceSides sides : sides_of(mesh)) result.push_back(sides == FaceSides::internal);
    return result;
}

std::array<int, 4> counts(const TriangleMesh& mesh) {
    std::array<int, 4> result{};
    for (const FaceSides sides : sides_of(mesh)) ++result[static_cast<std::size_t>(sides)];
    return result;  // unproven, outward, inward, internal
}

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

TEST_CASE("the solid is behind the normals of a closed mesh and of its cavity, before them where it is inside out") {
    const TriangleMesh solid = l_solid(), cavity = moved(inside_out(make_box({0.2, 0.2, 0.2})), {0.5, 0.5, 0.5});
    CHECK(counts(solid) == std::array{0, 20, 0, 0});
    CHECK(counts(inside_out(solid)) == std::array{0, 0, 20, 0});
    CHECK(counts(joined(solid, cavity)) == std::array{0, 32, 0, 0});
}

namespace {

/// A closed mesh in the form that winding numbers need.
struct Asked {
    std::vector<certificate::Corners> corners;
    certificate::BoxTree tree;

    explicit Asked(const TriangleMesh& mesh)
        : corners(certificate::corners_of(mesh)), tree(std::span<const certificate::Corners>(corners)) {}
    bool solid_at(const Vec3& x) const { return certificate::winding_number(x, corners, tree) != 0; }
};

Vec3 point_within(const certificate::Corners& t, Random& random) {
    double a = random.number(0.01, 0.98), b = random.number(0.01, 0.98);
    if (a + b > 0.99) a = 0.99 - 0.5 * a, b = 0.49 * (1.0 - b);
    return t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
}

/// At how many of five places on a triangle the solid is not on the stated sides.
int wrong_places(const Asked& asked, std::size_t triangle, FaceSides said, Random& random) {
    const certificate::Corners& t = asked.corners[triangle];
    const Vec3 little = 1e-8 * (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    int wrong = 0;
    for (int sample = 0; sample < 5; ++sample) {
        const Vec3 at = point_within(t, random);
        const bool before = asked.solid_at(at + little), behind = asked.solid_at(at - little);
        wrong += before != (said != FaceSides::outward) || behind != (said != FaceSides::inward) ? 1 : 0;
    }
    return wrong;
}

}  // namespace

TEST_CASE("on triangles of which something is proven it holds everywhere") {
    std::array<int, 4> found{};
    for (unsigned seed = 0; seed < 60; ++seed) {
        Random random(seed);
        const TriangleMesh mesh = tangled_ball(0.3, 1 + static_cast<int>(seed % 3), random.number(0.1, 0.4), seed);
        const Asked asked(mesh);
        const std::vector<FaceSides> sides = sides_of(mesh);
        int wrong = 0;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            ++found[static_cast<std::size_t>(sides[i])];
            if (sides[i] != FaceSides::unproven) wrong += wrong_places(asked, i, sides[i], random);
        }
        CAPTURE(seed);
        CHECK(wrong == 0);
    }
    const auto [unproven, outward, inward, internal_faces] = found;
    CHECK(unproven > 1000);
    CHECK(outward > 1000);
    CHECK(inward > 50);
    CHECK(internal_faces > 5);
}

TEST_CASE("a face that another part touches keeps its place, wherever it is touched") {
    const TriangleMesh floor = make_box({2, 1, 2});  // its top at y = 0.5
    TriangleMesh wedge = make_box({0.5, 0.5, 0.5});
    for (Vec3& x : wedge.vertices) x = Vec3(x.x(), (x.y() + x.z()) / std::sqrt(2.0), (x.z() - x.y()) / std::sqrt(2.0));
    double lowest = 0.0;
    for (const Vec3& x : wedge.vertices) lowest = std::min(lowest, x.y());
    const double at = GENERATE(-0.4, 0.0, 0.1, 1.0 / 3.0);  // a third: through the middle of a triangle of the top
    const TriangleMesh both = joined(floor, moved(wedge, {at, 0.5 - lowest, at}));
    const std::vector<FaceSides> sides = sides_of(both);
    for (const FaceSides face : sides) CHECK((face == FaceSides::outward || face == FaceSides::unproven));
}

TEST_CASE("neighbours that go through each other's plane along an edge prove nothing") {
    // Two tetrahedra with one corner in common: an edge of the second lies in the first's top, its faces go up and down from
    // there.
    const TriangleMesh slab{
        .vertices = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}, {1, -1, 1}, {2, 0, 2}, {-3, 0.5, 3}, {-3, -0.2, 3}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}}};
    CHECK(sides_of(slab)[0] == FaceSides::unproven);
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

}  // namespace percale::test::face_sides_test
