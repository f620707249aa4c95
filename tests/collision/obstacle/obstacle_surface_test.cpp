#include "collision/obstacle/obstacle_surface.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "collision/certificate/inside_test.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::obstacle_surface_test {
namespace {

ObstacleSurface surface_of(const TriangleMesh& mesh) { return make_surface(mesh.vertices, mesh.triangles); }

using Edge = std::pair<int, int>;

std::map<Edge, std::vector<int>> triangles_at_edges(const ObstacleSurface& surface) {
    std::map<Edge, std::vector<int>> result;
    for (int i = 0; i < int(surface.triangles.size()); ++i) {
        for (int k = 0; k < 3; ++k) result[std::minmax(surface.triangles[i][k], surface.triangles[i][(k + 1) % 3])].push_back(i);
    }
    return result;
}

/// Edges, their owners and opposites, triangle edges, rings and vertex owners, from the triangle list alone.
void check_connectivity(const ObstacleSurface& surface) {
    const auto expected = triangles_at_edges(surface);
    REQUIRE(surface.edges.size() == expected.size());
    std::vector<std::set<int>> rings(surface.vertices.size());
    for (int e = 0; e < int(surface.edges.size()); ++e) {
        const auto [a, b] = surface.edges[e].vertex;
        const auto found = expected.find({a, b});
        REQUIRE(found != expected.end());
        CHECK(surface.edges[e].owner == found->second.front());
        std::multiset<int> opposite;
        for (const int i : found->second) {
            const Triangle& t = surface.triangles[i];
            opposite.insert(t[0] + t[1] + t[2] - a - b);
        }
        const auto given = surface.opposites(e);
        CHECK(std::multiset<int>(given.begin(), given.end()) == opposite);
        rings[a].insert(b);
        rings[b].insert(a);
    }
    for (int v = 0; v < int(surface.vertices.size()); ++v) {
        const auto ring = surface.neighbours(v);
        CHECK(ring.size() == rings[v].size());
        CHECK(std::set<int>(ring.begin(), ring.end()) == rings[v]);
        const auto first = std::find_if(surface.triangles.begin(), surface.triangles.end(),
                                        [&](const Triangle& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
        CHECK(surface.vertex_owner[v] == first - surface.triangles.begin());
    }
    for (int i = 0; i < int(surface.triangles.size()); ++i) {
        for (int k = 0; k < 3; ++k) {
            const Edge ends = std::minmax(surface.triangles[i][k], surface.triangles[i][(k + 1) % 3]);
            CHECK(surface.edges[surface.triangle_edges[i][k]].vertex == std::array<int, 2>{ends.first, ends.second});
        }
    }
}

std::set<Edge> touchable_edges(const ObstacleSurface& surface) {
    std::set<Edge> result;
    for (const SurfaceEdge& e : surface.edges) {
        if (e.can_touch) result.insert({e.vertex[0], e.vertex[1]});
    }
    return result;
}

/// A prism along z with a ridge at (0, 0), beside which a side is split off as a face of tiny width, cut along its other
/// diagonal.
TriangleMesh narrow_ridge(double width) {
    TriangleMesh prism;
    for (const double z : {0.0, 1.0}) {
        prism.vertices.insert(prism.vertices.end(), {{-1, -1, z}, {0, -1, z}, {0, -width, z}, {0, 0, z}, {-1, 0, z}});
    }
    for (const int i : {3, 0, 1, 2, 4}) {  // the top first: it owns its edges
        const int j = (i + 1) % 5;
        prism.triangles.push_back({i, j, 5 + i});
        prism.triangles.push_back({j, 5 + j, 5 + i});
    }
    for (int i = 1; i + 1 < 5; ++i) {
        prism.triangles.push_back({5, 5 + i, 6 + i});
        prism.triangles.push_back({0, i + 1, i});
    }
    return prism;
}

}  // namespace

TEST_CASE("the connectivity of balls, boxes, soups and sheets is that of their triangle lists") {
    check_connectivity(surface_of(make_sphere(1.0, 2)));
    check_connectivity(surface_of(make_box({1, 2, 3})));
    check_connectivity(surface_of(soup(50, 3)));
    check_connectivity(surface_of(make_grid(1, 1, 7, 5)));
    check_connectivity(surface_of(l_solid()));
    TriangleMesh fan;  // five triangles at one edge
    fan.vertices = {{0, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 5; ++i) {
        fan.vertices.emplace_back(std::cos(i), std::sin(i), 0.5);
        fan.triangles.push_back({0, 1, 2 + i});
    }
    check_connectivity(surface_of(fan));
}

TEST_CASE("a clean mesh passes unchanged") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    const ObstacleSurface surface = surface_of(ball);
    CHECK(surface.vertices == ball.vertices);
    CHECK(surface.triangles == ball.triangles);
    CHECK(surface.cleaning.merged_vertices == 0);
    CHECK(surface.cleaning.degenerate_triangles == 0);
    CHECK(surface.cleaning.duplicate_triangles == 0);
    CHECK(surface.cleaning.unreferenced_vertices == 0);
}

TEST_CASE("cleaning merges, drops and counts what is repeated, without area or unused") {
    TriangleMesh mesh = make_box({1, 1, 1});
    const int count = int(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.begin(), Vec3(9, 9, 9));  // unused, moves every index
    for (Triangle& t : mesh.triangles) {
        for (int& v : t) ++v;
    }
    mesh.vertices.push_back(mesh.vertices[1]);  // twin of vertex 1
    mesh.vertices.emplace_back(0.1, 0.2, 0.3);
    mesh.vertices.emplace_back(0.2, 0.4, 0.6);
    mesh.vertices.emplace_back(0.3, 0.6, 0.9);
    const int twin = count + 1;
    for (int& v : mesh.triangles.back()) v = v == 1 ? twin : v;
    const auto [a, b, c] = mesh.triangles[3];
    mesh.triangles.push_back({b, c, a});                          // the same again
    mesh.triangles.push_back({a, c, b});                          // and seen from behind
    mesh.triangles.push_back({2, 2, 3});                          // a corner twice
    mesh.triangles.push_back({1, twin, 4});                       // a corner twice once merged
    mesh.triangles.push_back({count + 2, count + 3, count + 4});  // on a line

    const ObstacleSurface surface = surface_of(mesh);
    CHECK(surface.vertices.size() == 8);
    CHECK(surface.triangles.size() == 12);
    CHECK(surface.watertight);
    CHECK(surface.cleaning.merged_vertices == 1);
    CHECK(surface.cleaning.duplicate_triangles == 2);
    CHECK(surface.cleaning.degenerate_triangles == 3);
    CHECK(surface.cleaning.unreferenced_vertices == 4);
    CHECK(surface.cleaning.triangles == 12);
    const CleaningReport report = cleaning_report(mesh);
    CHECK(report.triangles == 12);
    CHECK(report.merged_vertices == 1);
    CHECK(report.duplicate_triangles == 2);
    CHECK(report.degenerate_triangles == 3);
    CHECK(report.unreferenced_vertices == 4);
    check_connectivity(surface);
    for (int i = 0; i < 12; ++i) {
        for (int k = 0; k < 3; ++k) {
            CHECK(surface.vertices[surface.triangles[i][k]] == mesh.vertices[mesh.triangles[i][k]]);
        }
    }
}

TEST_CASE("a mesh whose corners are all separate is welded into a closed one") {
    const TriangleMesh ball = make_sphere(0.5, 2);
    TriangleMesh apart;
    for (const Triangle& t : ball.triangles) {
        for (const int v : t) apart.vertices.push_back(ball.vertices[v]);
        const int last = int(apart.vertices.size());
        apart.triangles.push_back({last - 3, last - 2, last - 1});
    }
    const ObstacleSurface surface = surface_of(apart);
    CHECK(surface.watertight);
    CHECK(surface.vertices.size() == ball.vertices.size());
    CHECK(surface.cleaning.merged_vertices == int(apart.vertices.size() - ball.vertices.size()));
}

TEST_CASE("only a mesh with every edge in two triangles of opposite direction is watertight") {
    CHECK(surface_of(make_sphere(1.0, 1)).watertight);
    CHECK(surface_of(make_box({1, 1, 1})).watertight);
    CHECK(surface_of(l_solid()).watertight);
    CHECK(surface_of(inside_out(make_box({1, 1, 1}))).watertight);
    CHECK_FALSE(surface_of(make_grid(1, 1, 3, 3)).watertight);
    TriangleMesh open = make_sphere(1.0, 1);
    open.triangles.pop_back();
    CHECK_FALSE(surface_of(open).watertight);
    TriangleMesh flipped = make_box({1, 1, 1});
    std::swap(flipped.triangles[5][0], flipped.triangles[5][1]);
    CHECK_FALSE(surface_of(flipped).watertight);
}

TEST_CASE("a mesh of which nothing is left is refused with the number of triangles given") {
    const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 0, 1}};
    CHECK_THROWS_AS(make_surface(line, triangles), SceneError);
    CHECK_THROWS_WITH(make_surface(line, triangles), Catch::Contains("2 given"));
    CHECK_THROWS_AS(make_surface({}, {}), SceneError);
}

