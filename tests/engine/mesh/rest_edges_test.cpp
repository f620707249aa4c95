#include "engine/mesh/rest_edges.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::rest_edges_test {
namespace {

using Corners = std::vector<std::array<Vec3, 3>>;

/// Two triangles of a unit square in the plane z = 0, joined along the diagonal from vertex 0 to vertex 2.
const std::vector<Triangle> square = {{0, 1, 2}, {0, 2, 3}};

Corners corners_of(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
    Corners corners;
    for (const auto& [a, b, c] : triangles) corners.push_back({x[a], x[b], x[c]});
    return corners;
}

const RestEdge& edge_between(const std::vector<MeshEdge>& edges, const std::vector<RestEdge>& rest, int a, int b) {
    const auto found = std::find_if(edges.begin(), edges.end(), [&](const MeshEdge& e) { return e.vertex == std::array{a, b}; });
    REQUIRE(found != edges.end());
    return rest[static_cast<std::size_t>(found - edges.begin())];
}

TriangleMesh square_mesh() { return {.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .triangles = square}; }

}  // namespace

TEST_CASE("Edges whose triangles have their places in common keep them, folded ones too") {
    for (const double height : {0.0, 0.4, -0.7}) {
        const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, height}};
        const std::vector<MeshEdge> edges = mesh_edges(square);
        const std::vector<RestEdge> rest = rest_edges(square, edges, corners_of(x, square));
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const auto [a, b] = edges[k].vertex;
            CHECK(rest[k].corner[0] == x[a]);
            CHECK(rest[k].corner[1] == x[b]);
            CHECK(rest[k].corner[2] == x[edges[k].opposite[0]]);
            if (edges[k].opposite[1] >= 0) CHECK(rest[k].corner[3] == x[edges[k].opposite[1]]);
            CHECK(rest[k].length == Approx((x[a] - x[b]).norm()));
        }
    }
}

TEST_CASE("Triangles laid out apart, turned or mirrored are unfolded flat across their edge") {
    const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<MeshEdge> edges = mesh_edges(square);
    const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, 3).normalized());
    const std::function<Vec3(const Vec3&)> ways[] = {[](const Vec3& p) { return Vec3(p + Vec3(5, -2, 0)); },
                                                     [&](const Vec3& p) { return Vec3(turn * p + Vec3(0, 0, 4)); },
                                                     [](const Vec3& p) { return Vec3(p.y(), p.x(), 0.0); }};
    for (const auto& way : ways) {
        Corners corners = corners_of(x, square);
        for (Vec3& corner : corners[1]) corner = way(corner);
        const RestEdge diagonal = edge_between(edges, rest_edges(square, edges, corners), 0, 2);
        CHECK((diagonal.corner[2] - x[1]).norm() < 1e-15);
        CHECK((diagonal.corner[3] - x[3]).norm() < 1e-14);
        CHECK(diagonal.length == Approx(std::sqrt(2.0)));
    }
}

TEST_CASE("An edge that is longer in one of its panels has the mean length, and the other side's height") {
    const std::vector<MeshEdge> edges = mesh_edges(square);
    Corners corners = corners_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, square);
    for (Vec3& corner : corners[1]) corner = 3.0 * corner + Vec3(2, 0, 0);
    const RestEdge diagonal = edge_between(edges, rest_edges(square, edges, corners), 0, 2);
    CHECK(diagonal.length == Approx(2.0 * std::sqrt(2.0)));
    CHECK((diagonal.corner[3] - diagonal.corner[0]).cross(Vec3(1, 1, 0)).norm() == Approx(3.0));  // height 3/sqrt(2) over it
}

TEST_CASE("The rest shape of another mesh has its corners, and other triangles are refused by number") {
    const TriangleMesh mesh = square_mesh();
    TriangleMesh rest = mesh;
    for (Vec3& x : rest.vertices) x *= 2.0;
    const RestShape shape = rest_shape_of(mesh, rest, "flag");
    REQUIRE(shape.corners.size() == 2);
    CHECK(shape.corners[1][2] == Vec3(0, 2, 0));
    rest.triangles[1] = {0, 3, 2};
    CHECK(scene_error([&] { rest_shape_of(mesh, rest, "flag"); }).find("triangle 1") != std::string::npos);
    rest.triangles.pop_back();
    CHECK(scene_error([&] { rest_shape_of(mesh, rest, "flag"); }).find("1 triangles, the mesh has 2") != std::string::npos);
}

TEST_CASE("An invalid rest shape is refused, by triangle and reason") {
    const TriangleMesh mesh = square_mesh();
    const RestShape good = rest_shape_of(mesh, mesh, "flag");
    const auto refusal = [&](auto change) {
        RestShape shape = good;
        change(shape);
        return scene_error([&] { check_rest_shape(mesh, shape, "flag"); });
    };
    CHECK(refusal([](RestShape&) {}).empty());
    CHECK(refusal([](RestShape& s) { s.corners.pop_back(); }).find("1 triangles") != std::string::npos);
    CHECK(refusal([](RestShape& s) { s.corners[1][0].x() = NAN; }).find("triangle 1 of its rest shape is not finite") !=
          std::string::npos);
    CHECK(refusal([](RestShape& s) { s.corners[1][0] = s.corners[1][1]; }).find("no area") != std::string::npos);
    CHECK(refusal([](RestShape& s) { s.warp = Vec3(0, 0, 1); }).find("upright on triangle 0") != std::string::npos);
    CHECK(refusal([](RestShape& s) { s.warp = Vec3(0, NAN, 1); }).find("warp is not finite") != std::string::npos);
    CHECK(scene_error([&] {
              check_rest_shape(make_grid(1, 1, 3, 3), {.corners = {}, .warp = Vec3::UnitX()}, "flag");
          }).find("a grid is its own") != std::string::npos);
}

TEST_CASE("Without a rest shape corners are those of the mesh") {
    const TriangleMesh mesh = square_mesh();
    CHECK(rest_corners(mesh, {}, 1) == std::array<Vec3, 3>{mesh.vertices[0], mesh.vertices[2], mesh.vertices[3]});
}

}  // namespace percale::test::rest_edges_test
