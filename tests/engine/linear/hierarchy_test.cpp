#include "engine/linear/hierarchy.h"

#include <Eigen/Dense>
#include <algorithm>

#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/forces/spring_graphs.h"

namespace percale::test::hierarchy_test {
namespace {

/// A block a pair, positive semidefinite.
using Blocks = std::vector<Eigen::Matrix3d>;

Blocks random_blocks(Random& random, std::size_t count) {
    Blocks blocks;
    for (std::size_t e = 0; e < count; ++e) {
        const Vec3 w = random.point(1.0);
        blocks.push_back(random.number(0.0, 0.5) * Eigen::Matrix3d::Identity() + w * w.transpose());
    }
    return blocks;
}

Blocks coarse_blocks(const LevelPattern& level, const Blocks& fine) {
    Blocks blocks;
    for (std::size_t e = 0; e < level.pairs.size(); ++e) {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (int k = level.term_start[e]; k < level.term_start[e + 1]; ++k) {
            sum += static_cast<double>(level.coefficient[k]) * fine[level.term_pair[k]];
        }
        blocks.push_back(sum);
    }
    return blocks;
}

/// Sum over pairs of (x_i - x_j) . B (x_i - x_j)
double form(const std::vector<std::array<int, 2>>& pairs, const Blocks& blocks, const std::vector<Vec3>& x) {
    double sum = 0.0;
    for (std::size_t e = 0; e < pairs.size(); ++e) {
        const Vec3 d = x[pairs[e][0]] - x[pairs[e][1]];
        sum += d.dot(blocks[e] * d);
    }
    return sum;
}

std::vector<Vec3> prolonged(const LevelPattern& level, const std::vector<Vec3>& x) {
    std::vector<Vec3> fine;
    for (const InterpolationRow& row : level.rows) {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < row.count; ++k) sum += row.weight[k] * x[row.vertex[k]];
        fine.push_back(sum);
    }
    return fine;
}

Eigen::MatrixXd dense_rows(const TransferLists& lists, int rows, int columns) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, columns);
    for (int s = 0; s + 1 < static_cast<int>(lists.start.size()); ++s) {
        for (int e = lists.start[s]; e < lists.start[s + 1]; ++e) {
            const int row = s * slice_lanes + (e - lists.start[s]) % slice_lanes;
            if (row < rows) dense(row, lists.other[e]) += static_cast<double>(lists.weight[e]);
            if (row >= rows) CHECK(lists.weight[e] == 0.0f);
        }
    }
    return dense;
}

SpringGraph sheet_graph(int side) { return graph_of(cloth_model(make_grid(1.0, 1.0, side, side), sheet_fabric())); }

std::vector<SpringGraph> large_graphs() {
    std::vector<SpringGraph> graphs = some_graphs();
    graphs.push_back(sheet_graph(40));
    graphs.push_back(graph_of(cloth_model(make_sphere(0.5, 3), {})));
    return graphs;
}

void check_entries(const LevelPattern& level) {
    std::vector<std::array<int, 2>> seen(level.pairs.size(), {0, 0});
    REQUIRE(level.slices() == (level.vertices + slice_lanes - 1) / slice_lanes);
    for (int e = 0; e < level.start.back(); ++e) {
        const auto after = std::upper_bound(level.start.begin(), level.start.end(), e);
        const int slice = static_cast<int>(after - level.start.begin()) - 1;
        const int i = slice * slice_lanes + (e - level.start[slice]) % slice_lanes, pair = level.entry_pair[e];
        if (pair == static_cast<int>(level.pairs.size())) {
            CHECK(level.other[e] == i);
            continue;
        }
        const int end = level.pairs[pair][0] == i ? 0 : 1;
        CHECK(level.pairs[pair][end] == i);
        CHECK(level.pairs[pair][1 - end] == level.other[e]);
        ++seen[pair][end];
    }
    for (const auto& ends : seen) CHECK(ends == std::array{1, 1});
}