TEST_CASE("of a box the twelve edges can be touched, the six diagonals cannot, every vertex can") {
    const ObstacleSurface box = surface_of(make_box({1, 2, 3}));
    int touchable = 0;
    for (const SurfaceEdge& e : box.edges) {
        const Vec3 along = box.vertices[e.vertex[1]] - box.vertices[e.vertex[0]];
        const bool outline = (along.array() == 0.0).count() == 2;
        CHECK(e.can_touch == outline);
        touchable += e.can_touch ? 1 : 0;
    }
    CHECK(touchable == 12);
    CHECK(std::count(box.vertex_can_touch.begin(), box.vertex_can_touch.end(), true) == 8);
}

TEST_CASE("the valley of an L cannot be touched, its other 17 edges can") {
    const ObstacleSurface solid = surface_of(l_solid());
    const std::set<Edge> touchable = touchable_edges(solid);
    CHECK(touchable.size() == 17);
    CHECK(touchable.count({3, 9}) == 0);
    for (int i = 0; i < 6; ++i) {
        CHECK(touchable.count(std::minmax(i, (i + 1) % 6)) == 1);
        CHECK(touchable.count(std::minmax(6 + i, 6 + (i + 1) % 6)) == 1);
        CHECK(touchable.count({i, 6 + i}) == (i == 3 ? 0u : 1u));
    }
    CHECK(std::count(solid.vertex_can_touch.begin(), solid.vertex_can_touch.end(), true) == 12);
}

