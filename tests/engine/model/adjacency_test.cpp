#include "engine/model/adjacency.h"

#include <set>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::adjacency_test {
namespace {

struct Entry {
    int vertex, other, spring, place;
};

double sign_of(const SpringNetwork& network, const Entry& entry) {
    return network.first[entry.spring] == entry.vertex ? 1.0 : -1.0;
}

/// Entries in the order in which sums run, padding left out but checked.
std::vector<Entry> entries_of(const Adjacency& adjacency, int springs) {
    constexpr int lanes = Vec3Arrays::lanes;
    std::vector<Entry> entries;
    for (int s = 0; s < adjacency.slices(); ++s) {
        for (int e = adjacency.start[s]; e < adjacency.start[s + 1]; ++e) {
            const int vertex = s * lanes + (e - adjacency.start[s]) % lanes;
            if (adjacency.spring[e] < springs) {
                entries.push_back({vertex, adjacency.other[e], adjacency.spring[e], e});
                continue;
            }
            CHECK(adjacency.spring[e] == springs);
            CHECK(adjacency.other[e] == vertex);
            if (adjacency.bands.count == 0) CHECK((adjacency.stiffness[e] == 0.0 && adjacency.damping[e] == 0.0));
        }
    }
    return entries;
}

void check_constants(const Adjacency& adjacency, int place, const SpringNetwork& network, int spring) {
    CHECK(adjacency.stiffness[place] == network.stiffness[spring]);
    CHECK(adjacency.rest_length[place] == network.rest_length[spring]);
    CHECK(adjacency.damping[place] == network.damping[spring]);
}

void check_entries(const ClothModel& model) {
    const SpringNetwork& network = model.springs;
    const Adjacency adjacency = make_adjacency(network, model.vertex_count(), SpringLayout::slices);
    CHECK(adjacency.bands.count == 0);
    CHECK(adjacency.stiffness.size() == adjacency.other.size());
    std::vector<int> first_seen(network.size(), 0), second_seen(network.size(), 0);
    for (const Entry& entry : entries_of(adjacency, network.size())) {
        const bool first = network.first[entry.spring] == entry.vertex;
        ++(first ? first_seen : second_seen)[entry.spring];
        CHECK(entry.vertex == (first ? network.first : network.second)[entry.spring]);
        CHECK(entry.other == (first ? network.second : network.first)[entry.spring]);
        CHECK((adjacency.place[entry.spring] == entry.place) == first);
        check_constants(adjacency, entry.place, network, entry.spring);
    }
    for (int k = 0; k < network.size(); ++k) CHECK((first_seen[k] == 1 && second_seen[k] == 1));
}

/// Numbers of springs' blocks lie apart from each other and within the list.
void check_value_places(const Adjacency& adjacency, int springs) {
    std::set<std::size_t> taken;
    for (int k = 0; k < springs; ++k) {
        const auto [first, apart] = adjacency.value_place(k);
        for (std::size_t number = 0; number < 4; ++number) {
            CHECK(first + number * apart < adjacency.value_count());
            CHECK(taken.insert(first + number * apart).second);
        }
    }
}

/// Places are those of the band of the distance of a spring's ends; places without springs are empty.
void check_bands(const ClothModel& model, int expected_bands) {
    const SpringNetwork& network = model.springs;
    const Adjacency& adjacency = model.adjacency;
    const BandPattern& bands = adjacency.bands;
    REQUIRE(bands.count == expected_bands);
    const auto padded = static_cast<std::size_t>(adjacency.slices()) * slice_lanes;
    CHECK(bands.padded == padded);
    CHECK(bands.guard % slice_lanes == 0);
    CHECK(adjacency.point_count() == 3 * (padded + 2 * bands.guard));
    REQUIRE(adjacency.stiffness.size() == bands.count * padded);
    // Constants of a step are held in lists as long as the entries.
    CHECK(adjacency.other.size() >= adjacency.stiffness.size());
    std::vector<bool> filled(adjacency.stiffness.size(), false);
    for (int k = 0; k < network.size(); ++k) {
        const int place = adjacency.place[k], low = std::min(network.first[k], network.second[k]);
        const int band = place / static_cast<int>(padded);
        CHECK(place % static_cast<int>(padded) == low);
        CHECK(bands.offset[band] == std::abs(network.first[k] - network.second[k]));
        CHECK(static_cast<std::size_t>(bands.offset[band]) <= bands.guard);
        CHECK_FALSE(filled[place]);
        filled[place] = true;
        check_constants(adjacency, place, network, k);
    }
    for (std::size_t place = 0; place < filled.size(); ++place) {
        if (!filled[place]) CHECK((adjacency.stiffness[place] == 0.0 && adjacency.damping[place] == 0.0));
    }
    CHECK(std::set<int>(bands.offset, bands.offset + bands.count).size() == static_cast<std::size_t>(bands.count));
    check_value_places(adjacency, network.size());
}

Fabric fabric_with(double shear, double bend) {
    Fabric fabric = sheet_fabric();
    fabric.springs.shear = shear;
    fabric.springs.bend = bend;
    return fabric;
}

ClothModel two_sheets(const TriangleMesh& first, const TriangleMesh& second) {
    ClothModel model;
    append_cloth(model, first, sheet_fabric(), "first");
    append_cloth(model, second, sheet_fabric(), "second");
    finish_model(model);
    return model;
}

}  // namespace

