#include "collision/untangle/edge_crossings.h"

#include <cmath>
#include <map>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::edge_crossings_test {
namespace {

/// A bumpy sheet through a flat one of other triangles. The bumps' vertices come first.
struct TwoSheets {
    TriangleMesh mesh;
    int first_of_flat = 0;
    ClothSurface surface;

    TwoSheets() {
        TriangleMesh bumpy = make_grid(1, 1, 14, 14);
        for (Vec3& x : bumpy.vertices) x.y() = 0.05 * std::sin(7.0 * x.x() + 0.3) * std::cos(6.0 * x.z()) + 0.013;
        first_of_flat = static_cast<int>(bumpy.vertices.size());
        mesh = joined(bumpy, moved(make_grid(1.3, 1.2, 11, 12), {0.011, 0, 0.017}));
        surface = make_cloth_surface(mesh.triangles, mesh.vertices.size());
    }
    std::vector<Vec3> with_bumps_moved(const Vec3& by) const {
        std::vector<Vec3> x = mesh.vertices;
        for (int v = 0; v < first_of_flat; ++v) x[v] += by;
        return x;
    }
    std::vector<EdgeCrossing> crossings(const std::vector<Vec3>& x) const {
        return edge_crossings(surface, certify_cloth({.vertices = x, .triangles = mesh.triangles}, {}).crossing, x);
    }
    /// m, of the curve in which they cross: each pair of triangles has a straight piece of it between two edges that pierce.
    double curve_length(const std::vector<Vec3>& x) const {
        std::map<std::array<int, 2>, std::vector<Vec3>> ends;
        for (const EdgeCrossing& crossing : crossings(x)) {
            const auto& [a, b] = crossing.edge;
            const Vec3 point = x[a] + crossing.share * (x[b] - x[a]);
            const int triangle = number_of(crossing.triangle);
            for (const int beside : surface.edges[surface.edge_between(a, b)].triangle) {
                if (beside >= 0) ends[{std::min(beside, triangle), std::max(beside, triangle)}].push_back(point);
            }
        }
        double length = 0.0;
        for (const auto& [pair, points] : ends) {
            if (points.size() == 2) length += (points[1] - points[0]).norm();
        }
        return length;
    }
    int number_of(const Triangle& triangle) const {
        return static_cast<int>(std::find(mesh.triangles.begin(), mesh.triangles.end(), triangle) - mesh.triangles.begin());
    }
};

}  // namespace

TEST_CASE("the retreat vectors are the steepest descent of the length of the curve in which cloth crosses") {
    const TwoSheets sheets;
    Vec3 descent = Vec3::Zero();
    for (const EdgeCrossing& crossing : sheets.crossings(sheets.mesh.vertices)) {
        descent += (crossing.edge[0] < sheets.first_of_flat ? 1.0 : -1.0) * crossing.retreat;
    }
    const double h = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        const double slope =
            (sheets.curve_length(sheets.with_bumps_moved(step)) - sheets.curve_length(sheets.with_bumps_moved(-step))) / (2 * h);
        CAPTURE(axis, slope, descent[axis]);
        CHECK(std::abs(slope + 0.5 * descent[axis]) < 1e-5 * descent.norm());
    }
    CHECK(descent.norm() > 1.0);
}

TEST_CASE("a crossing is the point that edge and triangle share") {
    const TwoSheets sheets;
    const auto& x = sheets.mesh.vertices;
    const std::vector<EdgeCrossing> crossings = sheets.crossings(x);
    REQUIRE(crossings.size() > 50);
    for (const EdgeCrossing& crossing : crossings) {
        const Vec3 on_edge = (1.0 - crossing.share) * x[crossing.edge[0]] + crossing.share * x[crossing.edge[1]];
        Vec3 on_triangle = Vec3::Zero();
        for (int k = 0; k < 3; ++k) on_triangle += crossing.weight[k] * x[crossing.triangle[k]];
        REQUIRE((on_edge - on_triangle).norm() < 1e-14);
    }
}

TEST_CASE("the edge of a boundary that pokes through is drawn back") {
    // The tip of a triangle, 0.2 below a large one.
    TriangleMesh mesh{.vertices = {{-3, 0, -3}, {3, 0, -3}, {0, 0, 4}, {-1, 1, 0}, {1, 1, 0}, {0, -0.2, 0}},
                      .triangles = {{0, 1, 2}, {3, 4, 5}}};
    const ClothSurface surface = make_cloth_surface(mesh.triangles, mesh.vertices.size());
    const std::vector<EdgeCrossing> crossings = edge_crossings(surface, {{{0, 1}}}, mesh.vertices);
    REQUIRE(crossings.size() == 2);
    Vec3 sum = Vec3::Zero();
    for (const EdgeCrossing& crossing : crossings) sum += crossing.retreat;
    CHECK(sum.y() > 1.0);
    CHECK(std::abs(sum.x()) + std::abs(sum.z()) < 1e-12);
}

}  // namespace percale::test::edge_crossings_test
