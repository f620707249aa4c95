#include "collision/self/sewn_rest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::sewn_rest_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two sheets of 5 x 5, 0.25 m from vertex to vertex, the second far off: column 4 of the first along column 0 of the second.
struct Sheets {
    TriangleMesh mesh = joined(make_grid(1, 1, 5, 5), placed(make_grid(1, 1, 5, 5), {.translation = {7, 0, 0}}));
    ClothSurface surface = make_cloth_surface(mesh.triangles, mesh.vertices.size());

    SewnRest sewn(const std::vector<Stitch>& stitches, double reach = 10.0) const {
        return {surface, stitches, mesh.vertices, reach};
    }
    static std::vector<Stitch> side() {
        std::vector<Stitch> stitches;
        for (int row = 0; row < 5; ++row) stitches.push_back({5 * row + 4, 25 + 5 * row, 25 + 5 * row});
        return stitches;
    }
};

double between(const SewnRest& sewn, const std::vector<int>& first, const std::vector<int>& second) {
    return sewn.distance(first, second);
}

}  // namespace

TEST_CASE("features that share a stitched vertex have distance 0, others that of the path through the nearest stitch") {
    const Sheets sheets;
    const SewnRest sewn = sheets.sewn(Sheets::side());
    CHECK(between(sewn, {4}, {25, 26, 31}) == 0.0);
    CHECK(between(sewn, {3, 4}, {25, 30}) == 0.0);
    CHECK(between(sewn, {3}, {25, 26, 31}) == Approx(0.25));
    CHECK(between(sewn, {3}, {26}) == Approx(0.5));
    CHECK(between(sewn, {26}, {3}) == Approx(0.5));
    CHECK(between(sewn, {2}, {27, 28}) == Approx(1.0));
    // Along the seam and on one side of it.
    CHECK(between(sewn, {4}, {30}) == Approx(0.25));
    CHECK(between(sewn, {3}, {8}) == Approx(0.25 + std::sqrt(0.125)));
}

TEST_CASE("a point of an edge is at every feature that holds the edge, and as far from its ends as its share gives") {
    const Sheets sheets;
    const SewnRest sewn = sheets.sewn({{4, 25, 30, 0.2}});
    CHECK(between(sewn, {4}, {25, 30, 31}) == 0.0);
    CHECK(between(sewn, {3, 4}, {30, 25}) == 0.0);
    CHECK(between(sewn, {4}, {25, 26}) == Approx(0.05));
    CHECK(between(sewn, {4}, {30, 31}) == Approx(0.2));
    CHECK(between(sewn, {3}, {25, 26}) == Approx(0.3));
    // However long the edge is.
    const SewnRest near = sheets.sewn({{4, 25, 30, 0.5}}, 0.05);
    CHECK(between(near, {4}, {25, 30, 31}) == 0.0);
    CHECK(between(near, {25, 30}, {3, 4}) == 0.0);
    CHECK(between(near, {4}, {31}) == infinity);
}

TEST_CASE("an end of an edge overlaps what is at a point of the edge, and nothing else") {
    const Sheets sheets;
    // Vertex 30 lies on the edge between 4 and 9 of the other sheet.
    const SewnRest sewn = sheets.sewn({{4, 25, 30, 0.2}, {9, 30, 35, 0.2}});
    const auto overlap = [&](const std::vector<int>& first, const std::vector<int>& second) {
        return sewn.overlap(first, second);
    };
    CHECK(overlap({30}, {3, 4, 9}));
    CHECK(overlap({30}, {3, 4}));
    CHECK(overlap({31, 30}, {9, 14}));
    CHECK(overlap({26, 30}, {3, 8, 9}));
    CHECK(overlap({3, 8, 9}, {26, 30}));
    // Ends of one edge do not overlap for it, nor what is not at the stitch.
    CHECK_FALSE(overlap({30}, {25, 26}));
    CHECK_FALSE(overlap({30}, {35, 36}));
    CHECK_FALSE(overlap({30}, {3, 8}));
    CHECK_FALSE(overlap({31}, {4, 9}));
    CHECK_FALSE(overlap({40}, {4, 9}));
    // Of several points the nearest counts, in either direction of the edge; a vertex merged with an end is that end.
    const SewnRest several = sheets.sewn({{4, 25, 30, 0.2}, {9, 30, 25, 0.4}, {14, 25, 30, 0.9}, {40, 30, 30}});
    CHECK(several.overlap(std::vector{25}, std::vector{3, 4}));
    CHECK_FALSE(several.overlap(std::vector{25}, std::vector{8, 9}));
    CHECK_FALSE(several.overlap(std::vector{25}, std::vector{13, 14}));
    CHECK(several.overlap(std::vector{30}, std::vector{13, 14}));
    CHECK_FALSE(several.overlap(std::vector{30}, std::vector{8, 9}));
    CHECK(several.overlap(std::vector{40, 41}, std::vector{13, 14}));
    // Vertices sewn to vertices have no such ends.
    CHECK_FALSE(sheets.sewn(Sheets::side()).overlap(std::vector{30}, std::vector{4, 9}));
    CHECK_FALSE(sheets.sewn({}).overlap(std::vector{30}, std::vector{4, 9}));
}

TEST_CASE("vertices sewn to each other by several stitches are one") {
    const Sheets sheets;
    const SewnRest sewn = sheets.sewn({{0, 24, 24}, {24, 30, 30}, {45, 30, 30}});
    CHECK(between(sewn, {0, 1}, {45, 46}) == 0.0);
    CHECK(between(sewn, {1}, {46}) == Approx(0.5));
}

TEST_CASE("a path may lead through several seams, and none is longer than the reach") {
    const Sheets sheets;
    const std::vector<Stitch> stitches = {{4, 25, 25}, {26, 45, 45}};
    CHECK(between(sheets.sewn(stitches), {3}, {46}) == Approx(0.75));
    const SewnRest near = sheets.sewn(stitches, 0.3);
    CHECK(between(near, {3}, {25}) == Approx(0.25));
    CHECK(between(near, {2}, {25}) == infinity);
    CHECK(between(near, {0}, {49}) == infinity);
    CHECK(between(sheets.sewn({}), {4}, {25}) == infinity);
}

}  // namespace percale::test::sewn_rest_test
