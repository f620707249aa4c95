#include "collision/lists/feature_minima.h"

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"

namespace percale::test::feature_minima_test {
namespace {

/// Constraints distinguished by `feature`, which is also their thickness and distance; their directions are given by the angle
/// from y.
struct Written {
    ContactConstraints constraints;
    FeatureMinima minima;

    Written() { minima.begin(constraints); }
    void add(int feature, double degrees, bool minimum, int second_vertex = -1) {
        add_at(Vec3(feature, 0.0, 0.0), feature, degrees, minimum, second_vertex);
    }
    void add_at(const Vec3& place, int feature, double degrees, bool minimum, int second_vertex = -1) {
        const double angle = degrees * std::numbers::pi / 180.0;
        constraints.vertex.push_back({7, second_vertex, -1, -1});
        constraints.weight.push_back({1.0, 0.0, 0.0, 0.0});
        constraints.direction.emplace_back(std::sin(angle), std::cos(angle), 0.0);
        constraints.obstacle_point.push_back(place);
        constraints.obstacle_displacement.push_back(Vec3::Zero());
        for (auto* numbers : {&constraints.distance, &constraints.thickness, &constraints.friction, &constraints.mollifier})
            numbers->push_back(feature);
        constraints.obstacle.push_back(0);
        constraints.feature.push_back(feature);
        minima.add(minimum);
    }
    void end_feature() { minima.next_feature(constraints); }
};

}  // namespace

TEST_CASE("a constraint gives way to a minimum in nearly its direction, and to nothing else") {
    Written written;
    written.add(1, 0.0, false);
    written.add(2, 10.0, true);
    written.add(3, 20.0, true);    // a minimum itself
    written.add(4, -40.0, false);  // 50 degrees from the nearest of them
    written.add(5, 35.0, false);
    written.end_feature();
    CHECK(written.constraints.feature == std::vector<int>{2, 3, 4});
    CHECK(written.constraints.distance == std::vector<double>{2, 3, 4});
    CHECK(written.constraints.size() == 3);
    CHECK(written.constraints.direction.size() == 3);
}

TEST_CASE("constraints that are no longer minima stay where none has taken their place") {
    Written written;
    written.add(1, 0.0, false);
    written.add(2, 1.0, false);
    written.end_feature();
    CHECK(written.constraints.feature == std::vector<int>{1, 2});
}

TEST_CASE("of two equal constraints at one place, as rounding gives for both faces at an edge, the first one stays") {
    const Vec3 place(0.3, 0.2, 0.1), rounded = place + Vec3(1e-13, 0.0, 0.0);
    for (const bool minimum : {true, false}) {
        Written written;
        written.add_at(place, 1, 0.0, minimum);
        written.add_at(rounded, 2, 0.0, minimum);
        written.add_at(place + Vec3(1e-4, 0.0, 0.0), 3, 0.0, minimum);
        written.add_at(place, 4, 60.0, minimum);  // from another side
        written.end_feature();
        CHECK(written.constraints.feature == std::vector<int>{1, 3, 4});
    }
}

TEST_CASE("minima of another cloth feature, and constraints that existed before, do not count") {
    Written written;
    written.add(1, 0.0, true);
    written.end_feature();
    written.add(2, 0.0, false);
    written.end_feature();
    written.add(3, 0.0, true);
    written.add(4, 0.0, false);
    written.minima.begin(written.constraints);
    written.end_feature();
    CHECK(written.constraints.feature == std::vector<int>{1, 2, 3, 4});
}

TEST_CASE("constraints of edges do not give way") {
    Written written;
    written.add(1, 0.0, false, 8);
    written.add(2, 0.0, true, 8);
    written.end_feature();
    CHECK(written.constraints.feature == std::vector<int>{1, 2});
}

}  // namespace percale::test::feature_minima_test
