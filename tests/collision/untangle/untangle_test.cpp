#include "collision/untangle/untangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "collision/untangle/untangle_spread.h"
#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"
#include "tests/support/skip.h"

namespace percale::test::untangle_test {
namespace {

constexpr double thickness = 5e-3;

/// Cloth, obstacles and what became of it.
struct Case {
    TriangleMesh cloth;
    std::vector<TriangleMesh> obstacles;
    std::vector<int> fixed = {};
    std::optional<Untangled> out = {};
    double stretch = 0.0;

    void solve() {
        const std::vector<double> thick(cloth.vertices.size(), thickness);
        std::vector<double> free(cloth.vertices.size(), 1.0);
        for (const int v : fixed) free[v] = 0.0;
        const TangledCloth tangled = make_tangled_cloth(cloth.triangles, thick, free);
        std::vector<SolidObstacle> solids;
        for (const TriangleMesh& mesh : obstacles) solids.emplace_back(mesh);
        out = untangle(tangled, solids, cloth.vertices);
        if (out) stretch = largest_stretch(tangled, cloth.vertices, out->positions);
    }
    bool clear() const {
        TriangleMesh moved = cloth;
        moved.vertices = out->positions;
        return std::all_of(obstacles.begin(), obstacles.end(), [&](const TriangleMesh& obstacle) {
            const Certificate certificate = certify(moved, obstacle, 0.1);
            return certificate.clean() && certificate.smallest_distance > 0.0;
        });
    }
    double largest_move() const {
        double largest = 0.0;
        for (std::size_t v = 0; v < cloth.vertices.size(); ++v) {
            largest = std::max(largest, (out->positions[v] - cloth.vertices[v]).norm());
        }
        return largest;
    }
};

TriangleMesh turned(TriangleMesh mesh, double angle) {
    const Pose pose{.translation = Vec3::Zero(), .rotation = {std::cos(angle / 2), std::sin(angle / 2), 0, 0}, .scale = 1.0};
    return placed(std::move(mesh), pose);
}

TriangleMesh scaled(TriangleMesh mesh, double height) {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) * height / (high - low).y();
    return mesh;
}

}  // namespace

TEST_CASE("a sheet through the middle of a sphere leaves by one side, whole") {
    const double height = GENERATE(0.0, -0.1, 0.2);
    Case c{.cloth = moved(make_grid(1, 1, 33, 33), {0, height, 0}), .obstacles = {make_sphere(0.25, 4)}};
    c.solve();
    REQUIRE(c.out);
    CHECK(c.clear());
    CHECK(c.stretch < 0.5);
    CHECK(c.largest_move() < 0.25 - std::abs(height) + 4 * thickness);
    int up = 0, down = 0;
    for (std::size_t v = 0; v < c.cloth.vertices.size(); ++v) {
        const Vec3& x = c.cloth.vertices[v];
        if (x.norm() >= 0.249) continue;
        (c.out->positions[v].y() > x.y() ? up : down) += 1;
        CHECK(c.out->obstacle[v] == 0);
    }
    CHECK(std::min(up, down) == 0);
    CHECK(up + down > 50);
}

TEST_CASE("a tilted sheet through a body scan comes clear of it") {
    const std::string name = GENERATE("bunny00.off", "man.off");
    const auto scan = read_off(real_mesh_folder() / name);
    if (!scan) {
        skip("no " + name + " in " + real_mesh_folder().string() + " (PERCALE_REAL_MESHES)");
        return;
    }
    Case c{.cloth = turned(make_grid(1, 1, 33, 33), 0.4), .obstacles = {scaled(*scan, 0.5)}};
    c.solve();
    REQUIRE(c.out);
    CHECK(c.clear());
    CHECK(c.stretch < 0.5);
    CHECK(c.largest_move() < 0.4);
}

