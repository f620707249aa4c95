#include "scenes/garment/vertex_selection.h"

#include <numbers>
#include <set>

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::vertex_selection_test {
namespace {

std::vector<int> selected(const VertexSelection& selection, const TriangleMesh& mesh) {
    return select_vertices(selection, mesh, "flag");
}

std::string fault(const VertexSelection& selection, const TriangleMesh& mesh) {
    return error_of([&] { selected(selection, mesh); });
}

}  // namespace

TEST_CASE("indices come out ascending and once") {
    CHECK(selected(VertexIndices{{7, 0, 7, 3}}, make_grid(1, 1, 5, 4)) == std::vector<int>{0, 3, 7});
    CHECK(selected(VertexIndices{}, make_grid(1, 1, 5, 4)).empty());
}

TEST_CASE("an index out of range is reported with the cloth and the allowed range") {
    CHECK(fault(VertexIndices{{20}}, make_grid(1, 1, 5, 4)) ==
          "vertices of cloth 'flag': vertex 20 is out of range; allowed: 0 ... 19");
    CHECK(fault(VertexIndices{{-1}}, make_grid(1, 1, 5, 4)).find("vertex -1 is out of range") != std::string::npos);
    CHECK(selected(VertexIndices{{19}}, make_grid(1, 1, 5, 4)) == std::vector<int>{19});
    CHECK(fault(VertexIndices{{20, 3, -1}}, make_grid(1, 1, 5, 4)).find("vertices 20, -1 are out of range") != std::string::npos);
    CHECK(fault(VertexIndices{{20, 21, 22, 23, 24, 25, 26, 27, 28, 29}}, make_grid(1, 1, 5, 4))
              .find("27 and 2 more are out of range") != std::string::npos);
}

TEST_CASE("a box of half the width holds half the columns, the middle one included") {
    const TriangleMesh grid = make_grid(2.0, 1.0, 5, 4);
    const std::vector<int> left = selected(VertexBox{Vec3(0, 0, 0), Vec3(0.5, 1, 1)}, grid);
    std::vector<int> expected;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column <= 2; ++column) expected.push_back(row * 5 + column);
    CHECK(left == expected);
}

TEST_CASE("fractions at a row of vertices include it in spite of rounding") {
    for (const int columns : {4, 7, 11, 34}) {
        const TriangleMesh grid = make_grid(0.3, 0.7, columns, 3);
        for (int c = 0; c < columns; ++c) {
            const double fraction = static_cast<double>(c) / (columns - 1);
            CAPTURE(columns, c);
            REQUIRE(selected(VertexBox{Vec3(fraction, 0, 0), Vec3(fraction, 1, 1)}, grid) ==
                    std::vector<int>{c, columns + c, 2 * columns + c});
        }
    }
}

TEST_CASE("a direction in which the cloth is flat excludes nothing") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    CHECK(selected(VertexBox{Vec3(0, 0.4, 0), Vec3(0, 0.6, 0)}, grid) == std::vector<int>{0});
    TriangleMesh tilted = grid;
    const double half = 0.25 * std::numbers::pi;
    const Pose pose{.translation = Vec3(0.1, 3.0, -7.0), .rotation = {std::cos(half), std::sin(half), 0.0, 0.0}};
    tilted.vertices = transform(pose, grid.vertices);
    CHECK(selected(VertexBox{Vec3(0, 0, 0.4), Vec3(0, 0, 0.6)}, tilted).size() == 1);
}

TEST_CASE("a box is in fractions whatever the size and place of the cloth") {
    TriangleMesh grid = make_grid(1.0, 1.0, 9, 9);
    const VertexBox box{Vec3(0.2, 0, 0.6), Vec3(0.9, 1, 1.5)};
    const std::vector<int> before = selected(box, grid);
    grid.vertices = transform(Pose{.translation = Vec3(5, -3, 2), .rotation = {}, .scale = 0.01}, grid.vertices);
    CHECK(selected(box, grid) == before);
    CHECK(before.size() == 24);
}

TEST_CASE("a box without a vertex is an error") {
    CHECK(fault(VertexBox{Vec3(0.3, 0, 0.3), Vec3(0.4, 1, 0.4)}, make_grid(1, 1, 3, 3))
              .starts_with("vertices of cloth 'flag': no vertex lies in the box"));
}

TEST_CASE("the boundary of a grid is its rim") {
    const std::vector<int> rim = selected(VertexBoundary{}, make_grid(1, 1, 5, 4));
    std::set<int> expected;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 5; ++column)
            if (row == 0 || row == 3 || column == 0 || column == 4) expected.insert(row * 5 + column);
    CHECK(std::set<int>(rim.begin(), rim.end()) == expected);
    CHECK(std::is_sorted(rim.begin(), rim.end()));
    CHECK(rim.size() == expected.size());
}

TEST_CASE("a closed mesh has no boundary to pin") {
    CHECK(fault(VertexBoundary{}, make_sphere(1.0, 1)) == "vertices of cloth 'flag': the mesh is closed and has no boundary");
}

}  // namespace percale::scenes::test::vertex_selection_test
