#include "certificate/inside_test.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "percale/mesh.h"
#include "tests/support/catch.h"

namespace percale::test::inside_test_test {
using namespace percale::certificate;

namespace {

const double pi = std::acos(-1.0);

TriangleMesh torus(double ring, double tube, int around, int across) {
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = ring + tube * std::cos(v);
            mesh.vertices.push_back({r * std::cos(u), tube * std::sin(v), r * std::sin(u)});
            const int right = (i + 1) % around, up = (j + 1) % across;
            const int a = i * across + j, b = right * across + j, c = right * across + up, d = i * across + up;
            mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
        }
    }
    return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh mesh = a;
    const int offset = static_cast<int>(a.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const Triangle& t : b.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.vertices) x += by;
    return mesh;
}

/// Every triangle with corners of its own, as in an STL file.
TriangleMesh unwelded(const TriangleMesh& mesh) {
    TriangleMesh result;
    for (const Triangle& t : mesh.triangles) {
        const int first = static_cast<int>(result.vertices.size());
        for (const int v : t) result.vertices.push_back(mesh.vertices[v]);
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

/// Sum of the signed solid angles (van Oosterom and Strackee 1983) over 4 pi, rounded.
int winding_by_solid_angles(const Vec3& p, const TriangleMesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return static_cast<int>(std::lround(sum / (4 * pi)));
}

struct Solid {
    TriangleMesh mesh;
    std::vector<Corners> triangles;
    BoxTree tree;

    explicit Solid(TriangleMesh given) : mesh(std::move(given)), triangles(corners_of(mesh)), tree(triangles) {}
    int winding(const Vec3& p) const { return winding_number(p, triangles, tree); }
    Side side(const Vec3& p) const { return side_of(p, triangles, tree); }
};

void check_against_solid_angles(const Solid& solid, double size) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> number(-size, size);
    int wound = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 p{number(random), number(random), number(random)};
        const int expected = winding_by_solid_angles(p, solid.mesh);
        wound += expected != 0;
        if (solid.winding(p) != expected) FAIL("trial " << trial << ": " << solid.winding(p) << " against " << expected);
    }
    CHECK(wound > 15);
}

}  // namespace

TEST_CASE("closed meshes are watertight, with vertices of their own for every triangle too") {
    CHECK(is_watertight(make_sphere(0.3, 3)));
    CHECK(is_watertight(make_box({1, 2, 3})));
    CHECK(is_watertight(inside_out(make_sphere(1.0, 2))));
    CHECK(is_watertight(torus(1.0, 0.3, 20, 12)));
    CHECK(is_watertight(unwelded(make_sphere(0.3, 2))));
    CHECK(is_watertight(joined(make_sphere(1, 1), moved(make_sphere(1, 1), {0.5, 0, 0}))));
}

TEST_CASE("a mesh with a hole, a flipped triangle, a fin or none at all is not watertight") {
    TriangleMesh sphere = make_sphere(1.0, 2);
    CHECK_FALSE(is_watertight(make_grid(1, 1, 5, 5)));
    CHECK_FALSE(is_watertight(TriangleMesh{}));

    TriangleMesh hole = sphere, flipped = sphere, fin = sphere, twice = sphere;
    hole.triangles.pop_back();
    std::swap(flipped.triangles[7][0], flipped.triangles[7][1]);
    fin.vertices.push_back({2, 0, 0});
    fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], static_cast<int>(fin.vertices.size()) - 1});
    twice.triangles.insert(twice.triangles.end(), sphere.triangles.begin(), sphere.triangles.end());
    CHECK_FALSE(is_watertight(hole));
    CHECK_FALSE(is_watertight(flipped));
    CHECK_FALSE(is_watertight(fin));
    CHECK_FALSE(is_watertight(twice));
}