TEST_CASE("an open sheet can be touched at its border and its folds, both ways, not where it is flat") {
    TriangleMesh sheet = make_grid(2.0, 2.0, 3, 3);
    const ObstacleSurface flat = surface_of(sheet);
    for (int e = 0; e < int(flat.edges.size()); ++e) CHECK(flat.edges[e].can_touch == (flat.opposites(e).size() == 1));
    CHECK_FALSE(flat.vertex_can_touch[4]);
    const double lift = GENERATE(0.1, -0.1);
    sheet.vertices[4].y() = lift;
    const ObstacleSurface pyramid = surface_of(sheet);  // its four faces are pairs of triangles, its ridges the diagonals
    CHECK(pyramid.vertex_can_touch[4]);
    for (const SurfaceEdge& e : pyramid.edges) {
        const int other = e.vertex[0] == 4 ? e.vertex[1] : e.vertex[1] == 4 ? e.vertex[0] : -1;
        if (other >= 0) CHECK(e.can_touch == (other % 2 == 0));
    }
}

TEST_CASE("a closed surface turned inside out is still guarded at its edges") {
    // Which side is solid follows from the winding number, not from the normals: cloth may be where they do not point.
    const auto outline = touchable_edges(surface_of(make_box({1, 1, 1})));
    const auto turned = touchable_edges(surface_of(inside_out(make_box({1, 1, 1}))));
    CHECK(std::includes(turned.begin(), turned.end(), outline.begin(), outline.end()));

    const TriangleMesh two = joined(make_box({1, 1, 1}), moved(inside_out(l_solid()), {3, 0, 0}));
    const auto both = touchable_edges(surface_of(two));
    CHECK(both.size() == 12 + 17);  // seen from outside its valley is one still

    const TriangleMesh hollow = joined(make_box({9, 9, 9}), moved(inside_out(l_solid()), {-1, -1, -0.5}));
    CHECK(touchable_edges(surface_of(hollow)).count({8 + 3, 8 + 9}) == 1);  // a ridge, seen from the cavity
}