void check_transfers(const LevelPattern& level, int finer) {
    const Eigen::MatrixXd up = dense_rows(level.prolongation, finer, level.vertices);
    const Eigen::MatrixXd down = dense_rows(level.restriction, level.vertices, finer);
    CHECK(up == down.transpose());
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(finer, level.vertices);
    REQUIRE(static_cast<int>(level.rows.size()) == finer);
    for (int i = 0; i < finer; ++i) {
        for (int k = 0; k < level.rows[i].count; ++k) expected(i, level.rows[i].vertex[k]) = level.rows[i].weight[k];
    }
    CHECK((up - expected).cwiseAbs().maxCoeff() <= 1e-7);
}

}  // namespace

TEST_CASE("A coarser level has the energy of what it interpolates") {
    Random random(1);
    for (const SpringGraph& graph : large_graphs()) {
        std::vector<std::array<int, 2>> pairs = graph.pairs;
        Blocks blocks = random_blocks(random, pairs.size());
        for (const LevelPattern& level : make_hierarchy(graph)) {
            const Blocks coarse = coarse_blocks(level, blocks);
            for (int trial = 0; trial < 5; ++trial) {
                const std::vector<Vec3> x = random_points(random, level.vertices, 1.0);
                const double fine = form(pairs, blocks, prolonged(level, x));
                // Coefficients up to 1e-4 are left out.
                CHECK(form(level.pairs, coarse, x) == Approx(fine).epsilon(1e-3).margin(1e-12));
            }
            pairs = level.pairs;
            blocks = coarse;
        }
    }
}

TEST_CASE("Every level is smaller by a fifth at least, and a sheet ends in one that is solved densely") {
    for (const SpringGraph& graph : large_graphs()) {
        double finer = static_cast<double>(graph.positions.size());
        for (const LevelPattern& level : make_hierarchy(graph)) {
            CHECK(level.vertices <= 0.8 * finer);
            CHECK(level.vertices >= 1);
            CHECK(finer > dense_vertices);
            finer = level.vertices;
        }
    }
    for (const int side : {6, 17, 33, 65, 90}) CHECK(make_hierarchy(sheet_graph(side)).back().vertices <= dense_vertices);
    CHECK(make_hierarchy(sheet_graph(5)).empty());
    CHECK(make_hierarchy({}).empty());
}

TEST_CASE("Pairs are between different vertices and appear once") {
    for (const LevelPattern& level : make_hierarchy(sheet_graph(40))) {
        std::vector<std::array<int, 2>> sorted = level.pairs;
        for (auto& pair : sorted) {
            CHECK(pair[0] != pair[1]);
            CHECK((std::min(pair[0], pair[1]) >= 0 && std::max(pair[0], pair[1]) < level.vertices));
            std::sort(pair.begin(), pair.end());
        }
        std::sort(sorted.begin(), sorted.end());
        CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
    }
}

TEST_CASE("Every pair has an entry at each end, and padding is the vertex itself") {
    for (const SpringGraph& graph : large_graphs()) {
        for (const LevelPattern& level : make_hierarchy(graph)) {
            check_entries(level);
        }
    }
}

TEST_CASE("Prolongation is the interpolation, restriction its transpose") {
    for (const SpringGraph& graph : large_graphs()) {
        int finer = static_cast<int>(graph.positions.size());
        for (const LevelPattern& level : make_hierarchy(graph)) {
            check_transfers(level, finer);
            finer = level.vertices;
        }
    }
}

TEST_CASE("The same graph gives the same hierarchy") {
    const std::vector<LevelPattern> once = make_hierarchy(sheet_graph(33)), again = make_hierarchy(sheet_graph(33));
    REQUIRE(once.size() == again.size());
    for (std::size_t k = 0; k < once.size(); ++k) {
        CHECK(once[k].pairs == again[k].pairs);
        CHECK(once[k].coefficient == again[k].coefficient);
        CHECK(once[k].prolongation.weight == again[k].prolongation.weight);
    }
}

}  // namespace percale::test::hierarchy_test
