#include "engine/model/spring_network.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::spring_network_test {
namespace {

using Spring = std::tuple<int, int, SpringKind>;

Fabric fabric_of(double structural, double shear, double bend) {
    Fabric fabric = sheet_fabric();
    fabric.springs = {.structural = structural, .shear = shear, .bend = bend};
    return fabric;
}

SpringNetwork network_of(const TriangleMesh& mesh, const Fabric& fabric, int first = 0) {
    SpringNetwork network;
    append_springs(network, {mesh, {}}, fabric, first, "sail");
    return network;
}

std::multiset<Spring> springs_of(const SpringNetwork& network) {
    std::multiset<Spring> springs;
    for (int k = 0; k < network.size(); ++k) {
        springs.insert(
            {std::min(network.first[k], network.second[k]), std::max(network.first[k], network.second[k]), network.kind[k]});
    }
    return springs;
}

/// The springs between two grid vertices, from their places in the grid alone.
std::multiset<Spring> grid_springs_by_search(int columns, int rows) {
    std::multiset<Spring> springs;
    for (int i = 0; i < columns * rows; ++i) {
        for (int j = i + 1; j < columns * rows; ++j) {
            const int across = std::abs(i % columns - j % columns), down = std::abs(i / columns - j / columns);
            if (across + down == 1) springs.insert({i, j, SpringKind::structural});
            if (across == 1 && down == 1) springs.insert({i, j, SpringKind::shear});
            if (across + down == 2 && across * down == 0) springs.insert({i, j, SpringKind::bend});
        }
    }
    return springs;
}

int count(const SpringNetwork& network, SpringKind kind) {
    return static_cast<int>(std::count(network.kind.begin(), network.kind.end(), kind));
}

}  // namespace

TEST_CASE("A grid has structural, shear and bend springs: rows and columns, both diagonals, two apart") {
    for (const auto& [columns, rows] : {std::pair(2, 2), std::pair(2, 5), std::pair(3, 3), std::pair(7, 4)}) {
        CAPTURE(columns, rows);
        const SpringNetwork network = network_of(make_grid(1.0, 2.0, columns, rows), sheet_fabric());
        CHECK(springs_of(network) == grid_springs_by_search(columns, rows));
        CHECK(count(network, SpringKind::structural) == (columns - 1) * rows + columns * (rows - 1));
        CHECK(count(network, SpringKind::shear) == 2 * (columns - 1) * (rows - 1));
        CHECK(count(network, SpringKind::bend) == (columns - 2) * rows + columns * (rows - 2));
    }
}

TEST_CASE("Springs take their constants from the fabric and their lengths from the rest shape") {
    TriangleMesh grid = make_grid(1.0, 2.0, 6, 5);
    Random random(5);
    for (Vec3& x : grid.vertices) x += random.point(0.02);
    const Fabric fabric = fabric_of(900.0, 300.0, 7.0);
    const SpringNetwork network = network_of(grid, fabric);
    const std::map<SpringKind, double> constants = {
        {SpringKind::structural, 900.0}, {SpringKind::shear, 300.0}, {SpringKind::bend, 7.0}};
    for (int k = 0; k < network.size(); ++k) {
        CHECK(network.stiffness[k] == constants.at(network.kind[k]));
        CHECK(network.damping[k] == fabric.spring_damping);
        CHECK(network.rest_length[k] == (grid.vertices[network.first[k]] - grid.vertices[network.second[k]]).norm());
    }
}

TEST_CASE("A free mesh has a spring on every edge and one across every inner edge") {
    TriangleMesh mesh = make_sphere(0.4, 2);
    mesh.triangles.resize(mesh.triangles.size() - 31);  // a hole, so that some edges are not inner ones
    std::multiset<Spring> expected;
    std::map<std::pair<int, int>, std::vector<int>> opposite;
    for (const auto& [a, b, c] : mesh.triangles) {
        for (const auto& [i, j, k] : {Triangle{a, b, c}, Triangle{b, c, a}, Triangle{c, a, b}}) {
            opposite[std::minmax(i, j)].push_back(k);
        }
    }
    for (const auto& [edge, ends] : opposite) {
        expected.insert({edge.first, edge.second, SpringKind::structural});
        if (ends.size() == 2) expected.insert({std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), SpringKind::bend});
    }
    CHECK(springs_of(network_of(mesh, fabric_of(1000.0, 0.0, 10.0))) == expected);
}