TEST_CASE("open obstacles: the smaller part goes through, a spike is lifted over") {
    SECTION("a sheet that stands 20 cm deep in the ground") {
        Case c{.cloth = moved(turned(make_grid(1, 1, 33, 33), std::numbers::pi / 2), {0, 0.3, 0}), .obstacles = {make_plane(2)}};
        c.solve();
        REQUIRE(c.out);
        CHECK(c.clear());
        CHECK(c.largest_move() == Approx(0.2).margin(2 * thickness));
        for (const Vec3& x : c.out->positions) CHECK(x.y() > 0.0);
    }
    SECTION("a triangle that stands through a sheet") {
        const TriangleMesh knife{.vertices = {{-0.2, -0.3, 0}, {0.2, -0.3, 0}, {0.01, 0.1, 0.01}}, .triangles = {{0, 1, 2}}};
        Case c{.cloth = make_grid(1, 1, 33, 33), .obstacles = {knife}};
        c.solve();
        REQUIRE(c.out);
        CHECK(c.clear());
        CHECK(c.stretch < 0.5);
        CHECK(c.largest_move() < 0.11);
    }
}

TEST_CASE("shallow overlap is pushed out where it is, touching cloth is lifted off, clear cloth stays") {
    SECTION("a ring of cloth inside the skin of a capsule opens") {
        TriangleMesh ring = make_cylinder(0.097, 0.2, 48);
        ring.triangles.erase(std::remove_if(ring.triangles.begin(), ring.triangles.end(),
                                            [](const Triangle& t) { return *std::max_element(t.begin(), t.end()) >= 96; }),
                             ring.triangles.end());
        ring.vertices.resize(96);
        Case c{.cloth = ring, .obstacles = {make_capsule(0.1, 1.0, 48)}};
        c.solve();
        REQUIRE(c.out);
        CHECK(c.clear());
        CHECK(c.largest_move() < 0.02);
        for (const Vec3& x : c.out->positions) CHECK(std::hypot(x.x(), x.z()) > 0.1);
    }
    SECTION("touching") {
        Case c{.cloth = make_grid(0.2, 0.2, 9, 9), .obstacles = {moved(make_box({1, 1, 1}), {0, -0.5, 0})}};
        c.solve();
        REQUIRE(c.out);
        CHECK(c.clear());
        CHECK(c.largest_move() == Approx(thickness));
    }
    SECTION("clear") {
        Case c{.cloth = moved(make_grid(0.2, 0.2, 9, 9), {0, 0.001, 0}), .obstacles = {moved(make_box({1, 1, 1}), {0, -0.5, 0})}};
        c.solve();
        REQUIRE(c.out);
        CHECK(c.largest_move() == 0.0);
        CHECK(std::all_of(c.out->obstacle.begin(), c.out->obstacle.end(), [](int obstacle) { return obstacle == -1; }));
    }
}

TEST_CASE("a skirt whose waist is too narrow is stretched about the body, though leaving it would stretch less") {
    Case skirt{.cloth = make_tube({.low = 1.1, .top = 0.5, .height = 0.3, .around = 48}), .obstacles = {make_sphere(0.9, 3)}};
    for (Vec3& x : skirt.obstacles[0].vertices) x.y() *= 8.0;
    skirt.solve();
    REQUIRE(skirt.out);
    CHECK(skirt.clear());
    CHECK(skirt.stretch > 0.5);
    CHECK(skirt.largest_move() < 0.7);
    CHECK(std::ranges::all_of(skirt.out->positions, [](const Vec3& x) { return std::hypot(x.x(), x.z()) > 0.85; }));
}

TEST_CASE("a skirt that dips into the floor is lifted out of it") {
    Case skirt{.cloth = make_tube({.low = 0.5, .top = 0.5, .height = 0.3, .around = 48}),
               .obstacles = {moved(make_box({4.0, 1.0, 4.0}), {0.0, -0.5, 0.0})}};
    skirt.solve();
    REQUIRE(skirt.out);
    CHECK(skirt.clear());
    CHECK(skirt.stretch < 0.5);
    CHECK(skirt.largest_move() < 0.4);
}

