#include "collision/lists/feature_minima.h"

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"

using namespace percale;

namespace {

/// Rows told apart by `feature`, with directions by their angle from y.
struct Written {
    ContactRows rows;
    FeatureMinima minima;

    Written() { minima.begin(rows); }
    void add(int feature, double degrees, bool minimum, int second_vertex = -1) {
        const double angle = degrees * std::numbers::pi / 180.0;
        rows.vertex.push_back({7, second_vertex, -1, -1});
        rows.weight.push_back({1.0, 0.0, 0.0, 0.0});
        rows.direction.emplace_back(std::sin(angle), std::cos(angle), 0.0);
        for (auto* vectors : {&rows.obstacle_point, &rows.obstacle_displacement}) vectors->push_back(Vec3::Zero());
        for (auto* numbers : {&rows.distance, &rows.thickness, &rows.friction, &rows.share}) numbers->push_back(feature);
        rows.obstacle.push_back(0);
        rows.feature.push_back(feature);
        minima.add(minimum);
    }
    void end_feature() { minima.next_feature(rows); }
};

}  // namespace

TEST_CASE("a row gives way to a minimum in nearly its direction, and to nothing else") {
    Written written;
    written.add(1, 0.0, false);
    written.add(2, 10.0, true);
    written.add(3, 20.0, true);    // a minimum itself
    written.add(4, -40.0, false);  // 50 degrees from the nearest of them
    written.add(5, 35.0, false);
    written.end_feature();
    CHECK(written.rows.feature == std::vector<int>{2, 3, 4});
    CHECK(written.rows.distance == std::vector<double>{2, 3, 4});
    CHECK(written.rows.size() == 3);
    CHECK(written.rows.direction.size() == 3);
}

TEST_CASE("rows that are no minima any more stay where none has taken their place") {
    Written written;
    written.add(1, 0.0, false);
    written.add(2, 1.0, false);
    written.end_feature();
    CHECK(written.rows.feature == std::vector<int>{1, 2});
}

TEST_CASE("minima of another cloth feature, and rows that were there before, do not count") {
    Written written;
    written.add(1, 0.0, true);
    written.end_feature();
    written.add(2, 0.0, false);
    written.end_feature();
    written.add(3, 0.0, true);
    written.add(4, 0.0, false);
    written.minima.begin(written.rows);
    written.end_feature();
    CHECK(written.rows.feature == std::vector<int>{1, 2, 3, 4});
}

TEST_CASE("rows of edges do not give way") {
    Written written;
    written.add(1, 0.0, false, 8);
    written.add(2, 0.0, true, 8);
    written.end_feature();
    CHECK(written.rows.feature == std::vector<int>{1, 2});
}
