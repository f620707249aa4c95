#include "collision/untangle/untangle_cloth.h"

#include <algorithm>
#include <cmath>

#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::untangle_cloth_test {
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

TEST_CASE("two sheets interleaved by 5 mm come apart, stretched by little", "[slow]") {
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

TEST_CASE("cloth that crosses nothing stays, sewn or not") {
    Crossed cloth{.mesh = joined(make_grid(1, 1, 5, 5), moved(make_grid(1, 1, 5, 5), {0, 0.01, 0}))};
    if (GENERATE(false, true)) cloth.stitches = {{0, 25, 25, 0.0}, {7, 31, 32, 0.3}};
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(*cloth.out == cloth.mesh.vertices);
}

TEST_CASE("a seam that is still open elsewhere is not drawn together", "[slow]") {
    Crossed cloth{.mesh = joined(interleaved(), moved(make_grid(1, 1, 11, 11), {1.3, 0, 0}))};
    const int apart = 41 * 41 + 37 * 37;
    for (int k = 0; k < 11; ++k) cloth.stitches.push_back({41 * 4 * k + 40, apart + 11 * k, apart + 11 * k, 0.0});
    cloth.stitches.push_back({apart + 5, 20, 21, 0.4});
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(cloth.crossing(*cloth.out) == 0);
    for (std::size_t v = apart; v < cloth.out->size(); ++v) CHECK(((*cloth.out)[v] - cloth.mesh.vertices[v]).norm() < 0.003);
}

TEST_CASE("a point of an edge that a vertex is sewn to goes where the vertex goes") {
    // A flap hangs with its upper rim on a sheet, and its lower rim goes back up through it.
    TriangleMesh flap = make_grid(0.4, 0.1, 9, 5);
    for (Vec3& x : flap.vertices) {
        const double along = x.z() + 0.05;  // from the seam
        x = Vec3(x.x() + 0.011, along < 0.05 ? -along : along - 0.08, along < 0.05 ? 0.013 : 0.02);
    }
    Crossed cloth{.mesh = joined(make_grid(1, 1, 21, 21), flap)};
    for (int k = 0; k < 9; ++k) {
        const double place = (cloth.mesh.vertices[441 + k].x() + 0.5) / 0.05;
        const int from = 21 * 10 + static_cast<int>(place);
        cloth.stitches.push_back({441 + k, from, from + 1, place - std::floor(place)});
    }
    REQUIRE(cloth.crossing(cloth.mesh.vertices) > 0);
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(cloth.crossing(*cloth.out) == 0);
    for (const auto& [vertex, from, to, share] : cloth.stitches) {
        const Vec3 gap = (*cloth.out)[vertex] - (1.0 - share) * (*cloth.out)[from] - share * (*cloth.out)[to];
        CHECK(gap.norm() < 0.016);  // 0.013 as it starts
    }
}

TEST_CASE("corners that are sewn on all sides do not keep cloth from coming apart") {
    // A bag of two sheets sewn all around; elsewhere a third sheet pokes through the lower one.
    Crossed cloth{.mesh = joined(make_grid(1, 1, 11, 11), moved(make_grid(1, 1, 11, 11), {0, 0.02, 0}))};
    for (int k = 0; k < 121; ++k) {
        const int row = k / 11, column = k % 11;
        if (row == 0 || row == 10 || column == 0 || column == 10) cloth.stitches.push_back({k, 121 + k, 121 + k, 0.0});
    }
    TriangleMesh patch = make_grid(0.5, 0.5, 17, 17);
    for (Vec3& x : patch.vertices) x.y() = -0.004 + 0.006 * std::cos(9.0 * x.x()) * std::cos(7.0 * x.z());
    cloth.mesh = joined(cloth.mesh, patch);
    REQUIRE(cloth.crossing(cloth.mesh.vertices) > 0);
    cloth.solve();
    REQUIRE(cloth.out);
    CHECK(cloth.crossing(*cloth.out) == 0);
}

TEST_CASE("cloth that nothing may move is given up", "[slow]") {
    Crossed cloth{.mesh = interleaved()};
    for (int v = 0; v < static_cast<int>(cloth.mesh.vertices.size()); ++v) cloth.fixed.push_back(v);
    cloth.solve();
    CHECK_FALSE(cloth.out);
}

TEST_CASE("of sheets interleaved at random the order of layers decides which lies on which, of three as of two") {
    const int sheets = GENERATE(2, 3);
    CAPTURE(sheets);
    TriangleMesh mesh;
    std::vector<int> cloth;
    std::vector<std::size_t> first;
    ClothPairs pairs;
    for (int k = 0; k < sheets; ++k) {
        first.push_back(mesh.vertices.size());
        TriangleMesh sheet = make_grid(1, 1, 37 - 2 * k, 37 - 2 * k);
        for (Vec3& x : sheet.vertices) x.y() = 0.004 * std::sin((9.0 + k) * x.x() + k) * std::cos((7.0 - k) * x.z()) - 0.001 * k;
        mesh = joined(mesh, sheet);
        cloth.resize(mesh.triangles.size(), k);
        pairs.set_layer(k, sheets - k);  // the last one lowest
    }
    const std::vector<double> free(mesh.vertices.size(), 1.0);
    const MeetingCloth meeting{cloth, &pairs};
    REQUIRE(certify_cloth(mesh, {}, meeting).crossing.size() > 300);
    const auto out = untangle_cloth({mesh.triangles, free, {}, meeting}, mesh.vertices);
    REQUIRE(out);
    const ClothCertificate found = certify_cloth({.vertices = *out, .triangles = mesh.triangles}, {}, meeting);
    CHECK(found.crossing.size() + found.touching.size() == 0);
    // In the middle each is above the next.
    std::vector<double> height;
    for (int k = 0; k < sheets; ++k) {
        const auto count = static_cast<std::size_t>((37 - 2 * k) * (37 - 2 * k));
        double sum = 0.0;
        for (std::size_t v = first[k]; v < first[k] + count; ++v) {
            CHECK(((*out)[v] - mesh.vertices[v]).norm() < 0.02);
            sum += (*out)[v].y();
        }
        height.push_back(sum / static_cast<double>(count));
    }
    for (int k = 1; k < sheets; ++k) CHECK(height[k - 1] > height[k] + 0.0005);
}

}  // namespace percale::test::untangle_cloth_test
