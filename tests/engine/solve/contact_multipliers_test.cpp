#include "engine/solve/contact_multipliers.h"

#include "tests/support/catch.h"

namespace percale::test {

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

}  // namespace percale::test
