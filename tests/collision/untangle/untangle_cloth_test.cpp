#include "collision/untangle/untangle_cloth.h"

#include <algorithm>
#include <cmath>

#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// Cloth, and what became of it.
struct Crossed {
    TriangleMesh mesh;
    std::vector<Stitch> stitches = {};
    std::vector<int> fixed = {};
    std::optional<std::vector<Vec3>> out = {};

    std::size_t crossing(const std::vector<Vec3>& x) const {
        const ClothCertificate found = certify_cloth({.vertices = x, .triangles = mesh.triangles}, stitches);
        return found.crossing.size() + found.touching.size();
    }
    void solve() {
        std::vector<double> free(mesh.vertices.size(), 1.0);
        for (const int v : fixed) free[v] = 0.0;
        out = untangle_cloth({mesh.triangles, free, stitches}, mesh.vertices);
    }
    double largest_move() const {
        double largest = 0.0;
        for (std::size_t v = 0; v < out->size(); ++v) largest = std::max(largest, ((*out)[v] - mesh.vertices[v]).norm());
        return largest;
    }
    double largest_stretch() const {
        double largest = 0.0;
        for (const Triangle& t : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const int a = t[k], b = t[(k + 1) % 3];
                const double before = (mesh.vertices[b] - mesh.vertices[a]).norm();
                largest = std::max(largest, std::abs(((*out)[b] - (*out)[a]).norm() - before) / before);
            }
        }
        return largest;
    }
};

/// The upper of two sheets pokes through the lower one in several places, by up to 5 mm.
TriangleMesh interleaved() {
    TriangleMesh upper = make_grid(1, 1, 37, 37);
    for (Vec3& x : upper.vertices) x.y() = 0.0005 + 0.005 * std::sin(9.0 * x.x()) * std::cos(7.0 * x.z());
    return joined(make_grid(1, 1, 41, 41), upper);
}

}  // namespace

TEST_CASE("two sheets interleaved by 5 mm come apart, stretched by little") {
    Crossed cloth{.mesh = interleaved()};
    REQUIRE(cloth.crossing(cloth.mesh.vertices) > 500);
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(cloth.crossing(*cloth.out) == 0);
    CHECK(cloth.largest_move() < 0.015);
    CHECK(cloth.largest_stretch() < 0.1);
}

TEST_CASE("the smaller side goes back: a corner that pokes through a sheet, not the sheet over the corner") {
    TriangleMesh flag = make_grid(0.4, 0.4, 11, 11);
    // Upright, turned onto its corner, which is 3 cm below the sheet.
    for (Vec3& x : flag.vertices) x = Vec3((x.x() - x.z()) / std::sqrt(2.0), (x.x() + x.z()) / std::sqrt(2.0) + 0.2528427, 0.01);
    Crossed cloth{.mesh = joined(make_grid(1, 1, 23, 23), flag)};
    REQUIRE(cloth.crossing(cloth.mesh.vertices) > 0);
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(cloth.crossing(*cloth.out) == 0);
    for (std::size_t v = 23 * 23; v < cloth.out->size(); ++v) CHECK((*cloth.out)[v].y() > -0.02);
}

TEST_CASE("cloth that crosses nothing stays, and what is sewn to each other gets one place") {
    Crossed cloth{.mesh = joined(make_grid(1, 1, 5, 5), moved(make_grid(1, 1, 5, 5), {0, 0.01, 0}))};
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(*cloth.out == cloth.mesh.vertices);
    cloth.stitches = {{0, 25, 25, 0.0}};
    cloth.fixed = {25};
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK((*cloth.out)[0] == cloth.mesh.vertices[25]);
    CHECK((*cloth.out)[25] == cloth.mesh.vertices[25]);
}

TEST_CASE("cloth that nothing may move is given up") {
    Crossed cloth{.mesh = interleaved()};
    for (int v = 0; v < static_cast<int>(cloth.mesh.vertices.size()); ++v) cloth.fixed.push_back(v);
    cloth.solve();
    CHECK_FALSE(cloth.out);
}
