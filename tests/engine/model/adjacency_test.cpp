#include "engine/model/adjacency.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {
namespace {

struct Entry {
    int vertex, other, spring, place;
};

double sign_of(const SpringNetwork& network, const Entry& entry) {
    return network.first[entry.spring] == entry.vertex ? 1.0 : -1.0;
}

/// Entries in the order in which sums run, padding left out but checked.
std::vector<Entry> entries_of(const Adjacency& adjacency, int springs) {
    constexpr int lanes = Vectors::lanes;
    std::vector<Entry> entries;
    for (int s = 0; s < adjacency.slices(); ++s) {
        for (int e = adjacency.start[s]; e < adjacency.start[s + 1]; ++e) {
            const int vertex = s * lanes + (e - adjacency.start[s]) % lanes;
            if (adjacency.spring[e] < springs) {
                entries.push_back({vertex, adjacency.other[e], adjacency.spring[e], e});
                continue;
            }
            CHECK(adjacency.spring[e] == springs);
            CHECK((adjacency.stiffness[e] == 0.0 && adjacency.damping[e] == 0.0));
            CHECK(adjacency.other[e] == vertex);
        }
    }
    return entries;
}

void check_entries(const ClothModel& model) {
    const SpringNetwork& network = model.springs;
    std::vector<int> first_seen(network.size(), 0), second_seen(network.size(), 0);
    for (const Entry& entry : entries_of(model.adjacency, network.size())) {
        const bool first = network.first[entry.spring] == entry.vertex;
        ++(first ? first_seen : second_seen)[entry.spring];
        CHECK(entry.vertex == (first ? network.first : network.second)[entry.spring]);
        CHECK(entry.other == (first ? network.second : network.first)[entry.spring]);
        CHECK((model.adjacency.entry[entry.spring] == entry.place) == first);
        CHECK(model.adjacency.stiffness[entry.place] == network.stiffness[entry.spring]);
        CHECK(model.adjacency.rest_length[entry.place] == network.rest_length[entry.spring]);
        CHECK(model.adjacency.damping[entry.place] == network.damping[entry.spring]);
    }
    for (int k = 0; k < network.size(); ++k) CHECK((first_seen[k] == 1 && second_seen[k] == 1));
}

}  // namespace

TEST_CASE("Every spring appears once at each of its ends, with its constants") {
    Random random(7);
    for (const int vertices : {2, 7, 15, 16, 17, 32, 41}) {
        check_entries(linked_masses(random_masses(random, vertices), random_links(random, vertices, 3 * vertices)));
    }
    check_entries(cloth_model(make_grid(1.0, 1.0, 6, 5), sheet_fabric()));
}

TEST_CASE("A vertex without springs has padding only") {
    const ClothModel model = linked_masses(std::vector<double>(20, 1.0), {{1, 18, 1.0, 1.0, 0.0}, {18, 1, 1.0, 1.0, 0.0}});
    check_entries(model);
    CHECK(model.adjacency.slices() == 2);
    CHECK(model.adjacency.start.back() == 4 * Vectors::lanes);
    CHECK(model.adjacency.vertex_count == 20);
}

TEST_CASE("Sums over the adjacency have the bits of a loop over the springs") {
    Random random(9);
    const ClothModel model = linked_masses(random_masses(random, 37), random_links(random, 37, 150));
    std::vector<double> value(model.springs.size() + 1, 0.0), expected(37, 0.0), sums(48, 0.0);
    for (int k = 0; k < model.springs.size(); ++k) {
        value[k] = random.number(-1.0, 1.0);
        expected[model.springs.first[k]] += value[k];
        expected[model.springs.second[k]] -= value[k];
    }
    for (const Entry& entry : entries_of(model.adjacency, model.springs.size())) {
        sums[entry.vertex] += sign_of(model.springs, entry) * value[entry.spring];
    }
    for (int i = 0; i < 37; ++i) CHECK(sums[i] == expected[i]);
}

TEST_CASE("A network is damped if one of its springs is") {
    CHECK_FALSE(linked_masses({1, 1, 1}, {{0, 1, 1.0, 1.0, 0.0}, {1, 2, 1.0, 1.0, 0.0}}).adjacency.damped);
    CHECK(linked_masses({1, 1, 1}, {{0, 1, 1.0, 1.0, 0.0}, {1, 2, 1.0, 1.0, 0.5}}).adjacency.damped);
}

}  // namespace percale::test
