#include "collision/untangle/untangle_check.h"

#include <algorithm>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::untangle_check_test {
namespace {

struct Sheet {
    TriangleMesh mesh;
    std::vector<double> thickness, free;
    TangledCloth cloth;

    explicit Sheet(TriangleMesh given)
        : mesh(std::move(given)),
          thickness(mesh.vertices.size(), 0.01),
          free(mesh.vertices.size(), 1.0),
          cloth(make_tangled_cloth(mesh.triangles, thickness, free)) {}
};

int count(const std::vector<int>& obstacle, int which) {
    return static_cast<int>(std::count(obstacle.begin(), obstacle.end(), which));
}

TriangleMesh upright(TriangleMesh mesh) {
    for (Vec3& x : mesh.vertices) x = {x.x(), x.z(), 0.0};
    return mesh;
}

}  // namespace

TEST_CASE("neighbours are the other ends of edges, each once") {
    const Sheet sheet(make_grid(1, 1, 3, 3));
    CHECK(sheet.cloth.neighbours[4].size() == 8);
    CHECK(std::is_sorted(sheet.cloth.neighbours[4].begin(), sheet.cloth.neighbours[4].end()));
    CHECK(sheet.cloth.neighbours[0] == std::vector<int>{1, 3, 4});
}

TEST_CASE("inside vertices are in conflict, and pierced triangles without a corner inside") {
    const Sheet sheet(make_grid(1, 1, 11, 11));
    const std::vector<SolidObstacle> ball{SolidObstacle(make_sphere(0.25, 3))};
    const std::vector<int> inside = find_conflicts(sheet.cloth, ball, sheet.mesh.vertices, {});
    int expected = 0;
    for (const Vec3& x : sheet.mesh.vertices) expected += x.norm() < 0.245;
    CHECK(count(inside, 0) == expected);
    // A needle through the face of one triangle.
    const TriangleMesh needle{.vertices = {{0.061, -0.1, 0.02}, {0.063, -0.1, 0.02}, {0.062, 0.1, 0.021}},
                              .triangles = {{0, 1, 2}}};
    const std::vector<SolidObstacle> both{SolidObstacle(moved(make_box({1, 1, 1}), {9, 0, 0})), SolidObstacle(needle)};
    const std::vector<int> pierced = find_conflicts(sheet.cloth, both, sheet.mesh.vertices, {});
    CHECK(count(pierced, 1) == 3);
    CHECK(count(pierced, 0) == 0);
}

TEST_CASE("what was moved has to keep a gap, what was not may be as near as it was") {
    const Sheet sheet(moved(make_grid(1, 1, 5, 5), {0, 0.001, 0}));
    const std::vector<SolidObstacle> plane{SolidObstacle(make_plane(2))};
    CHECK(count(find_conflicts(sheet.cloth, plane, sheet.mesh.vertices, {}), 0) == 0);
    std::vector<bool> moved_vertices(25, false);
    moved_vertices[0] = true;
    CHECK(count(find_conflicts(sheet.cloth, plane, sheet.mesh.vertices, moved_vertices), 0) > 2);
    const TriangleMesh higher = moved(sheet.mesh, {0, 0.002, 0});
    CHECK(count(find_conflicts(sheet.cloth, plane, higher.vertices, moved_vertices), 0) == 0);
}

TEST_CASE("of cloth cut by an open obstacle the smaller part is behind") {
    const Sheet sheet(moved(upright(make_grid(1, 1, 11, 11)), {0, 0.23, 0}));
    const std::vector<SolidObstacle> plane{SolidObstacle(make_plane(2))};
    const std::vector<int> behind = find_behind(sheet.cloth, plane, sheet.mesh.vertices);
    for (std::size_t v = 0; v < behind.size(); ++v) CHECK(behind[v] == (sheet.mesh.vertices[v].y() < 0.0 ? 0 : -1));
    CHECK(count(behind, 0) == 33);
    // A plate that ends within the cloth cuts nothing off; a closed obstacle has no behind.
    const std::vector<SolidObstacle> others{SolidObstacle(make_plane(0.2)), SolidObstacle(make_sphere(0.2, 2))};
    CHECK(count(find_behind(sheet.cloth, others, sheet.mesh.vertices), -1) == 121);
}

}  // namespace percale::test::untangle_check_test