namespace {

/// Of 64 places on a small circle about a point of an edge, how many are free of the solid.
int free_around(const TriangleMesh& solid, const Vec3& point, const Vec3& along) {
    const std::vector<certificate::Corners> corners = certificate::corners_of(solid);
    const certificate::BoxTree tree{std::span<const certificate::Corners>(corners)};
    const Vec3 u = along.unitOrthogonal(), w = along.cross(u);
    int free = 0;
    for (int k = 0; k < 64; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / 64;
        const Vec3 x = point + 1e-7 * (std::cos(angle) * u + std::sin(angle) * w);
        free += certificate::winding_number(x, corners, tree) == 0 ? 1 : 0;
    }
    return free;
}

}  // namespace

TEST_CASE("an edge that cannot be touched has free space on at most half a turn, also where a body is inside out") {
    int valleys = 0, wrong = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        const TriangleMesh mesh = tangled_ball(0.3, 1, 0.1 + 0.01 * seed, seed);
        const ObstacleSurface surface = surface_of(mesh);
        for (const SurfaceEdge& e : surface.edges) {
            if (e.can_touch) continue;
            ++valleys;
            const Vec3 a = surface.vertices[e.vertex[0]], way = surface.vertices[e.vertex[1]] - a;
            for (const double where : {0.03, 0.4, 0.97})
                wrong += free_around(mesh, a + where * way, way.normalized()) > 32 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
    CHECK(valleys > 300);
}

TEST_CASE("a ridge next to a very narrow face can be touched") {
    const double width = GENERATE(1e-3, 1e-8, 1e-10, 1e-12);
    const ObstacleSurface prism = surface_of(narrow_ridge(width));
    INFO("width " << width);
    REQUIRE(prism.watertight);
    const std::set<Edge> touchable = touchable_edges(prism);
    CHECK(touchable.count({3, 8}) + touchable.count({2, 7}) > 0);
}

TEST_CASE("the rim of a plate without thickness can be touched, its flat inside cannot") {
    // Two sheets of opposite sense on the same square, split along different diagonals: closed.
    const TriangleMesh plate{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
                             .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
    const ObstacleSurface surface = surface_of(plate);
    CHECK(surface.watertight);
    for (int i = 0; i < 4; ++i) CHECK(touchable_edges(surface).count(std::minmax(i, (i + 1) % 4)) == 1);
    CHECK(touchable_edges(surface).size() == 4);
}

TEST_CASE("a point faces an edge or vertex only inside its normal cone") {
    const ObstacleSurface box = surface_of(make_box({2, 2, 2}));
    const auto at = [&](int v) { return box.vertices[v]; };
    const auto corner = int(std::find(box.vertices.begin(), box.vertices.end(), Vec3(1, 1, 1)) - box.vertices.begin());
    REQUIRE(corner < 8);
    CHECK(vertex_faces(box, corner, Vec3(1, 1, 1).normalized(), at));
    CHECK(vertex_faces(box, corner, Vec3(1, 0, 0), at));
    CHECK_FALSE(vertex_faces(box, corner, Vec3(1, 1, -0.1).normalized(), at));
    CHECK_FALSE(vertex_faces(box, corner, Vec3(-1, -1, -1).normalized(), at));
    for (int e = 0; e < int(box.edges.size()); ++e) {
        const Vec3 middle = 0.5 * (at(box.edges[e].vertex[0]) + at(box.edges[e].vertex[1]));
        if (!box.edges[e].can_touch) continue;
        const Vec3 outward = middle.normalized(), along = (at(box.edges[e].vertex[1]) - at(box.edges[e].vertex[0])).normalized();
        CHECK(edge_faces(box, e, middle, outward, at));
        CHECK_FALSE(edge_faces(box, e, middle, Vec3(-outward), at));
        const Vec3 across = outward.cross(along);
        CHECK(edge_faces(box, e, middle, Vec3((outward + 0.99 * across).normalized()), at));
        CHECK_FALSE(edge_faces(box, e, middle, Vec3((outward + 1.01 * across).normalized()), at));
    }
}

}  // namespace percale::test::obstacle_surface_test
