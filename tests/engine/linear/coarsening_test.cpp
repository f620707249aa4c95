#include "engine/linear/coarsening.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/forces/spring_graphs.h"

namespace percale::test::coarsening_test {
namespace {

/// Whether each pair is at least a fraction `share` of the strongest pair at one of its ends.
std::vector<bool> pairs_above(const SpringGraph& graph, double ratio) {
    std::vector<double> largest(graph.positions.size(), 0.0);
    for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
        for (const int i : graph.pairs[e]) largest[i] = std::max(largest[i], graph.strength[e]);
    }
    std::vector<bool> strong;
    for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
        strong.push_back(graph.strength[e] >= ratio * std::min(largest[graph.pairs[e][0]], largest[graph.pairs[e][1]]));
    }
    return strong;
}

/// The number of vertices kept greedily: each that is joined to no earlier kept one.
std::size_t greedy_count(const SpringGraph& graph, const std::vector<bool>& strong) {
    std::vector<std::vector<int>> near(graph.positions.size());
    for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
        if (!strong[e]) continue;
        near[graph.pairs[e][0]].push_back(graph.pairs[e][1]);
        near[graph.pairs[e][1]].push_back(graph.pairs[e][0]);
    }
    std::vector<bool> stays(near.size(), false);
    for (std::size_t i = 0; i < near.size(); ++i) {
        stays[i] = std::none_of(near[i].begin(), near[i].end(), [&](int j) { return stays[j]; });
    }
    return static_cast<std::size_t>(std::count(stays.begin(), stays.end(), true));
}

/// Pairs of a quarter of the strongest at one of their ends, or of 0.03 where that leaves more than two vertices in five.
std::vector<bool> strong_pairs(const SpringGraph& graph) {
    const std::vector<bool> strong = pairs_above(graph, 0.25);
    return 5 * greedy_count(graph, strong) > 2 * graph.positions.size() ? pairs_above(graph, 0.03) : strong;
}

/// A square grid; the strength of diagonals is `share` times that of the pairs along rows and columns.
SpringGraph grid_with_diagonals(int n, double ratio) {
    SpringGraph graph;
    for (int i = 0; i < n * n; ++i) graph.positions.push_back(Vec3(i % n, i / n, 0.0));
    const auto join = [&](int i, int column, int row, double strength) {
        const int x = i % n + column, y = i / n + row;
        if (x < 0 || x >= n || y >= n) return;
        graph.pairs.push_back({i, y * n + x});
        graph.strength.push_back(strength);
    };
    for (int i = 0; i < n * n; ++i) {
        join(i, 1, 0, 1.0);
        join(i, 0, 1, 1.0);
        join(i, 1, 1, ratio);
        join(i, -1, 1, ratio);
    }
    return graph;
}

std::vector<bool> is_kept(const SpringGraph& graph, const Coarsening& coarsening) {
    std::vector<bool> kept(graph.positions.size(), false);
    for (const int i : coarsening.kept) kept[i] = true;
    return kept;
}

Vec3 interpolated(const SpringGraph& graph, const Coarsening& coarsening, int i) {
    const InterpolationRow& row = coarsening.rows[i];
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < row.count; ++k) sum += row.weight[k] * graph.positions[coarsening.kept[row.vertex[k]]];
    return sum;
}

}  // namespace

TEST_CASE("The kept vertices are a maximal independent set of the strong pairs") {
    for (const SpringGraph& graph : some_graphs()) {
        const Coarsening coarsening = coarsen(graph);
        const std::vector<bool> strong = strong_pairs(graph), kept = is_kept(graph, coarsening);
        std::vector<bool> near_kept = kept;
        for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
            const auto& [i, j] = graph.pairs[e];
            if (!strong[e]) continue;
            CHECK_FALSE((kept[i] && kept[j]));
            if (kept[i]) near_kept[j] = true;
            if (kept[j]) near_kept[i] = true;
        }
        CHECK(std::count(near_kept.begin(), near_kept.end(), false) == 0);
        CHECK(std::is_sorted(coarsening.kept.begin(), coarsening.kept.end()));
    }
}

TEST_CASE("Where strong pairs alone would keep half of the vertices, weaker ones count too") {
    const auto kept = [](double ratio) { return coarsen(grid_with_diagonals(17, ratio)).kept.size(); };
    CHECK(kept(0.5) == 81);    // every second of every second row
    CHECK(kept(0.1) == 81);    // although diagonals are no quarter of the strongest
    CHECK(kept(0.02) == 145);  // every second: without diagonals there is no better choice
}

TEST_CASE("Every vertex is a mean of at most three kept ones, a kept vertex itself") {
    for (const SpringGraph& graph : some_graphs()) {
        const Coarsening coarsening = coarsen(graph);
        REQUIRE(coarsening.rows.size() == graph.positions.size());
        for (const InterpolationRow& row : coarsening.rows) {
            REQUIRE((row.count >= 1 && row.count <= 3));
            double sum = 0.0;
            for (int k = 0; k < row.count; ++k) {
                CHECK(row.weight[k] > 0.0);
                REQUIRE((row.vertex[k] >= 0 && row.vertex[k] < static_cast<int>(coarsening.kept.size())));
                CHECK(std::count(row.vertex.begin(), row.vertex.begin() + row.count, row.vertex[k]) == 1);
                sum += row.weight[k];
            }
            CHECK(sum == Approx(1.0).epsilon(1e-14));
        }
        for (std::size_t c = 0; c < coarsening.kept.size(); ++c) {
            const InterpolationRow& row = coarsening.rows[coarsening.kept[c]];
            CHECK((row.count == 1 && row.vertex[0] == static_cast<int>(c)));
        }
    }
}

