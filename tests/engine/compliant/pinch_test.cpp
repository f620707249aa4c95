#include "engine/compliant/pinch.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/contact_rows.h"

namespace percale::test::pinch_test {
namespace {

constexpr double h = 0.005;  // m, that of add_constraint

/// A script of two obstacles, and constraints of cloth between them.
struct Between {
    Script script;
    ContactConstraints constraints;

    Between(bool first_yields, bool second_yields) {
        script.obstacles.resize(2);
        if (first_yields) script.obstacles[0].compliance.mesh = std::make_shared<CompliantMesh>();
        if (second_yields) script.obstacles[1].compliance.mesh = std::make_shared<CompliantMesh>();
    }
    void press(int vertex, int obstacle, const Vec3& direction, double distance, const Vec3& displacement = Vec3::Zero()) {
        add({vertex, -1, -1, -1}, {1.0, 0.0, 0.0, 0.0}, obstacle, direction, distance, displacement);
    }
    /// Cloth vertex `first` above `second`.
    void layer(int first, int second, double distance) {
        add({first, second, -1, -1}, {1.0, -1.0, 0.0, 0.0}, -1, Vec3::UnitY(), distance, Vec3::Zero());
    }
    Retreats retreats() const { return retreats_of(constraints, script); }

private:
    void add(std::array<int, 4> vertex, std::array<double, 4> weight, int obstacle, const Vec3& direction, double distance,
             const Vec3& displacement) {
        add_constraint(vertex, weight, obstacle, constraints);
        constraints.direction.back() = direction;
        constraints.obstacle_displacement.back() = displacement;
        constraints.distance.back() = distance;
    }
};

}  // namespace

TEST_CASE("What the room between two obstacles lacks is taken off the compliant ones, half from each") {
    for (const auto& [first, second] : {std::pair(true, false), {false, true}, {true, true}}) {
        Between cloth(first, second);
        cloth.press(7, 0, Vec3::UnitY(), 0.8 * h);
        cloth.press(7, 1, -Vec3::UnitY(), 0.9 * h, Vec3(0.0, -1.1 * h, 0.0));  // comes down by 1.1 h
        const Retreats found = cloth.retreats();
        const double lack = 1.2 * h - (0.8 + 0.9 - 1.1) * h, each = first && second ? 0.5 * lack : lack;
        CHECK((first ? found.by_constraint[0] == Approx(each) : std::isinf(found.by_constraint[0])));
        CHECK((second ? found.by_constraint[1] == Approx(each) : std::isinf(found.by_constraint[1])));
        CHECK(found.min_room == Approx(0.6 * h));
        CHECK(found.obstacles == std::array{0, 1});
    }
}

TEST_CASE("Nothing has to give way for rigid obstacles, for those on one side, or for those at different vertices") {
    Between rigid(false, false), beside(true, true), apart(true, true);
    rigid.press(7, 0, Vec3::UnitY(), 0.1 * h);
    rigid.press(7, 1, -Vec3::UnitY(), 0.1 * h);
    beside.press(7, 0, Vec3::UnitY(), 0.1 * h);
    beside.press(7, 1, Vec3(1.0, 0.0, 0.0), 0.1 * h);
    apart.press(7, 0, Vec3::UnitY(), 0.1 * h);
    apart.press(8, 1, -Vec3::UnitY(), 0.1 * h);
    for (const Between* cloth : {&rigid, &beside, &apart}) {
        const Retreats found = cloth->retreats();
        for (const double retreat : found.by_constraint) CHECK(std::isinf(retreat));
        CHECK(found.obstacles[0] == -1);
    }
}

TEST_CASE("The edge of a valley, which is subtracted, pinches nothing") {
    Between cloth(true, true);
    cloth.press(7, 0, Vec3::UnitY(), 0.1 * h);
    cloth.press(7, 1, -Vec3::UnitY(), 0.1 * h);
    REQUIRE(std::isfinite(cloth.retreats().by_constraint[0]));
    cloth.constraints.mollifier = {-1.0, 1.0};
    for (const double retreat : cloth.retreats().by_constraint) CHECK(std::isinf(retreat));
}

TEST_CASE("A pinch is seen through layers of cloth, with the distances between them") {
    for (const int layers : {1, 2, 3, 4}) {
        Between cloth(true, false);
        cloth.press(0, 0, Vec3::UnitY(), 0.5 * h);
        for (int k = layers; k > 0; --k) cloth.layer(k, k - 1, 0.5 * h);
        cloth.press(layers, 1, -Vec3::UnitY(), 0.5 * h);
        const double found = cloth.retreats().by_constraint[0];
        const double lack = 0.6 * (2.0 + layers) * h - 0.5 * (2.0 + layers) * h;
        CAPTURE(layers);
        CHECK(found == Approx(lack));
    }
}

}  // namespace percale::test::pinch_test
