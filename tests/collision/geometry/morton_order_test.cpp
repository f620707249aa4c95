#include "collision/geometry/morton_order.h"

#include <algorithm>
#include <numeric>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::morton_order_test {

TEST_CASE("the order along the curve names every triangle once and keeps neighbours together") {
    const TriangleMesh ball = make_sphere(1.0, 4);
    const std::vector<int> order = morton_order(ball.triangles, ball.vertices);
    std::vector<int> sorted = order, all(ball.triangles.size());
    std::iota(all.begin(), all.end(), 0);
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == all);
    const auto centre = [&](int triangle) -> Vec3 {
        const auto& [a, b, c] = ball.triangles[triangle];
        return (ball.vertices[a] + ball.vertices[b] + ball.vertices[c]) / 3.0;
    };
    double way = 0.0, shuffled = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        way += (centre(order[i]) - centre(order[i - 1])).norm();
        shuffled += (centre(static_cast<int>(i * 1597 % order.size())) - centre(static_cast<int>(i))).norm();
    }
    CHECK(way < 0.1 * shuffled);
}

TEST_CASE("triangles at one place keep their order") {
    const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> same(5, Triangle{0, 1, 2});
    CHECK(morton_order(same, x) == std::vector<int>{0, 1, 2, 3, 4});
}

TEST_CASE("all vertices in one point, whose mean may differ by rounding, have an order") {
    const std::vector<Vec3> x(4, Vec3(0.1, 0.7, 0.3));
    const std::vector<Triangle> triangles{{0, 1, 2}, {1, 2, 3}, {2, 3, 0}};
    std::vector<int> order = morton_order(triangles, x);
    std::sort(order.begin(), order.end());
    CHECK(order == std::vector<int>{0, 1, 2});
}

}  // namespace percale::test::morton_order_test