TEST_CASE("A spring constant of zero makes no springs") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 4, 4);
    const SpringNetwork network = network_of(grid, fabric_of(1000.0, 0.0, 0.0));
    CHECK(network.size() == 24);
    CHECK(count(network, SpringKind::structural) == 24);
    CHECK(network_of(make_sphere(1.0, 1), fabric_of(1000.0, 0.0, 0.0)).size() == 120);
}

TEST_CASE("A second cloth's springs are appended with its vertices shifted") {
    SpringNetwork network = network_of(make_grid(1.0, 1.0, 3, 3), sheet_fabric());
    const int before = network.size();
    append_springs(network, {make_grid(1.0, 1.0, 2, 2), {}}, sheet_fabric(), 9, "second");
    REQUIRE(network.size() == before + 6);
    for (int k = 0; k < network.size(); ++k) {
        CHECK((network.first[k] >= 9) == (k >= before));
        CHECK((network.second[k] >= 9) == (k >= before));
    }
}

TEST_CASE("Invalid springs are refused by name") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    CHECK(mentions(scene_error([] { network_of(make_sphere(1.0, 1), fabric_of(1000.0, 5.0, 1.0)); }),
                   {"sail", "springs.shear", "5", "free mesh"}));
    CHECK(
        mentions(scene_error([&] { network_of(grid, fabric_of(0.0, 0.0, 0.0)); }), {"sail", "no springs", "springs.structural"}));
    TriangleMesh touching = make_grid(1.0, 1.0, 3, 3);
    touching.vertices[8] = touching.vertices[6];
    CHECK(mentions(scene_error([&] { network_of(touching, sheet_fabric()); }), {"sail", "vertices 6 and 8", "same place"}));
}

TEST_CASE("Renumbered springs join the same places with the same constants, sorted by kind and ends") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    const int count = static_cast<int>(ball.vertices.size()), before = 9;
    SpringNetwork network = network_of(make_grid(1.0, 1.0, 3, 3), sheet_fabric());
    const int from = network.size();
    append_springs(network, {ball, {}}, fabric_of(900.0, 0.0, 7.0), before, "ball");
    const SpringNetwork old = network;
    const std::vector<int> springs = springs_at_vertices(network, from, before, count);
    CHECK(std::accumulate(springs.begin(), springs.end(), 0) == 2 * (network.size() - from));
    CHECK(std::count(springs.begin(), springs.end(), 10) == 12);  // where five triangles meet; elsewhere six
    CHECK(std::count(springs.begin(), springs.end(), 12) == count - 12);

    const VertexOrder order = memory_order(ball.vertices, springs);
    renumber_springs(network, from, before, order);
    using Key = std::tuple<SpringKind, int, int>;
    std::map<Key, std::array<double, 3>> expected;
    for (int k = from; k < old.size(); ++k) {
        const int one = order.place_of(old.first[k] - before), other = order.place_of(old.second[k] - before);
        expected[{old.kind[k], before + std::min(one, other), before + std::max(one, other)}] = {
            old.rest_length[k], old.stiffness[k], old.damping[k]};
    }
    REQUIRE(network.size() - from == static_cast<int>(expected.size()));
    int k = from;
    for (const auto& [key, constants] : expected) {
        CHECK(Key(network.kind[k], network.first[k], network.second[k]) == key);
        CHECK(std::array{network.rest_length[k], network.stiffness[k], network.damping[k]} == constants);
        ++k;
    }
    for (int i = 0; i < from; ++i) {
        CHECK(network.first[i] == old.first[i]);
        CHECK(network.second[i] == old.second[i]);
        CHECK(network.rest_length[i] == old.rest_length[i]);
    }
}

}  // namespace percale::test::spring_network_test
