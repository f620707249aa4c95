#include "engine/contact/multipliers.h"

#include "tests/support/catch.h"

namespace percale::test::multipliers_test {

TEST_CASE("Contact forces are found again by row, unknown rows have none") {
    ContactMultipliers multipliers;
    const RowKey unknown{.vertex = {7, -1, -1, -1}, .obstacle = 0, .feature = 3};
    CHECK(multipliers.of(unknown).normal == 0.0);
    multipliers.clear(1000);
    for (int i = 0; i < 1000; ++i) {
        const RowKey key{.vertex = {i % 10, i / 10, -1, -1}, .obstacle = i % 2, .feature = i % 3};
        multipliers.add(key, {.normal = 1.0 + i, .friction = Vec3(0.0, i, 0.0), .stiffness = 2.0});
    }
    CHECK(multipliers.size() == 1000);
    for (int i = 0; i < 1000; ++i) {
        const RowKey key{.vertex = {i % 10, i / 10, -1, -1}, .obstacle = i % 2, .feature = i % 3};
        REQUIRE(multipliers.of(key).normal == 1.0 + i);
        REQUIRE(multipliers.of(key).friction.y() == i);
    }
    CHECK(multipliers.of(unknown).normal == 0.0);
    multipliers.clear(1);
    CHECK(multipliers.size() == 0);
    CHECK(multipliers.of({.vertex = {1, 0, -1, -1}, .obstacle = 1, .feature = 1}).normal == 0.0);
}

TEST_CASE("Rows of the same cloth features are told apart by obstacle and by its feature") {
    ContactRows rows;
    for (int i = 0; i < 3; ++i) {
        rows.vertex.push_back({4, 5, -1, -1});
        rows.obstacle.push_back(i == 1);
        rows.feature.push_back(i == 2);
    }
    CHECK_FALSE(row_key(rows, 0) == row_key(rows, 1));
    CHECK_FALSE(row_key(rows, 0) == row_key(rows, 2));
    CHECK(row_key(rows, 0) == RowKey{.vertex = {4, 5, -1, -1}, .obstacle = 0, .feature = 0});
}

TEST_CASE("All forces are told in the order of their keys, and another table takes them") {
    const auto key = [](int i) { return RowKey{.vertex = {i % 5, i, -1, -1}, .obstacle = 0, .feature = i % 3}; };
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
    CHECK(copy.size() == 20);
    for (int i = 0; i < 20; ++i) CHECK(copy.of(key(i)).normal == 1.0 + i);
    CHECK(copy.of(key(20)).normal == 0.0);
}

TEST_CASE("A force goes on to the nearest row of its cloth feature when its own is gone or has left") {
    constexpr double h = 0.005;
    constexpr RowClearance clearance{.zone = 1.2, .share = 1e-3};
    ContactRows rows;
    const auto add_row = [&](int vertex, int obstacle, int feature, double distance, const Vec3& direction = Vec3(0, 1, 0)) {
        rows.vertex.push_back({vertex, vertex + 1, -1, -1});
        rows.obstacle.push_back(obstacle);
        rows.feature.push_back(feature);
        rows.distance.push_back(distance);
        rows.thickness.push_back(clearance.zone * h);
        rows.share.push_back(1.0);
        rows.direction.push_back(direction);
    };
    const auto key = [](int vertex, int obstacle, int feature) {
        return RowKey{.vertex = {vertex, vertex + 1, -1, -1}, .obstacle = obstacle, .feature = feature};
    };
    ContactMultipliers multipliers;
    multipliers.clear(10);
    const auto push = [&](const RowKey& row, double force) {
        multipliers.add(row, {.normal = force, .friction = Vec3(0.1 * force, 0, 0)});
    };
    // Left behind for a nearer row, which has a force already; one vertex further the nearer lies on another obstacle.
    add_row(0, 0, 1, 1.01 * h);
    add_row(0, 0, 2, 0.99 * h);
    add_row(2, 0, 1, 1.01 * h);
    add_row(2, 1, 2, 0.99 * h);
    push(key(0, 0, 1), 3.0);
    push(key(0, 0, 2), 2.0);
    push(key(2, 0, 1), 5.0);
    // Two that rest, one of them a little farther off; two sides of a gap.
    add_row(4, 0, 1, 1.0009 * h);
    add_row(4, 0, 2, h);
    add_row(6, 0, 1, 1.1 * h);
    add_row(6, 0, 2, h, Vec3(0, -1, 0));
    push(key(4, 0, 1), 7.0);
    push(key(6, 0, 1), 11.0);
    // Gone, with another row of the feature and without; the nearest is nearly parallel.
    add_row(8, 0, 2, 1.15 * h);
    add_row(8, 0, 3, 1.1 * h);
    rows.share.back() = 0.1;
    push(key(8, 0, 1), 13.0);
    push(key(10, 0, 1), 17.0);
    multipliers.hand_over(rows, clearance);
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
}

TEST_CASE("Forces that are handed to one row have the same sum in whatever order they came") {
    ContactRows rows;
    rows.vertex = {{0, 1, -1, -1}};
    rows.obstacle = {0};
    rows.feature = {9};
    rows.distance = {0.004};
    rows.thickness = {0.006};
    rows.share = {1.0};
    rows.direction = {Vec3(0, 1, 0)};
    const double forces[] = {0.1, 0.2, 0.3, 1e-17, 0.7};
    ContactMultipliers up, down;
    up.clear(5);
    down.clear(5);
    for (int i = 0; i < 5; ++i) {
        up.add({.vertex = {0, 1, -1, -1}, .obstacle = 0, .feature = i}, {.normal = forces[i]});
        down.add({.vertex = {0, 1, -1, -1}, .obstacle = 0, .feature = 4 - i}, {.normal = forces[4 - i]});
    }
    for (ContactMultipliers* multipliers : {&up, &down}) multipliers->hand_over(rows, {.zone = 1.2, .share = 1e-3});
    REQUIRE(up.size() == 1);
    CHECK(up.of(row_key(rows, 0)).normal == down.of(row_key(rows, 0)).normal);
    CHECK(up.of(row_key(rows, 0)).normal == Approx(1.3));
}

TEST_CASE("Between cloths a force stays with its row") {
    ContactRows rows;
    rows.vertex = {{0, 1, 2, 3}};
    rows.obstacle = {-1};
    rows.feature = {2};
    rows.distance = {0.004};
    rows.thickness = {0.006};
    rows.share = {1.0};
    rows.direction = {Vec3(0, 1, 0)};
    ContactMultipliers multipliers;
    multipliers.clear(1);
    const RowKey other{.vertex = {0, 1, 2, 3}, .obstacle = -1, .feature = 1};
    multipliers.add(other, {.normal = 2.0});
    multipliers.hand_over(rows, {.zone = 1.2, .share = 1e-3});
    CHECK(multipliers.of(other).normal == 2.0);
}

}  // namespace percale::test::multipliers_test
