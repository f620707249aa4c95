#include "engine/model/adjacency.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {
namespace {

struct Entry {
    int vertex, other, spring;
    double sign;
};

/// Entries in the order in which sums run, padding left out but checked.
std::vector<Entry> entries_of(const Adjacency& adjacency, int springs) {
    constexpr int lanes = Vectors::lanes;
    std::vector<Entry> entries;
    for (int s = 0; s < adjacency.slices(); ++s) {
        for (int e = adjacency.start[s]; e < adjacency.start[s + 1]; ++e) {
            const int vertex = s * lanes + (e - adjacency.start[s]) % lanes;
            if (adjacency.spring[e] < springs) {
                entries.push_back({vertex, adjacency.other[e], adjacency.spring[e], adjacency.sign[e]});
                continue;
            }
            CHECK(adjacency.spring[e] == springs);
            CHECK(adjacency.sign[e] == 0.0);
            CHECK(adjacency.other[e] == vertex);
        }
    }
    return entries;
}

void check_entries(const ClothModel& model) {
    const SpringNetwork& network = model.springs;
    std::vector<int> first_seen(network.size(), 0), second_seen(network.size(), 0);
    for (const Entry& entry : entries_of(model.adjacency, network.size())) {
        const bool first = entry.sign > 0.0;
        REQUIRE(std::abs(entry.sign) == 1.0);
        ++(first ? first_seen : second_seen)[entry.spring];
        CHECK(entry.vertex == (first ? network.first : network.second)[entry.spring]);
        CHECK(entry.other == (first ? network.second : network.first)[entry.spring]);
    }
    for (int k = 0; k < network.size(); ++k) CHECK((first_seen[k] == 1 && second_seen[k] == 1));
}

}  // namespace

TEST_CASE("Every spring appears once at each of its ends, with opposite signs") {
    Random random(7);
    for (const int vertices : {2, 7, 8, 9, 16, 41}) {
        check_entries(linked_masses(random_masses(random, vertices), random_links(random, vertices, 3 * vertices)));
    }
    check_entries(cloth_model(make_grid(1.0, 1.0, 6, 5), sheet_fabric()));
}

TEST_CASE("A vertex without springs has padding only") {
    const ClothModel model = linked_masses(std::vector<double>(12, 1.0), {{1, 10, 1.0, 1.0, 0.0}, {10, 1, 1.0, 1.0, 0.0}});
    check_entries(model);
    CHECK(model.adjacency.slices() == 2);
    CHECK(model.adjacency.start.back() == 4 * Vectors::lanes);
    CHECK(model.adjacency.vertex_count == 12);
}

TEST_CASE("Sums over the adjacency have the bits of a loop over the springs") {
    Random random(9);
    const ClothModel model = linked_masses(random_masses(random, 37), random_links(random, 37, 150));
    std::vector<double> value(model.springs.size() + 1, 0.0), expected(37, 0.0), sums(40, 0.0);
    for (int k = 0; k < model.springs.size(); ++k) {
        value[k] = random.number(-1.0, 1.0);
        expected[model.springs.first[k]] += value[k];
        expected[model.springs.second[k]] -= value[k];
    }
    for (const Entry& entry : entries_of(model.adjacency, model.springs.size()))
        sums[entry.vertex] += entry.sign * value[entry.spring];
    for (int i = 0; i < 37; ++i) CHECK(sums[i] == expected[i]);
}

}  // namespace percale::test