TEST_CASE("Interpolated vertices come from kept ones within two strong pairs") {
    for (const SpringGraph& graph : some_graphs()) {
        const Coarsening coarsening = coarsen(graph);
        const std::vector<bool> strong = strong_pairs(graph);
        const int count = static_cast<int>(graph.positions.size());
        Eigen::MatrixXi near = Eigen::MatrixXi::Identity(count, count);
        for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
            const auto& [i, j] = graph.pairs[e];
            if (strong[e]) near(i, j) = near(j, i) = 1;
        }
        const Eigen::MatrixXi reach = near * near;
        for (int i = 0; i < count; ++i) {
            const InterpolationRow& row = coarsening.rows[i];
            for (int k = 0; k < row.count; ++k) CHECK(reach(i, coarsening.kept[row.vertex[k]]) > 0);
        }
    }
}

TEST_CASE("Linear functions are kept inside a rope of uneven links") {
    Random random(5);
    const SpringGraph rope = uneven_rope(random, 60);
    const Coarsening coarsening = coarsen(rope);
    int interpolated_vertices = 0;
    for (int i = coarsening.kept.front(); i < coarsening.kept.back(); ++i) {
        const double link = std::max((rope.positions[i + 1] - rope.positions[i]).norm(), 0.5);
        CHECK((interpolated(rope, coarsening, i) - rope.positions[i]).norm() <= 2e-3 * link);
        interpolated_vertices += coarsening.rows[i].count > 1;
    }
    CHECK(interpolated_vertices > 20);
}

TEST_CASE("Linear functions are kept inside a regular triangular lattice and a regular grid") {
    constexpr int side = 14;
    Fabric without_shear = sheet_fabric();
    without_shear.springs.shear = 0.0;
    const TriangleMesh grid = make_grid(side - 1.0, side - 1.0, side, side);
    for (const SpringGraph& graph :
         {triangular_lattice(side), graph_of(cloth_model(grid, without_shear)), graph_of(cloth_model(grid, sheet_fabric()))}) {
        const Coarsening coarsening = coarsen(graph);
        double largest = 0.0;
        for (int i = 0; i < side * side; ++i) {
            const int edge = std::min({i / side, i % side, side - 1 - i / side, side - 1 - i % side});
            if (edge >= 2) largest = std::max(largest, (interpolated(graph, coarsening, i) - graph.positions[i]).norm());
        }
        CHECK(largest <= 2e-3);
    }
}

TEST_CASE("Linear functions are kept inside an irregular mesh wherever three vertices take part") {
    constexpr int side = 20;
    Random random(6);
    SpringGraph lattice = triangular_lattice(side);
    for (Vec3& x : lattice.positions) {
        const double along = random.number(-0.25, 0.25);
        x += Vec3(along, 0.0, random.number(-0.25, 0.25));
    }
    const Coarsening coarsening = coarsen(lattice);
    int of_three = 0;
    double largest = 0.0;
    for (int i = 0; i < side * side; ++i) {
        const InterpolationRow& row = coarsening.rows[i];
        if (row.count < 3) continue;
        ++of_three;
        largest = std::max(largest, (interpolated(lattice, coarsening, i) - lattice.positions[i]).norm());
    }
    CHECK(of_three > side * side / 3);
    CHECK(largest <= 0.05);
}

TEST_CASE("Vertices without springs are kept, and so is one of a strong pair alone") {
    SpringGraph graph;
    for (int i = 0; i < 6; ++i) graph.positions.emplace_back(i, 0.0, 0.0);
    graph.pairs = {{1, 4}};
    graph.strength = {10.0};
    const Coarsening coarsening = coarsen(graph);
    CHECK(coarsening.kept == std::vector<int>{0, 1, 2, 3, 5});
    CHECK((coarsening.rows[4].count == 1 && coarsening.rows[4].vertex[0] == 1 && coarsening.rows[4].weight[0] == 1.0));
    CHECK(coarsen({}).kept.empty());
}

TEST_CASE("Coarsening twice gives the same") {
    for (const SpringGraph& graph : some_graphs()) {
        const Coarsening once = coarsen(graph), again = coarsen(graph);
        CHECK(once.kept == again.kept);
        for (std::size_t i = 0; i < once.rows.size(); ++i) {
            CHECK(once.rows[i].vertex == again.rows[i].vertex);
            CHECK(once.rows[i].weight == again.rows[i].weight);
        }
    }
}

TEST_CASE("Where the sheet lies and how large it is changes no weight") {
    const SpringGraph graph = graph_of(cloth_model(make_grid(1.0, 1.0, 9, 7), sheet_fabric()));
    SpringGraph moved = graph;
    for (Vec3& x : moved.positions) x = 8.0 * Vec3(x.z(), x.x(), x.y()) + Vec3(2.0, -4.0, 16.0);
    const Coarsening here = coarsen(graph), there = coarsen(moved);
    CHECK(here.kept == there.kept);
    for (int i = 0; i < 63; ++i) {
        const Vec3 expected = 8.0 * interpolated(graph, here, i);
        const Vec3 turned = Vec3(expected.z(), expected.x(), expected.y()) + Vec3(2.0, -4.0, 16.0);
        CHECK((interpolated(moved, there, i) - turned).norm() <= 1e-9);
    }
}

}  // namespace percale::test::coarsening_test
