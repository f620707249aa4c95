#include "collision/obstacle/pack_bounds.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random.h"
#include "tests/support/skip.h"

namespace percale::test::pack_bounds_test {
namespace {

bool same(const PackAnswer& a, const PackAnswer& b) {
    return std::memcmp(&a.distance_bound, &b.distance_bound, sizeof(float)) == 0 &&
           std::memcmp(&a.travel_to_contact, &b.travel_to_contact, sizeof(float)) == 0 && a.near == b.near &&
           a.contact == b.contact;
}

}  // namespace

TEST_CASE("all instruction sets give the same bits") {
    const PackKernels* wide = avx2_pack_kernels();
    if (!wide) {
        skip("this processor has the baseline alone");
        return;
    }
    const PackKernels& narrow = *baseline_pack_kernels();
    Random random(60);
    int differing = 0, near = 0;
    for (int round = 0; round < 3000; ++round) {
        PackLanes lanes;
        for (auto& row : lanes.at) {
            for (float& value : row) value = static_cast<float>(random.number(-1.0, 1.0));
        }
        PackQuery query{.at = {},
                        .size = 1.0F,
                        .sharpness = 2.0F,
                        .shortest_edge = 0.1F,
                        .length = 0.5F,
                        .near = 0.5F,
                        .thickness = 0.4F,
                        .all = 0x7f};
        for (float& value : query.at) value = static_cast<float>(random.number(-1.0, 1.0));
        using Kernel = PackKernels::Function PackKernels::*;
        for (const Kernel kernel : {&PackKernels::vertex_face, &PackKernels::edge_edge, &PackKernels::face_vertex}) {
            PackAnswer first{}, second{};
            (narrow.*kernel)(lanes, query, first);
            (wide->*kernel)(lanes, query, second);
            differing += same(first, second) ? 0 : 1;
            near += first.near != 0 ? 1 : 0;
        }
    }
    CHECK(near > 1000);
    CHECK(differing == 0);
}

TEST_CASE("a point over a right triangle is as far from it as it is high, and unused lanes are not near") {
    PackLanes lanes{};
    for (int lane = 0; lane < pack_lanes; ++lane) {
        const float corner[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
        for (int i = 0; i < 9; ++i) lanes.at[i][lane] = corner[i] + (i % 3 == 1 ? -0.1F * static_cast<float>(lane) : 0.0F);
    }
    const PackQuery query{.at = {0.25F, 0.3F, 0.25F},
                          .size = 1.0F,
                          .sharpness = 1.5F,
                          .shortest_edge = 1.0F,
                          .length = 1.0F,
                          .near = 0.45F,
                          .thickness = 0.45F,
                          .all = 0x3f};
    PackAnswer answer{};
    baseline_pack_kernels()->vertex_face(lanes, query, answer);
    CHECK(answer.distance_bound == Approx(0.3).margin(1e-5));
    CHECK(answer.distance_bound < 0.3F);
    CHECK(answer.near == 0b11);
    CHECK(answer.contact == 0b11);
}

TEST_CASE("the smallest bound and those up to a limit are found in arrays of any length, by all instruction sets") {
    const PackKernels* kernels = GENERATE(baseline_pack_kernels(), avx2_pack_kernels());
    const std::size_t count = GENERATE(0, 1, 7, 8, 9, 40, 1003);
    if (!kernels) return;
    Random random(61);
    std::vector<float> bounds(count);
    for (float& bound : bounds) bound = static_cast<float>(random.number(-1.0, 1.0));
    if (count > 8) bounds[count / 2] = -std::numeric_limits<float>::infinity();
    const float limit = count > 0 ? bounds[count / 3] : 0.0F;
    float least = std::numeric_limits<float>::infinity();
    std::vector<int> expected, found(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (bounds[i] <= limit) expected.push_back(static_cast<int>(i));
        least = std::min(least, bounds[i]);
    }
    found.resize(kernels->find_up_to(bounds.data(), static_cast<long>(count), limit, found.data()));
    CAPTURE(count, limit);
    CHECK(found == expected);
    CHECK(kernels->smallest(bounds.data(), static_cast<long>(count)) == least);
}

}  // namespace percale::test::pack_bounds_test
