#include "engine/model/membrane_entries.h"

#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"

namespace percale::test::membrane_entries_test {

TEST_CASE("Every edge is seen from both ends with the same numbers, near and far exchanged") {
    const ClothModel model = cloth_model(make_grid(0.5, 0.3, 6, 4), woven_fabric());
    const Adjacency& adjacency = model.adjacency;
    const MembraneEntries& membrane = adjacency.membrane;
    REQUIRE_FALSE(membrane.empty());
    const auto entry = [&](int vertex, int other) {
        int e = adjacency.start[vertex / slice_lanes] + vertex % slice_lanes;
        while (adjacency.other[e] != other) e += slice_lanes;
        return e;
    };
    for (int k = 0; k < model.springs.size(); ++k) {
        const int here = entry(model.springs.first[k], model.springs.second[k]);
        const int there = entry(model.springs.second[k], model.springs.first[k]);
        for (const int n : {0, 1, 6}) CHECK(membrane.numbers[n][here] == membrane.numbers[n][there]);
        for (const int n : {2, 4}) {
            CHECK(membrane.numbers[n][here] == membrane.numbers[n + 1][there]);
            CHECK(membrane.numbers[n + 1][here] == membrane.numbers[n][there]);
        }
        CHECK(membrane.opposite[0][here] == membrane.opposite[0][there]);
        if (membrane.numbers[4][here] != 0.0) CHECK(membrane.opposite[1][here] == membrane.opposite[1][there]);
        CHECK(adjacency.strength(k) == Approx(4.0 * membrane.numbers[0][here] * membrane.numbers[1][here]));
    }
}

TEST_CASE("Every triangle has a corner at each of its vertices, and padding refers to the vertex itself") {
    const ClothModel model = cloth_model(make_grid(0.5, 0.3, 7, 5), woven_fabric());
    const MembraneEntries& membrane = model.adjacency.membrane;
    std::vector<int> corners(model.vertex_count(), 0), expected(model.vertex_count(), 0);
    for (const MembraneTriangle& t : model.membrane) {
        for (const int vertex : t.vertex) ++expected[vertex];
    }
    for (int s = 0; s + 1 < static_cast<int>(membrane.corner_start.size()); ++s) {
        for (int e = membrane.corner_start[s]; e < membrane.corner_start[s + 1]; ++e) {
            const int own = s * slice_lanes + (e - membrane.corner_start[s]) % slice_lanes;
            const int first = membrane.corner_other[0][e], second = membrane.corner_other[1][e];
            CHECK((first == own) == (second == own));
            if (first != own) ++corners[own];
        }
    }
    CHECK(corners == expected);
}

TEST_CASE("Springs of cloth without moduli keep their layout beside a membrane-less model") {
    CHECK(cloth_model(make_grid(1.0, 1.0, 9, 9), sheet_fabric()).adjacency.membrane.empty());
    CHECK(cloth_model(make_grid(1.0, 1.0, 9, 9), sheet_fabric()).adjacency.bands.count > 0);
    CHECK(cloth_model(make_grid(1.0, 1.0, 9, 9), woven_fabric()).adjacency.bands.count == 0);
}

}  // namespace percale::test::membrane_entries_test
