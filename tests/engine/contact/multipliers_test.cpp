#include "engine/contact/multipliers.h"

#include "tests/support/catch.h"

namespace percale::test::multipliers_test {

TEST_CASE("Contact forces are found again by constraint, unknown constraints have none") {
    ContactMultipliers multipliers;
    const ConstraintKey unknown{.vertex = {7, -1, -1, -1}, .obstacle = 0, .feature = 3};
    CHECK(multipliers.of(unknown).normal == 0.0);
    multipliers.clear(1000);
    for (int i = 0; i < 1000; ++i) {
        const ConstraintKey key{.vertex = {i % 10, i / 10, -1, -1}, .obstacle = i % 2, .feature = i % 3};
        multipliers.add(key, {.normal = 1.0 + i, .friction = Vec3(0.0, i, 0.0), .stiffness = 2.0});
    }
    CHECK(multipliers.all().size() == 1000);
    for (int i = 0; i < 1000; ++i) {
        const ConstraintKey key{.vertex = {i % 10, i / 10, -1, -1}, .obstacle = i % 2, .feature = i % 3};
        REQUIRE(multipliers.of(key).normal == 1.0 + i);
        REQUIRE(multipliers.of(key).friction.y() == i);
    }
    CHECK(multipliers.of(unknown).normal == 0.0);
    multipliers.clear(1);
    CHECK(multipliers.all().size() == 0);
    CHECK(multipliers.of({.vertex = {1, 0, -1, -1}, .obstacle = 1, .feature = 1}).normal == 0.0);
}

TEST_CASE("Constraints of the same cloth features are distinguished by obstacle and by its feature") {
    ContactConstraints constraints;
    for (int i = 0; i < 3; ++i) {
        constraints.vertex.push_back({4, 5, -1, -1});
        constraints.obstacle.push_back(i == 1);
        constraints.feature.push_back(i == 2);
    }
    CHECK_FALSE(constraint_key(constraints, 0) == constraint_key(constraints, 1));
    CHECK_FALSE(constraint_key(constraints, 0) == constraint_key(constraints, 2));
    CHECK(constraint_key(constraints, 0) == ConstraintKey{.vertex = {4, 5, -1, -1}, .obstacle = 0, .feature = 0});
}

TEST_CASE("All forces are listed in the order of their keys, and another table accepts them") {
    const auto key = [](int i) { return ConstraintKey{.vertex = {i % 5, i, -1, -1}, .obstacle = 0, .feature = i % 3}; };
    ContactMultipliers first, roomy, copy;
    first.clear(20);
    roomy.clear(500);
    for (int i = 0; i < 20; ++i) first.add(key(i), {.normal = 1.0 + i});
    for (int i = 19; i >= 0; --i) roomy.add(key(i), {.normal = 1.0 + i});
    const std::vector<KeyedForce> all = first.all(), same = roomy.all();
    REQUIRE(all.size() == 20);
    for (std::size_t k = 0; k < all.size(); ++k) {
        CHECK(all[k].key == same[k].key);
        if (k > 0) CHECK(all[k - 1].key < all[k].key);
    }
    copy.set(all);
    CHECK(copy.all().size() == 20);
    for (int i = 0; i < 20; ++i) CHECK(copy.of(key(i)).normal == 1.0 + i);
    CHECK(copy.of(key(20)).normal == 0.0);
}

TEST_CASE("A force moves on to the nearest constraint of its cloth feature when its own is gone or has left") {
    constexpr double h = 0.005;
    constexpr ConstraintClearance clearance{.activation_ratio = 1.2, .ratio = 1e-3};
    ContactConstraints constraints;
    const auto add_constraint = [&](int vertex, int obstacle, int feature, double distance,
                                    const Vec3& direction = Vec3(0, 1, 0)) {
        constraints.vertex.push_back({vertex, vertex + 1, -1, -1});
        constraints.obstacle.push_back(obstacle);
        constraints.feature.push_back(feature);
        constraints.distance.push_back(distance);
        constraints.thickness.push_back(clearance.activation_ratio * h);
        constraints.mollifier.push_back(1.0);
        constraints.direction.push_back(direction);
    };
    const auto key = [](int vertex, int obstacle, int feature) {
        return ConstraintKey{.vertex = {vertex, vertex + 1, -1, -1}, .obstacle = obstacle, .feature = feature};
    };
    ContactMultipliers multipliers;
    multipliers.clear(10);
    const auto push = [&](const ConstraintKey& constraint, double force) {
        multipliers.add(constraint, {.normal = force, .friction = Vec3(0.1 * force, 0, 0), .direction = Vec3(0, 1, 0)});
    };
    // Left for a nearer constraint that has a force already; one vertex further the nearer one is with another obstacle.
    add_constraint(0, 0, 1, 1.01 * h);
    add_constraint(0, 0, 2, 0.99 * h);
    add_constraint(2, 0, 1, 1.01 * h);
    add_constraint(2, 1, 2, 0.99 * h);
    push(key(0, 0, 1), 3.0);
    push(key(0, 0, 2), 2.0);
    push(key(2, 0, 1), 5.0);
    // Two at rest, one of them a little farther off; two sides of a gap.
    add_constraint(4, 0, 1, 1.0009 * h);
    add_constraint(4, 0, 2, h);
    add_constraint(6, 0, 1, 1.1 * h);
    add_constraint(6, 0, 2, h, Vec3(0, -1, 0));
    push(key(4, 0, 1), 7.0);
    push(key(6, 0, 1), 11.0);
    // Gone, with another constraint of the feature and without; the nearest is nearly parallel.
    add_constraint(8, 0, 2, 1.15 * h);
    add_constraint(8, 0, 3, 1.1 * h);
    constraints.mollifier.back() = 0.1;
    push(key(8, 0, 1), 13.0);
    push(key(10, 0, 1), 17.0);
    // Gone, with a constraint on the other side of a gap.
    add_constraint(12, 0, 2, h, Vec3(0.1, -1, 0).normalized());
    push(key(12, 0, 1), 19.0);
    multipliers.transfer(constraints, clearance);
    CHECK(multipliers.of(key(0, 0, 1)).normal == 0.0);
    CHECK(multipliers.of(key(0, 0, 2)).normal == 5.0);
    CHECK(multipliers.of(key(0, 0, 2)).friction.x() == Approx(0.5));
    CHECK(multipliers.of(key(2, 0, 1)).normal == 5.0);
    CHECK(multipliers.of(key(2, 1, 2)).normal == 0.0);
    CHECK(multipliers.of(key(4, 0, 1)).normal == 7.0);
    CHECK(multipliers.of(key(6, 0, 1)).normal == 11.0);
    CHECK(multipliers.of(key(8, 0, 1)).normal == 0.0);
    CHECK(multipliers.of(key(8, 0, 2)).normal == 13.0);
    CHECK(multipliers.of(key(10, 0, 1)).normal == 17.0);
    CHECK(multipliers.of(key(12, 0, 1)).normal == 19.0);
    CHECK(multipliers.count_with_obstacles() == 7);
}

TEST_CASE("Forces that move on to one constraint have the same sum in whatever order they were added") {
    ContactConstraints constraints;
    constraints.vertex = {{0, 1, -1, -1}};
    constraints.obstacle = {0};
    constraints.feature = {9};
    constraints.distance = {0.004};
    constraints.thickness = {0.006};
    constraints.mollifier = {1.0};
    constraints.direction = {Vec3(0, 1, 0)};
    const double forces[] = {0.1, 0.2, 0.3, 1e-17, 0.7};
    ContactMultipliers up, down;
    up.clear(5);
    down.clear(5);
    for (int i = 0; i < 5; ++i) {
        up.add({.vertex = {0, 1, -1, -1}, .obstacle = 0, .feature = i}, {.normal = forces[i], .direction = Vec3(0, 1, 0)});
        down.add({.vertex = {0, 1, -1, -1}, .obstacle = 0, .feature = 4 - i},
                 {.normal = forces[4 - i], .direction = Vec3(0, 1, 0)});
    }
    for (ContactMultipliers* multipliers : {&up, &down})
        multipliers->transfer(constraints, {.activation_ratio = 1.2, .ratio = 1e-3});
    REQUIRE(up.all().size() == 1);
    CHECK(up.of(constraint_key(constraints, 0)).normal == down.of(constraint_key(constraints, 0)).normal);
    CHECK(up.of(constraint_key(constraints, 0)).normal == Approx(1.3));
}

TEST_CASE("Between cloths a force stays with its constraint") {
    ContactConstraints constraints;
    constraints.vertex = {{0, 1, 2, 3}};
    constraints.obstacle = {-1};
    constraints.feature = {2};
    constraints.distance = {0.004};
    constraints.thickness = {0.006};
    constraints.mollifier = {1.0};
    constraints.direction = {Vec3(0, 1, 0)};
    ContactMultipliers multipliers;
    multipliers.clear(1);
    const ConstraintKey other{.vertex = {0, 1, 2, 3}, .obstacle = -1, .feature = 1};
    multipliers.add(other, {.normal = 2.0, .direction = Vec3(0, 1, 0)});
    multipliers.transfer(constraints, {.activation_ratio = 1.2, .ratio = 1e-3});
    CHECK(multipliers.of(other).normal == 2.0);
}

}  // namespace percale::test::multipliers_test