TEST_CASE("Every spring appears once at each of its ends, with its constants") {
    Random random(7);
    for (const int vertices : {2, 7, 15, 16, 17, 32, 41}) {
        const std::vector<double> masses = random_masses(random, vertices);
        check_entries(linked_masses(masses, random_links(random, vertices, 3 * vertices)));
    }
    check_entries(cloth_model(make_grid(1.0, 1.0, 6, 5), sheet_fabric()));
}

TEST_CASE("A vertex without springs has padding only") {
    const ClothModel model = linked_masses(std::vector<double>(20, 1.0), {{1, 18, 1.0, 1.0, 0.0}, {18, 1, 1.0, 1.0, 0.0}});
    check_entries(model);
    CHECK(model.adjacency.slices() == 2);
    CHECK(model.adjacency.start.back() == 4 * Vec3Arrays::lanes);
    CHECK(model.adjacency.vertex_count == 20);
}

TEST_CASE("Sums over the adjacency have the bits of a loop over the springs") {
    Random random(9);
    const std::vector<double> masses = random_masses(random, 37);
    const ClothModel model = linked_masses(masses, random_links(random, 37, 150));
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

TEST_CASE("The springs of a grid lie in bands, fewer where a kind is not built") {
    for (const auto& [columns, rows] : {std::pair{17, 33}, {65, 40}, {24, 24}, {9, 30}}) {
        CAPTURE(columns, rows);
        const TriangleMesh grid = make_grid(1.0, 0.7, columns, rows);
        check_bands(cloth_model(grid, fabric_with(500.0, 10.0)), 6);
        check_bands(cloth_model(grid, fabric_with(0.0, 10.0)), 4);
        check_bands(cloth_model(grid, fabric_with(500.0, 0.0)), 4);
        check_bands(cloth_model(grid, fabric_with(0.0, 0.0)), 2);
    }
}

TEST_CASE("Two grids lie in bands together where they have as many columns") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 20, 25);
    check_bands(two_sheets(grid, make_grid(0.5, 0.7, 20, 31)), 6);
    const ClothModel unequal = two_sheets(grid, make_grid(0.5, 0.7, 21, 31));
    CHECK(unequal.adjacency.bands.count == 0);
    check_entries(unequal);
    check_value_places(unequal.adjacency, unequal.springs.size());
}

TEST_CASE("A free mesh and too few springs for their bands stay in slices") {
    const ClothModel sphere = cloth_model(make_sphere(0.5, 3), fabric_with(0.0, 10.0));
    const ClothModel lone = linked_masses(std::vector<double>(20, 1.0), {{1, 3, 1.0, 1.0, 0.0}, {5, 7, 1.0, 1.0, 0.0}});
    for (const ClothModel* model : {&sphere, &lone}) {
        CHECK(model->adjacency.bands.count == 0);
        CHECK(model->adjacency.pattern().bands == nullptr);
        check_entries(*model);
        check_value_places(model->adjacency, model->springs.size());
    }
}

TEST_CASE("Two springs between the same vertices do not lie in bands") {
    std::vector<Link> links;
    for (int i = 0; i + 1 < 30; ++i) links.push_back({i, i + 1, 1.0, 1.0, 0.0});
    check_bands(linked_masses(std::vector<double>(30, 1.0), links), 1);
    links.push_back({8, 7, 2.0, 3.0, 0.0});
    CHECK(linked_masses(std::vector<double>(30, 1.0), links).adjacency.bands.count == 0);
}

TEST_CASE("Packed points are the Vec3 arrays, with nothing beside them") {
    const ClothModel model = cloth_model(make_grid(1.0, 1.0, 17, 20), sheet_fabric());
    const Vec3Arrays from = to_vec3_arrays(model.rest);
    AlignedVector<double> points(7, 3.0);
    pack_points(compute, model.adjacency, from, points);
    const BandPattern& bands = model.adjacency.bands;
    REQUIRE(points.size() == model.adjacency.point_count());
    const std::size_t apart = bands.padded + 2 * bands.guard;
    const AlignedVector<double>* axes[] = {&from.x, &from.y, &from.z};
    for (std::size_t at = 0; at < points.size(); ++at) {
        const std::size_t i = at % apart;
        const bool inside = i >= bands.guard && i < bands.guard + bands.padded;
        CHECK(points[at] == (inside ? (*axes[at / apart])[i - bands.guard] : 0.0));
    }
}

}  // namespace percale::test::adjacency_test