TEST_CASE("triangles without area neither open nor close a mesh") {
    TriangleMesh box = make_box({1, 1, 1});
    const Triangle t = box.triangles[0];
    TriangleMesh folded = box;  // a triangle that lost a corner
    folded.triangles.push_back({t[0], t[0], t[1]});
    CHECK(is_watertight(folded));

    TriangleMesh split = box;  // one edge split on one side only, the gap closed by a sliver
    split.vertices.push_back(0.5 * (box.vertices[t[0]] + box.vertices[t[1]]));
    const int middle = static_cast<int>(split.vertices.size()) - 1;
    split.triangles[0] = {t[0], middle, t[2]};
    split.triangles.push_back({middle, t[1], t[2]});
    CHECK_FALSE(is_watertight(split));
    split.triangles.push_back({t[0], t[1], middle});
    CHECK(is_watertight(split));

    TriangleMesh fin = box;  // a sliver that hangs on an edge
    fin.vertices.push_back(split.vertices.back());
    fin.triangles.push_back({t[0], t[1], middle});
    CHECK(is_watertight(fin));
    for (const TriangleMesh* mesh : {&folded, &split, &fin}) {
        CHECK(Solid(*mesh).winding({0.1, 0.2, 0.3}) == 1);
        CHECK(Solid(*mesh).winding({0.1, 0.2, 0.6}) == 0);
    }
}

TEST_CASE("the winding number is the sum of solid angles on sphere, torus, overlapping, hollow and inverted bodies") {
    check_against_solid_angles(Solid(make_sphere(1.0, 2)), 1.2);
    check_against_solid_angles(Solid(torus(1.0, 0.4, 17, 11)), 1.4);
    check_against_solid_angles(Solid(joined(make_sphere(1.0, 2), moved(make_sphere(1.0, 2), {0.7, 0.1, 0}))), 1.5);
    check_against_solid_angles(Solid(joined(make_sphere(1.0, 2), inside_out(make_sphere(0.6, 2)))), 1.2);
    check_against_solid_angles(Solid(inside_out(make_sphere(1.0, 2))), 1.2);
}

TEST_CASE("inside, outside and on the surface are distinguished at corners, edges, faces and their extensions") {
    const Solid box(make_box({2, 2, 2}));
    for (int code = 0; code < 5 * 5 * 5; ++code) {
        const Vec3 p{code % 5 - 2.0, code / 5 % 5 - 2.0, code / 25 - 2.0};
        const double reach = p.cwiseAbs().maxCoeff();
        const Side expected = reach < 1.0 ? Side::inside : reach > 1.0 ? Side::outside : Side::on_surface;
        CHECK(box.side(p) == expected);
        if (expected == Side::on_surface) {
            CHECK(box.side(p * (1 - 1e-15)) == Side::inside);
            CHECK(box.side(p * (1 + 1e-15)) == Side::outside);
        }
    }
}

TEST_CASE("rays through vertices and along edges of a body count right") {
    const Solid ball(make_sphere(1.0, 2));
    for (const Vec3& v : ball.mesh.vertices) {
        if (ball.side(v) != Side::on_surface) FAIL("a vertex is not on the surface");
        const Vec3 before = v - Vec3{3, 0, 0}, after = v + Vec3{3, 0, 0};
        if (ball.winding(before) != 0 || ball.winding(after) != 0) FAIL("outside on the line of a vertex");
        const Vec3 middle{0, v.y(), v.z()};
        if (std::abs(v.x()) > 0.5 && ball.side(middle) != Side::inside) FAIL("inside on the line of a vertex");
    }
    const Solid ring(torus(1.0, 0.4, 16, 8));  // symmetric: edges lie in the plane y = 0
    CHECK(ring.side({-2, 0, 0}) == Side::outside);
    CHECK(ring.side({0, 0, 0}) == Side::outside);
    CHECK(ring.side({1, 0, 0}) == Side::inside);
    CHECK(ring.side({-1, 0, 0}) == Side::inside);
}

TEST_CASE("side does not depend on how corners are numbered or triangles ordered") {
    TriangleMesh mesh = torus(1.0, 0.4, 12, 9);
    const Solid plain(mesh);
    std::mt19937 random(3);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Triangle& t = mesh.triangles[i];
        std::rotate(t.begin(), t.begin() + i % 3, t.end());
    }
    const Solid shuffled(mesh);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p{(i % 10 - 5) * 0.25, (i / 10 % 10 - 5) * 0.1, (i / 100 - 5) * 0.25};
        if (plain.side(p) != shuffled.side(p)) FAIL("point " << i);
    }
    SUCCEED();
}

}  // namespace percale::test::inside_test_test