TEST_CASE("several obstacles, sharp and thin ones") {
    const TriangleMesh sheet = make_grid(1, 1, 33, 33);
    std::vector<TriangleMesh> obstacles;
    SECTION("two spheres") {
        obstacles = {moved(make_sphere(0.15, 3), {0.25, 0.05, 0}), moved(make_sphere(0.15, 3), {-0.25, -0.05, 0})};
    }
    SECTION("a plate of 2 mm") { obstacles = {turned(make_box({0.5, 0.002, 0.5}), 0.3)}; }
    SECTION("a spiky ball") { obstacles = {moved(spiky_ball(0.2, 2, 0.5, 5), {0, -0.1, 0})}; }
    Case c{.cloth = sheet, .obstacles = obstacles};
    c.solve();
    REQUIRE(c.out);
    CHECK(c.clear());
    CHECK(c.stretch < 0.5);
}

TEST_CASE("among heaps of overlapping boxes there is no exit, lone boxes are left by the hundred", "[slow]") {
    Case heap{.cloth = make_grid(1, 1, 17, 17), .obstacles = {}}, rows = heap;
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const Vec3 place(random.number(-0.5, 0.5), random.number(-0.03, 0.03), random.number(-0.5, 0.5));
        heap.obstacles.push_back(moved(make_box({0.15, 0.05, 0.15}), place));
    }
    heap.solve();
    CHECK_FALSE(heap.out);
    for (int i = 0; i < 100; ++i) {
        const Vec3 place(0.1 * (i % 10) - 0.45, i % 2 == 0 ? 0.009 : -0.009, 0.1 * (i / 10) - 0.45);
        rows.obstacles.push_back(moved(make_box({0.02, 0.02, 0.02}), place));
    }
    const auto met = [&](const TriangleMesh& box) { return !certify(rows.cloth, box, 0.1).clean(); };
    CHECK(std::all_of(rows.obstacles.begin(), rows.obstacles.end(), met));
    rows.solve();
    REQUIRE(rows.out);
    CHECK(rows.clear());
}

TEST_CASE("fixed vertices stay, the cloth between them leaves, a fixed vertex inside leaves no exit") {
    Case c{.cloth = make_grid(1, 1, 33, 33), .obstacles = {make_sphere(0.25, 4)}, .fixed = {0, 32, 32 * 33, 33 * 33 - 1}};
    c.solve();
    REQUIRE(c.out);
    CHECK(c.clear());
    CHECK(c.stretch < 0.5);
    for (const int v : c.fixed) CHECK(c.out->positions[v] == c.cloth.vertices[v]);
    c.fixed = {16 * 33 + 16};
    c.solve();
    CHECK_FALSE(c.out);
}

TEST_CASE("shallow overlap in very many places is pushed out everywhere at once") {
    Random random(31);
    Case c{.cloth = crumpled_sheet(0.8, 61, 0.002, random),
           .obstacles = {moved(make_box({1, 1, 1}), {0, -0.5, 0}), make_box({9, 1, 1})}};
    c.obstacles[1] = moved(c.obstacles[1], {0, -7, 0});
    int inside = 0;
    for (const Vec3& x : c.cloth.vertices) inside += x.y() < 0.0;
    REQUIRE(inside > 1000);
    c.solve();
    REQUIRE(c.out);
    CHECK(c.clear());
    CHECK(c.stretch < 0.5);
    CHECK(c.largest_move() < 4 * thickness);
}

TEST_CASE("the same start is untangled to the same bits") {
    Case c{.cloth = turned(make_grid(1, 1, 17, 17), 0.3), .obstacles = {spiky_ball(0.25, 2, 0.3, 3)}};
    c.solve();
    REQUIRE(c.out);
    const std::vector<Vec3> first = c.out->positions;
    c.solve();
    CHECK(c.out->positions == first);
}

}  // namespace percale::test::untangle_test
